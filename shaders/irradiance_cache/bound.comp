// Bounds the radius of a record by its neighbours in different directions: of those that it would serve, the
// nearest first, each counts whose direction is far enough from those of all before, until they stand all around. Beyond the
// last of them others are nearer on every side. A record at an open border, where nobody stands on one side, is left as it
// is: there it may be alone.
#include "shaders/shared/irradiance_cache/records.h"
#include "shaders/shared/irradiance_cache/neighbours.h"
#include "lib/invocation.glsl"
#include "lib/math.glsl"
#include "irradiance_cache/shrink.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { NeighbourPush push; };
uniform samplerBuffer record_texels;
uniform usamplerBuffer pair_texels;  // SortEntry64, sorted

// The first pair of a record, or of one after it.
uint first_pair(uint own) {
  uint lo = 0u, hi = push.pairs;
  while (lo < hi) {
    uint middle = (lo + hi) / 2u;
    uvec4 pair = texelFetch(pair_texels, int(middle));
    uint whose = pair.y << (32u - k_neighbour_distance_bits) | pair.x >> k_neighbour_distance_bits;
    if (whose < own) lo = middle + 1u;
    else hi = middle;
  }
  return lo;
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  int at = int(index * k_record_texels);
  vec4 place = texelFetch(record_texels, at);
  vec3 tangent, bitangent;
  make_basis(texelFetch(record_texels, at + 1).xyz, tangent, bitangent);

  // Directions are an ellipse's own, in which it is a circle: along its greater axis others would seem crowded.
  vec4 shape = texelFetch(record_texels, at + 3);
  vec2 axis = vec2(dot(shape.xyz, tangent), dot(shape.xyz, bitangent));
  float squeeze = dot(axis, axis) > 0.0 ? (1.0 - shape.w / place.w) / dot(axis, axis) : 0.0;

  vec2 towards[k_neighbours];
  uint count = 0u;
  float reach = 1.0;
  uint last = first_pair(index + 1u);
  for (uint i = first_pair(index); i < last && count < k_neighbours && reach == 1.0; ++i) {
    uvec4 pair = texelFetch(pair_texels, int(i));
    vec3 away = texelFetch(record_texels, int(pair.z * k_record_texels)).xyz - place.xyz;
    vec2 flat_ = vec2(dot(away, tangent), dot(away, bitangent));
    flat_ -= squeeze * dot(flat_, axis) * axis;
    // Two in one place are one.
    if (dot(flat_, flat_) <= 0.0) continue;
    vec2 direction = normalize(flat_);
    bool apart = true;
    for (uint k = 0u; k < count; ++k) apart = apart && dot(direction, towards[k]) <= push.apart;
    if (!apart) continue;
    towards[count++] = direction;
    // The greatest angle from one to the next.
    float gap = 0.0;
    for (uint k = 0u; k < count; ++k) {
      float next = 2.0 * k_pi;
      for (uint l = 0u; l < count; ++l) {
        vec2 a = towards[k], b = towards[l];
        float angle = atan(a.x * b.y - a.y * b.x, dot(a, b));
        if (l != k) next = min(next, angle < 0.0 ? angle + 2.0 * k_pi : angle);
      }
      gap = max(gap, next);
    }
    if (gap <= push.gap) reach = uintBitsToFloat(pair.x & (1u << k_neighbour_distance_bits) - 1u);
  }

  shrink_record(index, place, shape, reach);
}
