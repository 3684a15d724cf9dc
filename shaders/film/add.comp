// Adds a batch's finished paths to the film: one invocation a pixel, samples in their order, so that the sums do not depend
// on how samples were cut into batches.
#include "lib/frame.glsl"
#include "lib/film.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilmPush push; };
layout(scalar) readonly buffer Paths { PathState paths[]; };
layout(scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(scalar) readonly buffer Features { vec4 features[]; };

uint compact_bits(uint x) { return (x & 1u) | ((x >> 1) & 2u) | ((x >> 2) & 4u); }

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
  uint tile = push.first_tile + index / 64u, code = index % 64u;
  uint tiles_x = (push.width + 7u) / 8u;
  uvec2 xy = 8u * uvec2(tile % tiles_x, tile / tiles_x) + uvec2(compact_bits(code), compact_bits(code >> 1));
  if (xy.x >= push.width || xy.y >= push.height) return;
  uint pixel = xy.y * push.width + xy.x;
  FilmHalf p[2], s[2], t[2], c[2];
  for (uint k = 0u; k < 2u; ++k) {
    p[k] = film_primary[2u * pixel + k];
    s[k] = film_secondary[2u * pixel + k];
    t[k] = film_tertiary[2u * pixel + k];
    c[k] = film_caustic[2u * pixel + k];
  }
  vec4 albedo = film_albedo[pixel], normal = film_normal[pixel];
  for (uint i = 0u; i < push.sample_count; ++i) {
    uint slot = index + i * push.pixel_count;
    vec3 rp = radiance[slot * 4u], rs = radiance[slot * 4u + 1u], rt = radiance[slot * 4u + 2u], rc = radiance[slot * 4u + 3u];
    if (((push.first_sample + i) & 1u) == 0u) {
      add(p[0], rp); add(s[0], rs); add(t[0], rt); add(c[0], rc);
    } else {
      add(p[1], rp); add(s[1], rs); add(t[1], rt); add(c[1], rc);
    }
    albedo += features[2u * slot];
    normal += features[2u * slot + 1u];
  }
  for (uint k = 0u; k < 2u; ++k) {
    film_primary[2u * pixel + k] = p[k];
    film_secondary[2u * pixel + k] = s[k];
    film_tertiary[2u * pixel + k] = t[k];
    film_caustic[2u * pixel + k] = c[k];
  }
  film_albedo[pixel] = albedo;
  film_normal[pixel] = normal;
  film_count[pixel] += push.sample_count;
}
