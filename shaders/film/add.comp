// Adds a batch's finished paths to the film: one invocation a pixel, samples in their order, so that the sums do not depend
// on how samples were cut into batches.
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
#include "lib/radiance.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilmPush push; };
uniform samplerBuffer feature_texels;
#if LUCERNA_VERTEX_COUNT
// Number of vertices of each pixel's paths, from their final states: its share of the device time.
#include "shaders/shared/transport.h"
uniform samplerBuffer path_texels;
layout(scalar) buffer FilmVertices { uint film_vertices[]; };
uint vertices_of(uint slot) {
  // Scattering events (PathState.bits) and surfaces passed since the last one, plus the last vertex.
  uint bits = floatBitsToUint(texelFetch(path_texels, int(3u * slot + 1u))).z;
  uint nulls = floatBitsToUint(texelFetch(path_texels, int(3u * slot + 2u))).z & k_nulls_mask;
  return 1u + (bits >> k_path_events_shift & k_path_events_mask) + nulls;
}
#endif

#if LUCERNA_LOOKUP_BIAS
// Lookup bias of the even and of the odd samples, of the unmixed light.
layout(scalar) buffer FilmBiasEven { float film_bias_even[]; };
layout(scalar) buffer FilmBiasOdd { float film_bias_odd[]; };
#endif

#if LUCERNA_FILM_LANES
layout(scalar) writeonly buffer GroupLights { GroupLight group_lights_out[]; };

// Adds a half of a group's sums, times its mix weight.
void add_mixed(inout FilmHalf h, FilmHalf of_group, vec3 weight) {
  film_half_add(h, weight * of_group.sum);
  film_half_add(h, weight * of_group.compensation);
}
#endif

// Light of sample `slot` in a component.
vec3 light_of_component(uint slot, uint component) {
#if LUCERNA_FILM_LANES
  return texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(push.group, component)))).rgb;
#elif LUCERNA_GROUP_SUMS && !LUCERNA_FILM_UNMIXED
  // In a preview sample, the mix of all groups is distributed to the components in proportion to their light.
  vec3 all = vec3(0.0), mixed = vec3(0.0);
  for (uint lit = groups_lit(slot); lit != 0u; lit &= lit - 1u) {
    uint group = uint(findLSB(lit));
    vec3 of_group = group_light(slot, group);
    all += of_group;
    mixed += light_weight(group) * of_group;
  }
  return group_ratio(mixed, all) * texelFetch(radiance_texels, int(radiance_texel(slot, component))).rgb;
#elif LUCERNA_LIGHT_GROUPS > 1 && !LUCERNA_GROUP_SUMS
  vec3 sum = vec3(0.0);
  for (uint group = 0u; group < k_group_count; ++group)
    sum += light_weight(group) * texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(group, component)))).rgb;
  return sum;
#else
  return texelFetch(radiance_texels, int(radiance_texel(slot, component))).rgb;
#endif
}

