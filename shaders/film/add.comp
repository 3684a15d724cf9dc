// Adds a batch's finished paths to the film: one invocation a pixel, samples in their order, so that the sums do not depend
// on how samples were cut into batches.
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilmPush push; };
uniform samplerBuffer radiance_texels;
uniform samplerBuffer feature_texels;
#if LUCERNA_VERTEX_COUNT
// How many vertices each pixel's paths had, from the state in which they ended: its share of the device's time.
#include "shaders/shared/transport.h"
uniform samplerBuffer path_texels;
layout(scalar) buffer FilmVertices { uint film_vertices[]; };
#endif

void add(inout FilmHalf h, vec3 x) {
  precise vec3 t = h.sum + x;
  precise vec3 lost_small = (h.sum - t) + x;   // |sum| >= |x|
  precise vec3 lost_large = (x - t) + h.sum;
  h.compensation += mix(lost_large, lost_small, greaterThanEqual(abs(h.sum), abs(x)));
  h.sum = t;
}

void main() {
  uint index = global_index();
  if (index >= push.pixel_count) return;
  WorkBlock block = blocks[index / 64u];
  uvec2 xy = block_pixel(block.index, index % 64u, push.width);
  if (xy.x >= push.width || xy.y >= push.height) return;
  uint pixel = xy.y * push.width + xy.x;
  uint pixels = push.width * push.height;
  FilmPixel sums[k_lane_count];
  for (uint lane = 0u; lane < k_lane_count; ++lane) sums[lane] = film_load(lane, pixel, pixels);
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
#if LUCERNA_VERTEX_COUNT
  uint vertices = 0u;
#endif
  for (uint i = 0u; i < push.sample_count; ++i) {
    uint slot = index + i * push.pixel_count;
    bool even = ((block.first_sample + i) & 1u) == 0u;
    for (uint lane = 0u; lane < k_lane_count; ++lane) {
      vec3 brought = texelFetch(radiance_texels, int(radiance_texel(slot, lane))).rgb;
      if (even) {
        add(sums[lane].even, brought);
      } else {
        add(sums[lane].odd, brought);
      }
    }
    albedo += texelFetch(feature_texels, int(2u * slot));
    normal += texelFetch(feature_texels, int(2u * slot + 1u));
#if LUCERNA_VERTEX_COUNT
    // PathState.bits: the events that led on and the surfaces passed since; the last vertex is not among them.
    uint bits = floatBitsToUint(texelFetch(path_texels, int(3u * slot + 1u))).z;
    vertices += 1u + (bits >> 8 & 0xffffu) + (bits >> 24);
#endif
  }
  for (uint group = 0u; group < k_group_count; ++group) {
    uint first = lane_of(group, 0u), place = film_place(first, pixel, pixels);
    LUCERNA_FILM_STORE(film_primary_out, place, sums[first])
    LUCERNA_FILM_STORE(film_secondary_out, place, sums[first + 1u])
    LUCERNA_FILM_STORE(film_tertiary_out, place, sums[first + 2u])
    LUCERNA_FILM_STORE(film_caustic_out, place, sums[first + 3u])
  }
  LUCERNA_FILM_WRITE(film_albedo_out, int(pixel), albedo);
  LUCERNA_FILM_WRITE(film_normal_out, int(pixel), normal);
  film_count[pixel] += push.sample_count;
#if LUCERNA_VERTEX_COUNT
  film_vertices[pixel] += vertices;
#endif
}
