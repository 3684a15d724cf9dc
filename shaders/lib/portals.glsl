// Sampling the sky through portals (shared/portals.h). For lib/lights.glsl.
#ifndef LUCERNA_LIB_PORTALS
#define LUCERNA_LIB_PORTALS
#include "lib/variants.glsl"
#include "shaders/shared/portals.h"

uniform samplerBuffer scene_portals;
uniform samplerBuffer portal_sums;

const uint k_no_portal = 0xffffffffu;

// A portal seen from a point: its rectangle of the map, in texels.
struct PortalView {
  vec3 s, t, n;    // unit vectors along the width and the height, and towards the room
  vec2 low, high;  // empty if the point is behind the portal or in its plane
  uvec2 first, end;  // texels that it touches
};
PortalView portal_view(uint portal, vec3 position) {
  int at = int(portal * k_portal_texels);
  vec4 a = texelFetch(scene_portals, at), b = texelFetch(scene_portals, at + 1), c = texelFetch(scene_portals, at + 2);
  PortalView view;
  view.s = b.xyz, view.t = c.xyz;
  view.n = cross(view.s, view.t);
  vec3 off = position - a.xyz;
  float height = dot(off, view.n);
  vec2 middle = -vec2(dot(off, view.s), dot(off, view.t)), half_size = vec2(a.w, b.w);
  vec2 low = middle - half_size, high = middle + half_size;
  // m = X / (1 + |X|) with X = low / height.
  const float side = float(k_portal_side);
  float from = max(height, 1e-37);
  view.low = clamp((0.5 + 0.5 * low / (from + abs(low))) * side, 0.0, side);
  view.high = clamp((0.5 + 0.5 * high / (from + abs(high))) * side, 0.0, side);
  if (!(height > 0.0)) view.high = view.low;
  view.first = min(uvec2(view.low), uvec2(k_portal_side - 1u));
  view.end = clamp(uvec2(ceil(view.high)), view.first + 1u, uvec2(k_portal_side));
  return view;
}
bool portal_seen(PortalView view) { return view.high.x > view.low.x && view.high.y > view.low.y; }

uint portal_sum(uint portal, uint column, uint row) {
  uint word = portal * k_portal_words + row * (k_portal_side + 1u) + column;
  vec4 four = texelFetch(portal_sums, int(word >> 2));
  vec2 two = (word & 2u) != 0u ? four.zw : four.xy;
  return floatBitsToUint((word & 1u) != 0u ? two.y : two.x);
}
// Sum of a column's or of all weights within rows.
uint portal_sum_below(uint portal, uint column, uvec2 rows) { return portal_sum(portal, column, rows.y) - portal_sum(portal, column, rows.x); }

// Density per solid angle of a direction in a texel of weight `weight`, of `sum_seen` in the rectangle. Within a texel, the part
// in the rectangle is sampled uniformly. `local`: along s, t and out of the room.
float portal_density(PortalView view, uvec2 texel, uint weight, uint sum_seen, vec3 local) {
  vec2 size = (min(view.high, vec2(texel + 1u)) - max(view.low, vec2(texel))) * (2.0 / float(k_portal_side));
  vec2 stretch = local.z + abs(local.xy);
  float jacobian = square(stretch.x * stretch.y) / max(local.z, 1e-37);
  float area = size.x * size.y * jacobian;
  return size.x > 0.0 && size.y > 0.0 && area > 0.0 && sum_seen > 0u ? float(weight) / (float(sum_seen) * area) : 0.0;
}

