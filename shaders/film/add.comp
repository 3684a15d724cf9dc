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
  FilmPixel p = film_load(0u, pixel), s = film_load(1u, pixel), t = film_load(2u, pixel), c = film_load(3u, pixel);
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
#if LUCERNA_VERTEX_COUNT
  uint vertices = 0u;
#endif
  for (uint i = 0u; i < push.sample_count; ++i) {
    uint slot = index + i * push.pixel_count;
    int first = int(slot * k_component_count);
    vec3 rp = texelFetch(radiance_texels, first).rgb, rs = texelFetch(radiance_texels, first + 1).rgb;
    vec3 rt = texelFetch(radiance_texels, first + 2).rgb, rc = texelFetch(radiance_texels, first + 3).rgb;
    if (((block.first_sample + i) & 1u) == 0u) {
      add(p.even, rp); add(s.even, rs); add(t.even, rt); add(c.even, rc);
    } else {
      add(p.odd, rp); add(s.odd, rs); add(t.odd, rt); add(c.odd, rc);
    }
    albedo += texelFetch(feature_texels, int(2u * slot));
    normal += texelFetch(feature_texels, int(2u * slot + 1u));
#if LUCERNA_VERTEX_COUNT
    // PathState.bits: the events that led on and the surfaces passed since; the last vertex is not among them.
    uint bits = floatBitsToUint(texelFetch(path_texels, int(3u * slot + 1u))).z;
    vertices += 1u + (bits >> 8 & 0xffffu) + (bits >> 24);
#endif
  }
  LUCERNA_FILM_STORE(film_primary_out, pixel, p)
  LUCERNA_FILM_STORE(film_secondary_out, pixel, s)
  LUCERNA_FILM_STORE(film_tertiary_out, pixel, t)
  LUCERNA_FILM_STORE(film_caustic_out, pixel, c)
  LUCERNA_FILM_WRITE(film_albedo_out, int(pixel), albedo);
  LUCERNA_FILM_WRITE(film_normal_out, int(pixel), normal);
  film_count[pixel] += push.sample_count;
#if LUCERNA_VERTEX_COUNT
  film_vertices[pixel] += vertices;
#endif
}
