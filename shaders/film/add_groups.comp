// Adds a batch's finished paths to the compact sums of light groups: one invocation a pixel, samples in their order and
// rounded one by one, so that the sums do not depend on the division into batches.
//
// A sum is rounded to 18 bits at random: up with the probability of the lost fraction. Its expectation is therefore the exact
// sum, however small the samples are, whereas rounding to nearest would lose all samples below half of the last bit (M. Csuros
// 2010 counts this way). For N equal samples the variance of a rounding is at most a quarter of the squared last bit, and at
// most that bit times the sample; as the bit is at most 2^-17 of the sum, the relative standard deviation is at most
// sqrt(N / 12) / 2^17 (7e-5 at a thousand samples), and at most 2^-9, 0.2 %, for any N. The random numbers are a hash of pixel
// and sample, so that the sums are identical for any division into batches and threads.
#include "lib/variants.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/hash.glsl"
#include "lib/invocation.glsl"
#include "lib/radiance.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilmPush push; };
#if LUCERNA_FILM_IMAGES
layout(rgba32f) uniform writeonly imageBuffer group_sums_out;
#else
layout(scalar) writeonly buffer GroupSumTexels { uvec4 group_sums_out[]; };
#endif

// s + x, rounded with the random number u in [0, 1).
GroupSum group_sum_plus(GroupSum s, vec3 x, vec3 u) {
  vec3 light = max(x, vec3(0.0));
  // The exponent fits the largest channel, rounded up.
  float most = max3(group_sum_value(s) + light) * 1.0000152587890625;
  uint before = group_sum_exponent(s);
  uint exponent = max(max(floatBitsToUint(most) >> 23u, k_group_sum_bits) - (k_group_sum_bits - 1u), before);
  // Sum and addend in units of the last bit: integer and fractional parts separately, so that nothing is lost.
  vec3 kept = vec3(group_sum_mantissas(s)) * uintBitsToFloat((127u - min(exponent - before, 126u)) << 23u);
  vec3 more = light * uintBitsToFloat((254u - exponent) << 23u);
  uvec3 whole = uvec3(floor(kept)) + uvec3(floor(more)) + uvec3(floor(fract(kept) + fract(more) + u));
  return group_sum(min(whole, uvec3((1u << k_group_sum_bits) - 1u)), exponent);
}

void main() {
  uint index = global_index();
  if (index >= push.pixel_count) return;
  WorkBlock block = blocks[index / 64u];
  uvec2 xy = block_pixel(block.index, index % 64u, push.width);
  if (xy.x >= push.width || xy.y >= push.height) return;
  uint pixel = xy.y * push.width + xy.x;
  // Only groups with light in some sample, per pixel, so that few iterations suffice.
  uint lit = 0u, i = 0u;
  do lit |= groups_lit(index + i * push.pixel_count); while (++i < push.sample_count);
  for (; lit != 0u; lit &= lit - 1u) {
    uint group = uint(findLSB(lit));
    int at = int(group * push.width * push.height + pixel);
    uvec4 sums = texelFetch(group_sums, at);
    i = 0u;
    do {
      uint slot = index + i * push.pixel_count, number = block.first_sample + i;
      vec3 light = group_light(slot, group);
      // One random number for all sums of a sample, each time shifted by the golden ratio: each rounding is unbiased, and their
      // errors have different signs.
      uvec3 turned = hash_mix(pixel ^ hash_mix(number + 0x68bc21ebu)) + (3u * group + uvec3(0u, 1u, 2u)) * 0x9e3779b9u;
      vec3 u = vec3(turned >> 8u) * (1.0 / 16777216.0);
      bool even = (number & 1u) == 0u, adds = (groups_lit(slot) >> group & 1u) != 0u;
      uvec2 half_sum = even ? sums.xy : sums.zw;
      GroupSum s = group_sum_plus(GroupSum(half_sum.x, half_sum.y), light, u);
      half_sum = adds ? uvec2(s.low, s.high) : half_sum;
      sums = even ? uvec4(half_sum, sums.zw) : uvec4(sums.xy, half_sum);
    } while (++i < push.sample_count);
#if LUCERNA_FILM_IMAGES
    imageStore(group_sums_out, at, uintBitsToFloat(sums));
#else
    group_sums_out[at] = sums;
#endif
  }
}
