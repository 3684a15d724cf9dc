// Limits light in each half that is probably chance. Light above the maximum of the other half around it is reduced to that
// maximum. Where the other half is bright too, in the pixel itself or near it, but so many pixels are bright in either half that
// they may meet by chance, the pixel is reduced to the usual brightness around. Light that both halves have stays, however small
// it is.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights, filter_spread;
layout(scalar) writeonly buffer FilterTamed { vec4 tamed[]; };

const int k_reach = 3, k_wide_reach = 8;
const float k_pixels = float((2 * k_reach + 1) * (2 * k_reach + 1));
const float k_wide_pixels = float((2 * k_wide_reach + 1) * (2 * k_wide_reach + 1));

// Whether chance may explain that two sets of pixels meet in `both` pixels, if it lets them meet in `expected`: Chernoff's bound
// of a Poisson variable.
bool by_chance(float both, float expected) {
  return both <= expected || both - expected + both * log(expected / both) > log(k_filter_chance);
}

// Maximum of what is usual among `count` pixels with these sums of values and squares.
vec2 usual_limit(vec2 sum, vec2 squares, vec2 count) {
  vec2 mean = sum / count;
  return mean + k_filter_usual * sqrt(max(squares / count - mean * mean, vec2(0.0)));
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  vec4 here = texelFetch(filter_spread, int(pixel));
  vec2 own = here.xy;  // even half, odd half, as in all pairs below
  vec2 limit = k_filter_confirmed * here.wz;
  // Brightness that the other half has too, in the pixel and near it.
  float met = min(own.x, own.y);
  vec2 level = min(own, here.wz);
  // Of the pixels less bright than this one, and of all.
  vec2 others = vec2(0.0), sum = vec2(0.0), squares = vec2(0.0), all = vec2(0.0), all_squares = vec2(0.0);
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -k_reach; x <= k_reach; ++x) {
      ivec2 at = clamp(xy + ivec2(x, y), ivec2(0), size - 1);
      vec2 value = texelFetch(filter_spread, at.y * size.x + at.x).xy;
      vec2 below = vec2(lessThan(value, level));
      others += below;
      sum += below * value;
      squares += below * value * value;
      all += value;
      all_squares += value * value;
    }
  vec2 usual = usual_limit(sum, squares, max(others, vec2(1.0)));
  bvec2 unusual = bvec2(own.x > usual.x && others.x > 0.5 * k_pixels, own.y > usual.y && others.y > 0.5 * k_pixels);
  // Direct light has highlights of a pixel or two, and caustics have them where they are dense.
  float rare = push.component == 0u ? 0.0 : push.component == 3u ? k_filter_rare_caustic : k_filter_rare;
  if (any(unusual)) {
    // Pixels about as bright as this one is in both halves: in each half, and in both.
    vec2 bright = vec2(0.0);
    float both = 0.0;
    // Pixels as bright as this one in its half; pixels with such a one near them in the other half; pixels with both.
    vec2 ones = vec2(0.0), near = vec2(0.0), meet = vec2(0.0);
    for (int y = -k_wide_reach; y <= k_wide_reach; ++y)
      for (int x = -k_wide_reach; x <= k_wide_reach; ++x) {
        ivec2 at = clamp(xy + ivec2(x, y), ivec2(0), size - 1);
        vec4 there = texelFetch(filter_spread, at.y * size.x + at.x);
        bright += vec2(greaterThanEqual(there.xy, vec2(k_filter_alike_bright * met)));
        both += min(there.x, there.y) >= k_filter_alike_bright * met ? 1.0 : 0.0;
        vec2 a = vec2(greaterThanEqual(there.xy, level)), b = vec2(greaterThanEqual(there.wz, level));
        ones += a;
        near += b;
        meet += a * b;
      }
    // Of single pixels that meet among many that do not, some meet by chance in any picture.
    bool lone = both < 2.0 && bright.x + bright.y - 2.0 * both >= k_filter_lone;
    bool confirmed = !lone && !by_chance(both, bright.x * bright.y / k_wide_pixels);
    vec2 expected = ones * near / k_wide_pixels;
    if (!confirmed) {
      vec2 around = usual_limit(all - own, all_squares - own * own, vec2(k_pixels - 1.0));
      limit = min(limit, vec2(max(around.x, around.y)));
      if (unusual.x && expected.x < rare && by_chance(meet.x, expected.x)) limit.x = min(limit.x, usual.x);
      if (unusual.y && expected.y < rare && by_chance(meet.y, expected.y)) limit.y = min(limit.y, usual.y);
    }
  }
  FilterLight light = filter_light(texelFetch(filter_lights, int(pixel)));
  if (own.x > limit.x) light.even *= limit.x / own.x;
  if (own.y > limit.y) light.odd *= limit.y / own.y;
  tamed[pixel] = filter_texel(light);
}
