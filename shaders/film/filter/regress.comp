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

const int k_reach = 3;

// True for secondary and tertiary light, which has few edges but those of surfaces; direct light and caustics have their own.
bool is_smooth() { return push.component == 1u || push.component == 2u; }

// Moments of seven regressors, in groups of four and three, and of light. Of the symmetric matrices, one triangle.
struct Moments {
  vec4 a0;    // column 0 of a a^T, from the diagonal on, and so on
  vec3 a1;
  vec2 a2;
  float a3;
  mat3x4 ab;  // a b^T
  vec3 b0;
  vec2 b1;
  float b2;
  mat3x4 ya;
  mat3 yb;
};
void add(inout Moments m, float w, vec4 a, vec3 b, vec3 y) {
  vec4 wa = w * a;
  vec3 wb = w * b;
  m.a0 += wa;  // a.x is 1
  m.a1 += wa.y * a.yzw;
  m.a2 += wa.z * a.zw;
  m.a3 += wa.w * a.w;
  m.ab += outerProduct(wa, b);
  m.b0 += wb.x * b;
  m.b1 += wb.y * b.yz;
  m.b2 += wb.z * b.z;
  m.ya += outerProduct(wa, y);
  m.yb += outerProduct(wb, y);
}
Moments no_moments() {
  return Moments(vec4(0.0), vec3(0.0), vec2(0.0), 0.0, mat3x4(0.0), vec3(0.0), vec2(0.0), 0.0, mat3x4(0.0), mat3(0.0));
}
// The light where all regressors but the constant are 0: normal equations, three unknowns eliminated.
vec3 solve(Moments m) {
  float ridge = (is_smooth() ? k_filter_ridge_smooth : k_filter_ridge) * m.a0.x;
  mat4 aa = mat4(m.a0, vec4(m.a0.y, m.a1), vec4(m.a0.z, m.a1.y, m.a2), vec4(m.a0.w, m.a1.z, m.a2.y, m.a3));
  mat3 bb = mat3(m.b0, vec3(m.b0.y, m.b1), vec3(m.b0.z, m.b1.y, m.b2));
  aa[1][1] += ridge;
  aa[2][2] += ridge;
  aa[3][3] += k_filter_ridge_albedo * m.a0.x;
  for (int i = 0; i < 3; ++i) bb[i][i] += ridge;
  // aa x + ab z = ya; ab^T x + bb z = yb.
  mat3x4 left = m.ab * inverse(bb);
  mat4 schur = aa - left * transpose(m.ab);
  mat3x4 right = m.ya - left * m.yb;
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
  Moments even = no_moments(), odd = no_moments();
  vec2 most = vec2(0.0);  // weight of a neighbour, even and odd
  float least_alike = is_smooth() ? log2(k_filter_least_alike) : -1e30;
  float per_depth = 10.0 / max(window.surface.depth, 1e-20);
  // Unit normals near this one differ from it by their parts in its tangent plane only, to first order.
  vec3 tangent, bitangent;
  make_basis(window.surface.normal, tangent, bitangent);
  mat2x3 tangents = mat2x3(tangent, bitangent);
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -window_row(k_reach, y); x <= window_row(k_reach, y); ++x) {
      ivec2 step = int(push.stride) * ivec2(x, y), at = window.xy + step;
      bool inside = window_has(at) && (x != 0 || y != 0);
      int there = inside ? at.y * int(push.width) + at.x : int(pixel);
      FilterSurface s = filter_surface(texelFetch(filter_surfaces, there));
      FilterLight light = filter_light(texelFetch(filter_data, there)), g = guide_at(there, light);
      float alike = filter_log_alike(window.surface, s, vec2(step), window.slope);
      // Almost similar surfaces count where there are no similar ones.
      alike = max(alike, log2(k_filter_unlike) + max(0.05 * alike, least_alike));
      float v = square(g.deviation) + square(g.in_both);
      float by_odd = inside ? exp2(alike - distance_of(guide.odd, g.odd, variance, v)) : 0.0;
      float by_even = inside ? exp2(alike - distance_of(guide.even, g.even, variance, v)) : 0.0;
      vec4 a = vec4(1.0, vec2(x, y) * (1.0 / float(k_reach)), luminance(window.surface.albedo) / luminance(s.albedo) - 1.0);
      vec3 b = vec3((s.normal - window.surface.normal) * tangents, (s.depth - window.surface.depth) * per_depth);
      if (s.covered == 0.0 || window.surface.covered == 0.0) b = vec3(0.0);
      add(even, by_odd, a, b, light.even);
      add(odd, by_even, a, b, light.odd);
      most = max(most, vec2(by_odd, by_even));
    }
  // In smooth light the pixel itself has the weight of its most similar neighbour, and more if its noise is far below the light.
  // A pixel unlike all others would keep its noise if its own weight were 1.
  float signal = 0.5 * (dot(guide.even, guide.even) + dot(guide.odd, guide.odd));
  float certain = is_smooth() ? signal / (signal + k_filter_certain * square(own.deviation) + 1e-20) : 1.0;
  vec2 weight = mix(max(most, vec2(k_filter_least_own)), vec2(1.0), certain);
  add(even, weight.x, vec4(1.0, vec3(0.0)), vec3(0.0), own.even);
  add(odd, weight.y, vec4(1.0, vec3(0.0)), vec3(0.0), own.odd);
  fitted[pixel] = filter_texel(FilterLight(max(solve(even), vec3(0.0)), max(solve(odd), vec3(0.0)), 0.0, 0.0));
}
