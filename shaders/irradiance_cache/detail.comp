// One level of the detail pyramid: for every cell the mean of the finer level, and the change towards its neighbours.
//
// A cell's own detail is evaluated at its middle point, so that cells of a flat wall agree up to rounding at every level;
// mean positions would show a bent wall at every silhouette. The mean of the finer levels covers the rest of the cell.
// Geometric detail: distance of a neighbour from the cell's plane over the cell's width, or the turn of its normal; 1 where
// a record in one cell cannot serve the other. A step of a hundredth of a cell therefore counts at the level of its own
// height, not for the whole wall, and an edge counts at every level. Irradiance detail: relative difference beyond noise
// between points of one surface that records serve.
#include "lib/invocation.glsl"
#include "lib/math.glsl"
#include "shaders/shared/irradiance_cache/discontinuity.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { DetailPush push; };
uniform samplerBuffer surface_texels;
layout(scalar) readonly buffer Lit { vec3 lit[]; };
layout(scalar) buffer Details { float details[]; };

uvec2 cells_of(uint level) { return (uvec2(push.across, push.down) + (1u << level) - 1u) >> level; }

// Middle point of a cell.
uint middle(uvec2 cell) {
  uvec2 xy = min((cell << push.level) + ((1u << push.level) >> 1u), uvec2(push.across, push.down) - 1u);
  return xy.y * push.across + xy.x;
}

struct Point {
  vec4 place;
  vec3 normal;
  float light, error;
};
Point point_at(uint index) {
  Point p;
  p.place = texelFetch(surface_texels, int(index * k_surface_texels));
  p.normal = texelFetch(surface_texels, int(index * k_surface_texels + 1u)).xyz;
  p.light = lit[index].x;
  p.error = lit[index].z;
  return p;
}

float change(Point p, Point q) {
  bool both = p.place.w >= 0.0 && q.place.w >= 0.0;
  vec3 away = q.place.xyz - p.place.xyz;
  float off = max(abs(dot(away, p.normal)), abs(dot(away, q.normal)));
  float width = push.pixel * float(1u << push.level) * (push.parallel != 0u ? 1.0 : min(p.place.w, q.place.w));
  float geometry = max(push.depth_weight * off / max(width, 1e-30), push.normal_weight * distance(p.normal, q.normal));
  if (push.irradiance_weight <= 0.0) return both ? min(geometry, 1.0) : 0.0;
  bool same = both && geometry < 1.0 && p.light >= 0.0 && q.light >= 0.0;
  float whole = max(max(p.light, q.light), push.least);
  float light = abs(p.light - q.light) / whole;
  // A record that is too bright by chance must not attract more records: they would dilute its excess, and nothing would
  // make up for the light that the others missed.
  float noise = max(push.irradiance_noise, 2.0 * length(vec2(p.error, q.error)) / whole);
  return same ? clamp(push.irradiance_weight * (light - noise), 0.0, 1.0) : 0.0;
}

void main() {
  uint index = global_index();
  uvec2 cells = cells_of(push.level);
  if (index >= cells.x * cells.y) return;
  uvec2 cell = uvec2(index % cells.x, index / cells.x);
  Point here = point_at(middle(cell));
  float own = 0.0;
  for (int side = 0; side < 4; ++side) {
    ivec2 to = ivec2(cell) + (side < 2 ? ivec2(2 * side - 1, 0) : ivec2(0, 2 * side - 5));
    bool inside = all(greaterThanEqual(to, ivec2(0))) && all(lessThan(to, ivec2(cells)));
    float found = change(here, point_at(middle(inside ? uvec2(to) : cell)));
    own = max(own, inside ? found : 0.0);
  }
  float sum = 0.0, count = 0.0;
  if (push.level > 0u) {
    uvec2 finer = cells_of(push.level - 1u);
    for (uint child = 0u; child < 4u; ++child) {
      uvec2 to = 2u * cell + uvec2(child & 1u, child >> 1u);
      bool inside = to.x < finer.x && to.y < finer.y;
      uvec2 from = min(to, finer - 1u);
      float found = details[push.finer + from.y * finer.x + from.x];
      sum += inside ? found : 0.0;
      count += inside ? 1.0 : 0.0;
    }
  }
  details[push.first + index] = min(own + (count > 0.0 ? sum / count : 0.0), 1.0);
}
