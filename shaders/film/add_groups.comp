// Adds a batch's finished paths to the sums by group of lights in short: one invocation a pixel, samples in their order and
// rounded one by one, so that the sums do not depend on how samples were cut into batches.
//
// A sum is rounded to its 18 bits at random: up with the probability of the fraction that is lost. So its expectation is the
// exact sum's, however small samples are beside it, where rounding to the nearest would lose all of those below half of the last
// bit (M. Csuros 2010 counts so). Of N samples alike a rounding's variance is at most a quarter of the last bit's square, and at
// most that bit times the sample; as the bit is at most 2^-17 of the sum, its relative standard deviation is at most
// sqrt(N / 12) / 2^17 (7e-5 at a thousand samples), and at most 2^-9, 0.2 %, at any number. The numbers are a hash of pixel
// and sample: what is added, however it is cut into batches and whichever thread does it, gives the same bits.
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

// s + x, rounded by u in [0, 1).
GroupSum group_sum_plus(GroupSum s, vec3 x, vec3 u) {
  vec3 light = max(x, vec3(0.0));
  // Room for the largest channel, and for rounding it up.
  float most = max3(group_sum_value(s) + light) * 1.0000152587890625;
  uint before = group_sum_exponent(s);
  uint exponent = max(max(floatBitsToUint(most) >> 23u, k_group_sum_bits) - (k_group_sum_bits - 1u), before);
  // What there is and what comes, in units of the last bit: whole parts and fractions apart, so that nothing is lost.
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
  // Of the groups only those of which some sample has light; each pixel its own, so that few passes serve all.
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
      // One number for all sums of a sample, each time turned by the golden ratio: every one is rounded without bias, and what
      // they err by is not of one sign.
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
