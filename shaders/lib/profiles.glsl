// Measured distributions of lamps: intensity by direction, bilinear in the two angles, sampled by cells of its grid in
// proportion to their flux, evenly within a cell.
#ifndef LUCERNA_LIB_PROFILES
#define LUCERNA_LIB_PROFILES
#include "lib/math.glsl"
#include "lib/hash.glsl"
#include "shaders/shared/scene.h"

uniform samplerBuffer light_profiles;

struct Profile {
  uint first, rows, columns;
};
Profile light_profile(uint bits) {
  uvec3 head = floatBitsToUint(texelFetch(light_profiles, int(bits >> k_light_profile_shift)).xyz);
  return Profile(head.x, head.y, head.z);
}

// Relative intensity along a direction, unit, and its density per solid angle. front, right: of the lamp.
float profile_share(Profile p, vec3 front, vec3 right, vec3 direction, out float density) {
  vec3 up = cross(right, front);
  vec2 across = vec2(dot(direction, right), dot(direction, up));
  float polar = atan(length(across), dot(direction, front)) * k_inv_pi;
  float around = fract(0.5 * k_inv_pi * atan(across.y, across.x));
  float row = polar * float(p.rows - 1u), column = around * float(p.columns);
  uint r = min(uint(row), p.rows - 2u), c = min(uint(column), p.columns - 1u), next = c + 1u == p.columns ? 0u : c + 1u;
  uint at = p.first + r * p.columns;
  vec4 a = texelFetch(light_profiles, int(at + c));
  float b = texelFetch(light_profiles, int(at + next)).x;
  float d = texelFetch(light_profiles, int(at + p.columns + c)).x, e = texelFetch(light_profiles, int(at + p.columns + next)).x;
  density = a.w;
  vec2 f = vec2(column - float(c), row - float(r));
  return mix(mix(a.x, b, f.x), mix(d, e, f.x), f.y);
}

// Uniform over the directions of a cell that is chosen by 64 random bits.
vec3 sample_profile(Profile p, vec3 front, vec3 right, uvec2 bits, vec2 u) {
  uint cells = (p.rows - 1u) * p.columns, i, fraction, more, lost, carry;
  umulExtended(bits.x, cells, i, fraction);
  umulExtended(bits.y, cells, more, lost);
  fraction = uaddCarry(fraction, more, carry);
  i += carry;
  vec4 cell = texelFetch(light_profiles, int(p.first + i));
  i = coin_below(fraction, cell.y) ? i : floatBitsToUint(cell.z);
  uint column = i % p.columns, row = i / p.columns;
  // By sin^2 of half the angle to the nearer pole: near a pole all cosines round to 1.
  bool back = 2u * row >= p.rows - 1u;
  uint from_pole = back ? p.rows - 2u - row : row;
  float half_row = 0.5 * k_pi / float(p.rows - 1u);
  float s = mix(square(sine(half_row * float(from_pole))), square(sine(half_row * float(from_pole + 1u))), back ? 1.0 - u.y : u.y);
  float z = back ? 2.0 * s - 1.0 : 1.0 - 2.0 * s, r = 2.0 * sqrt(max(0.0, s * (1.0 - s)));
  float phi = 2.0 * k_pi * (float(column) + u.x) / float(p.columns);
  return normalize(r * (cos(phi) * right + sin(phi) * cross(right, front)) + z * front);
}

#endif