void main() {
  uint index = global_index();
  if (index >= push.pixel_count) return;
#if LUCERNA_FILM_LANES
  WorkBlock block = WorkBlock(index / 64u, 0u);
  if (push.sample_count > 0u) block = blocks[index / 64u];
#else
  WorkBlock block = blocks[index / 64u];
#endif
  uvec2 xy = block_pixel(block.index, index % 64u, push.width);
  if (xy.x >= push.width || xy.y >= push.height) return;
  uint pixel = xy.y * push.width + xy.x;
  FilmPixel sums[k_component_count];
#if LUCERNA_FILM_LANES
  sums[0] = LUCERNA_FILM_LOAD(group_primary, pixel);
  sums[1] = LUCERNA_FILM_LOAD(group_secondary, pixel);
  sums[2] = LUCERNA_FILM_LOAD(group_tertiary, pixel);
  sums[3] = LUCERNA_FILM_LOAD(group_caustic, pixel);
#else
  for (uint c = 0u; c < k_component_count; ++c) sums[c] = film_load(c, pixel);
#endif
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
#if LUCERNA_VERTEX_COUNT
  uint vertices = 0u;
#endif
#if LUCERNA_LOOKUP_BIAS
  float bias_even = film_bias_even[pixel], bias_odd = film_bias_odd[pixel];
#endif
#if LUCERNA_FILM_LANES
  for (uint i = 0u; i < push.sample_count; ++i) {
#else
  // At least one: on lavapipe a loop tested at its end is faster.
  uint i = 0u;
  do {
#endif
    uint slot = index + i * push.pixel_count;
    bool even = ((block.first_sample + i) & 1u) == 0u;
    for (uint c = 0u; c < k_component_count; ++c) {
      vec3 light = light_of_component(slot, c);
      if (even) {
        film_half_add(sums[c].even, light);
      } else {
        film_half_add(sums[c].odd, light);
      }
    }
#if LUCERNA_LOOKUP_BIAS
    float bias = texelFetch(radiance_texels, int(radiance_texel(slot, 1u))).a;
    bias_even += even ? bias : 0.0;
    bias_odd += even ? 0.0 : bias;
#endif
#if !LUCERNA_FILM_LANES
    albedo += texelFetch(feature_texels, int(2u * slot));
    normal += texelFetch(feature_texels, int(2u * slot + 1u));
#if LUCERNA_VERTEX_COUNT
    vertices += vertices_of(slot);
#endif
#endif
#if LUCERNA_FILM_LANES
  }
  // Data common to all groups are added with the first.
  uint first_samples = push.group == 0u ? push.sample_count : 0u;
  for (uint i = 0u; i < first_samples; ++i) {
    uint slot = index + i * push.pixel_count;
    albedo += texelFetch(feature_texels, int(2u * slot));
    normal += texelFetch(feature_texels, int(2u * slot + 1u));
#if LUCERNA_VERTEX_COUNT
    vertices += vertices_of(slot);
#endif
  }
  // Without new samples nothing is written; a loop, because a branch saves no work on lavapipe.
  for (uint once = 0u; once < min(push.sample_count, 1u); ++once) {
    LUCERNA_FILM_STORE(group_primary_out, pixel, sums[0])
    LUCERNA_FILM_STORE(group_secondary_out, pixel, sums[1])
    LUCERNA_FILM_STORE(group_tertiary_out, pixel, sums[2])
    LUCERNA_FILM_STORE(group_caustic_out, pixel, sums[3])
    vec3 all = vec3(0.0);
    for (uint c = 0u; c < k_component_count; ++c) all += sums[c].even.sum + sums[c].odd.sum;
    // The first group's dispatch has counted the samples for the others.
    uint count = film_count[pixel] + (push.group == 0u ? push.sample_count : 0u);
    vec3 short_light = min(all / float(max(count, 1u)), vec3(65504.0));
    if (push.quick != 0u)
      group_lights_out[(push.group / 2u * push.width * push.height + pixel) * 2u + push.group % 2u] =
          GroupLight(packHalf2x16(short_light.rg), packHalf2x16(vec2(short_light.b, 0.0)));
  }
  // The picture is the sum of the groups in a fixed order, so that it does not depend on when it is computed.
  FilmPixel none = FilmPixel(FilmHalf(vec3(0.0), vec3(0.0)), FilmHalf(vec3(0.0), vec3(0.0)));
  vec3 weight = light_weight(push.group);
  for (uint c = 0u; c < k_component_count; ++c) {
    FilmPixel of_group = sums[c];
    sums[c] = none;
    if (push.group > 0u) sums[c] = film_load(c, pixel);
    add_mixed(sums[c].even, of_group.even, weight);
    add_mixed(sums[c].odd, of_group.odd, weight);
  }
#else
  } while (++i < push.sample_count);
#endif
  LUCERNA_FILM_STORE(film_primary_out, pixel, sums[0])
  LUCERNA_FILM_STORE(film_secondary_out, pixel, sums[1])
  LUCERNA_FILM_STORE(film_tertiary_out, pixel, sums[2])
  LUCERNA_FILM_STORE(film_caustic_out, pixel, sums[3])
#if LUCERNA_FILM_LANES
  if (first_samples == 0u) return;
#endif
  LUCERNA_FILM_WRITE(film_albedo_out, int(pixel), albedo);
  LUCERNA_FILM_WRITE(film_normal_out, int(pixel), normal);
  film_count[pixel] += push.sample_count;
#if LUCERNA_VERTEX_COUNT
  film_vertices[pixel] += vertices;
#endif
#if LUCERNA_LOOKUP_BIAS
  film_bias_even[pixel] = bias_even;
  film_bias_odd[pixel] = bias_odd;
#endif
}