// Direction to the sky through a portal, and its density by this portal alone; density 0: there is none. bits, u: random.
vec3 sample_portal(uint portal, vec3 position, uvec2 bits, vec2 u, out float pdf) {
  PortalView view = portal_view(portal, position);
  uvec2 rows = uvec2(view.first.y, view.end.y);
  uint before = portal_sum_below(portal, view.first.x, rows);
  uint sum_seen = portal_sum_below(portal, view.end.x, rows) - before, target, lost;
  // The column whose weights, with those left of it, first exceed the target; then the row in it.
  umulExtended(bits.x, sum_seen, target, lost);
  uint low = view.first.x, high = view.end.x - 1u, below = 0u;
  while (low < high) {
    uint middle = (low + high) >> 1;
    uint sum = portal_sum_below(portal, middle + 1u, rows) - before;
    bool right = sum <= target;
    low = right ? middle + 1u : low;
    high = right ? high : middle;
  }
  uvec2 texel = uvec2(low, 0u);
  before = portal_sum(portal, texel.x + 1u, rows.x) - portal_sum(portal, texel.x, rows.x);
  uint column = portal_sum_below(portal, texel.x + 1u, rows) - portal_sum_below(portal, texel.x, rows);
  umulExtended(bits.y, column, target, lost);
  low = view.first.y, high = view.end.y - 1u;
  while (low < high) {
    uint middle = (low + high) >> 1;
    uint sum = portal_sum(portal, texel.x + 1u, middle + 1u) - portal_sum(portal, texel.x, middle + 1u) - before;
    bool up = sum <= target;
    low = up ? middle + 1u : low;
    high = up ? high : middle;
  }
  texel.y = low;
  uvec2 own = uvec2(low, low + 1u);
  uint weight = portal_sum_below(portal, texel.x + 1u, own) - portal_sum_below(portal, texel.x, own);
  vec2 m = mix(max(view.low, vec2(texel)), min(view.high, vec2(texel + 1u)), u) * (2.0 / float(k_portal_side)) - 1.0;
  vec2 rest = max(1.0 - abs(m), vec2(1e-7));
  vec3 local = normalize(vec3(m * rest.yx, rest.x * rest.y));
  pdf = portal_seen(view) ? portal_density(view, texel, weight, sum_seen, local) : 0.0;
  return local.x * view.s + local.y * view.t - local.z * view.n;
}

// False only if the direction does not pass through the portal: quicker than portal_pdf().
bool portal_near(uint portal, vec3 position, vec3 direction) {
  int at = int(portal * k_portal_texels);
  vec4 a = texelFetch(scene_portals, at), b = texelFetch(scene_portals, at + 1), c = texelFetch(scene_portals, at + 2);
  vec3 n = cross(b.xyz, c.xyz), off = position - a.xyz;
  float height = dot(off, n), out_of = -dot(direction, n);
  // Where it meets the portal's plane, times out_of, with room for rounding.
  vec2 from = vec2(dot(off, b.xyz), dot(off, c.xyz)) * out_of, to = vec2(dot(direction, b.xyz), dot(direction, c.xyz)) * height;
  bvec2 within = lessThanEqual(abs(from + to), 1.001 * vec2(a.w, b.w) * out_of + 1e-5 * (abs(from) + abs(to)));
  return height > 0.0 && out_of > 0.0 && all(within);
}

// Density of sample_portal() for a direction.
float portal_pdf(uint portal, vec3 position, vec3 direction) {
  PortalView view = portal_view(portal, position);
  vec3 local = vec3(dot(direction, view.s), dot(direction, view.t), -dot(direction, view.n));
  vec2 m = local.xy / (max(local.z, 1e-37) + abs(local.xy));
  vec2 at = (0.5 + 0.5 * m) * float(k_portal_side);
  bool through = local.z > 0.0 && portal_seen(view) && at.x >= view.low.x && at.x <= view.high.x && at.y >= view.low.y && at.y <= view.high.y;
  uvec2 rows = uvec2(view.first.y, view.end.y), texel = clamp(uvec2(max(at, vec2(0.0))), view.first, view.end - 1u), own = uvec2(texel.y, texel.y + 1u);
  uint sum_seen = portal_sum_below(portal, view.end.x, rows) - portal_sum_below(portal, view.first.x, rows);
  uint weight = portal_sum_below(portal, texel.x + 1u, own) - portal_sum_below(portal, texel.x, own);
  return through ? portal_density(view, texel, weight, sum_seen, local) : 0.0;
}

// Probability of a portal among the portals, without learning.
float portal_share(uint portal) { return texelFetch(scene_portals, int(portal * k_portal_texels + 2u)).w; }

// Chooses a portal, or none with probability 1 - k_portal_share. The remainder of the random number is uniform again.
uint choose_portal(inout uint bits) {
  float u = float(bits >> 8) * (1.0 / 16777216.0);
  bool any = u < k_portal_share;
  u = any ? u / k_portal_share : (u - k_portal_share) / (1.0 - k_portal_share);
  uint portal = k_no_portal;
  for (uint i = 0u; i < (any ? uint(LUCERNA_PORTALS) : 0u) && portal == k_no_portal; ++i) {
    float share = portal_share(i);
    bool here = share > 0.0 && u < share;
    portal = here ? i : portal;
    u = here ? u / share : u - share;
  }
  bits = uint(clamp(u, 0.0, 1.0) * 16777215.0) << 8;
  return portal;
}
#endif
