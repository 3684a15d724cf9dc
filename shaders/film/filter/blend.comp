// Converts the chosen light to sums of the filtered film.
#include "lib/film.glsl"
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_surfaces, filter_chosen, filter_taken;
layout(scalar) writeonly buffer FilteredSums { vec4 filtered[]; };

// Factor that restores the light that taming removed around a pixel, as far as both halves have it.
float restored(ivec2 xy) {
  ivec2 blocks = (ivec2(push.width, push.height) + int(k_filter_block) - 1) / int(k_filter_block);
  vec2 at = (vec2(xy) + 0.5) / float(k_filter_block) - 0.5;
  vec4 sums = vec4(0.0);
  for (int y = -1; y <= 2; ++y)
    for (int x = -1; x <= 2; ++x) {
      ivec2 cell = ivec2(floor(at)) + ivec2(x, y), there = clamp(cell, ivec2(0), blocks - 1);
      vec2 off = max(1.0 - 0.5 * abs(at - vec2(cell)), 0.0);
      sums += off.x * off.y * texelFetch(filter_taken, there.y * blocks.x + there.x);
    }
  vec2 ratio = sums.xy / max(sums.zw, vec2(1e-20));
  return 1.0 + min(min(ratio.x, ratio.y), k_filter_most_restored);
}

// Sum over the `samples` of one half of a pixel. `mean`: mean of the unfiltered samples.
vec3 blended(vec3 chosen, vec3 mean, vec3 albedo, float ratio, float samples) {
  vec3 light = chosen * albedo / push.scale;
  bool same = all(lessThanEqual(abs(light - mean), k_filter_same * mean)) || max3(mean * push.scale / albedo) > k_filter_largest;
  return samples * (same ? mean : ratio * light);
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 xy = ivec2(pixel % push.width, pixel / push.width);
  FilterLight c = filter_light(texelFetch(filter_chosen, int(pixel)));
  vec3 albedo = filter_surface(texelFetch(filter_surfaces, int(pixel))).albedo;
  FilmPixel p = film_load(push.component, pixel, film_ratio(pixel));
  vec3 even = p.even.sum + p.even.compensation, odd = p.odd.sum + p.odd.compensation;
  uint count = film_count[pixel];
  if (count >= 2u) {
    float n = float((count + 1u) / 2u), m = float(count / 2u), ratio = restored(xy);
    even = blended(c.even, even / n, albedo, ratio, n);
    odd = blended(c.odd, odd / m, albedo, ratio, m);
  }
  filtered[3u * pixel] = vec4(even, 0.0);
  filtered[3u * pixel + 1u] = vec4(vec2(0.0), odd.xy);
  filtered[3u * pixel + 2u] = vec4(odd.z, vec3(0.0));
}
