// First-order regression of each half on surface features, over a window whose pixels are weighted by the other half.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
// Pixels are compared by guides, or by the light itself.
#ifndef LUCERNA_FILTER_GUIDED
#define LUCERNA_FILTER_GUIDED 1
#endif
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_data, filter_surfaces;
#if LUCERNA_FILTER_GUIDED
uniform samplerBuffer filter_guides;
#endif
layout(scalar) writeonly buffer FilterFitted { vec4 fitted[]; };
#include "film/filter/window.glsl"

// True for secondary and tertiary light, which has few edges but those of surfaces; direct light and caustics have their own.
bool is_smooth() { return push.component == 1u || push.component == 2u; }

// Moments of eight regressors, in two groups of four, and of light.
struct Moments {
  mat4 aa, ab, bb;
  mat3x4 ya, yb;
};
void add(inout Moments m, float w, vec4 a, vec4 b, vec3 y) {
  vec4 wa = w * a, wb = w * b;
  m.aa += outerProduct(wa, a);
  m.ab += outerProduct(wa, b);
  m.bb += outerProduct(wb, b);
  m.ya += outerProduct(wa, y);
  m.yb += outerProduct(wb, y);
}
// The light where all regressors but the constant are 0: normal equations, half of the unknowns eliminated.
vec3 solve(Moments m) {
  float ridge = (is_smooth() ? k_filter_ridge_smooth : k_filter_ridge) * m.aa[0][0];
  m.aa[1][1] += ridge;
  m.aa[2][2] += ridge;
  m.aa[3][3] += k_filter_ridge_albedo * m.aa[0][0];
  for (int i = 0; i < 4; ++i) m.bb[i][i] += ridge;
  // ab is a b^T: aa x + ab z = ya; ab^T x + bb z = yb.
  mat4 inverse_b = inverse(m.bb);
  mat4 schur = m.aa - m.ab * inverse_b * transpose(m.ab);
  mat3x4 right = m.ya - m.ab * inverse_b * m.yb;
  vec4 row = inverse(schur)[0];  // symmetric
  return row * right;
}

// Squared distance of light, in standard deviations beyond what noise explains.
float distance_of(vec3 a, vec3 b, float va, float vb) {
  float strength = push.component == 0u ? k_filter_strength_direct : k_filter_strength;
  vec3 d = a - b;
  float tolerance = square(k_filter_equal) * max(dot(a, a), dot(b, b));
  return max((dot(d, d) - va - min(va, vb)) / (square(strength) * (va + vb) + tolerance + 1e-20), 0.0);
}

FilterLight guide_at(int pixel, FilterLight light) {
#if LUCERNA_FILTER_GUIDED
  return filter_light(texelFetch(filter_guides, pixel));
#else
  return light;
#endif
}

void main() {
  uint pixel = push.first + global_index();
  if (pixel >= push.width * push.height) return;
  Window window = window_at(pixel);
  FilterLight own = filter_light(texelFetch(filter_data, int(pixel))), guide = guide_at(int(pixel), own);
  float variance = square(guide.deviation) + square(guide.in_both);
  Moments even, odd;
  even.aa = even.ab = even.bb = odd.aa = odd.ab = odd.bb = mat4(0.0);
  even.ya = even.yb = odd.ya = odd.yb = mat3x4(0.0);
  vec2 most = vec2(0.0);  // weight of a neighbour, even and odd
  float least_alike = is_smooth() ? log2(k_filter_least_alike) : -1e30;
  float z = max(window.surface.depth, 1e-20);
  for (int y = -k_window_reach; y <= k_window_reach; ++y)
    for (int x = -k_window_reach; x <= k_window_reach; ++x) {
      if (!window_near(x, y) || (x == 0 && y == 0)) continue;
      ivec2 step = int(push.stride) * ivec2(x, y), at = window.xy + step;
      bool inside = window_has(at);
      int there = inside ? at.y * int(push.width) + at.x : int(pixel);
      FilterSurface s = filter_surface(texelFetch(filter_surfaces, there));
      FilterLight light = filter_light(texelFetch(filter_data, there)), g = guide_at(there, light);
      float alike = filter_log_alike(window.surface, s, vec2(step), window.slope);
      // Almost similar surfaces count where there are no similar ones.
      alike = max(alike, log2(k_filter_unlike) + max(0.05 * alike, least_alike));
      float v = square(g.deviation) + square(g.in_both);
      float by_odd = inside ? exp2(alike - distance_of(guide.odd, g.odd, variance, v)) : 0.0;
      float by_even = inside ? exp2(alike - distance_of(guide.even, g.even, variance, v)) : 0.0;
      vec4 a = vec4(1.0, vec2(x, y) / float(k_window_reach), luminance(window.surface.albedo) / luminance(s.albedo) - 1.0);
      vec4 b = vec4(s.normal - window.surface.normal, (s.depth - window.surface.depth) / (0.1 * z));
      if (s.covered == 0.0 || window.surface.covered == 0.0) b = vec4(0.0);
      add(even, by_odd, a, b, light.even);
      add(odd, by_even, a, b, light.odd);
      most = max(most, vec2(by_odd, by_even));
    }
  // In smooth light the pixel itself has the weight of its most similar neighbour, and more if its noise is far below the light.
  // A pixel unlike all others would keep its noise if its own weight were 1.
  float signal = 0.5 * (dot(guide.even, guide.even) + dot(guide.odd, guide.odd));
  float certain = is_smooth() ? signal / (signal + k_filter_certain * square(own.deviation) + 1e-20) : 1.0;
  vec2 weight = mix(max(most, vec2(k_filter_least_own)), vec2(1.0), certain);
  add(even, weight.x, vec4(1.0, vec3(0.0)), vec4(0.0), own.even);
  add(odd, weight.y, vec4(1.0, vec3(0.0)), vec4(0.0), own.odd);
  fitted[pixel] = filter_texel(FilterLight(max(solve(even), vec3(0.0)), max(solve(odd), vec3(0.0)), 0.0, 0.0));
}
