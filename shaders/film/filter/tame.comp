// Limits light in each half that is probably chance. Light above the maximum of the other half around it is reduced to that
// maximum. If both halves are bright in a pixel, but so many pixels are bright in either that two may coincide by chance, they
// are reduced to the usual brightness around. Light that both halves have stays, however small it is.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights;
layout(scalar) writeonly buffer FilterTamed { vec4 tamed[]; };

const int k_reach = 3, k_unmet_reach = 2;
const float k_pixels = float((2 * k_reach + 1) * (2 * k_reach + 1));

// Whether chance may explain `both` pixels that are bright in both halves, given the numbers of bright pixels in each half:
// Chernoff's bound of a Poisson variable of mean evens * odds / k_pixels.
bool by_chance(float both, float evens, float odds) {
  float expected = evens * odds / k_pixels;
  return both <= expected || both - expected + both * log(expected / both) > log(k_filter_chance);
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  FilterLight here = filter_light(texelFetch(filter_lights, int(pixel)));
  vec2 own = vec2(luminance(here.even), luminance(here.odd));  // even half, odd half, as in all pairs below
  float bright = min(own.x, own.y), both = 0.0;
  vec2 most = vec2(0.0), count = vec2(0.0), sum = vec2(0.0), squares = vec2(0.0);
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -k_reach; x <= k_reach; ++x) {
      ivec2 at = clamp(xy + ivec2(x, y), ivec2(0), size - 1);
      FilterLight l = filter_light(texelFetch(filter_lights, at.y * size.x + at.x));
      vec2 value = vec2(luminance(l.even), luminance(l.odd));
      if (max(abs(x), abs(y)) <= k_unmet_reach) most = max(most, value);
      count += vec2(greaterThanEqual(value, vec2(bright)));
      both += min(value.x, value.y) >= bright ? 1.0 : 0.0;
      sum += value;
      squares += value * value;
    }
  most *= k_filter_confirmed;
  if (by_chance(both, count.x, count.y)) {
    vec2 usual = (sum - own) / (k_pixels - 1.0), variance = (squares - own * own) / (k_pixels - 1.0) - usual * usual;
    vec2 limit = usual + k_filter_usual * sqrt(max(variance, vec2(0.0)));
    most = min(most, vec2(max(limit.x, limit.y)));
  }
  if (own.x > most.y) here.even *= most.y / own.x;
  if (own.y > most.x) here.odd *= most.x / own.y;
  tamed[pixel] = filter_texel(here);
}
