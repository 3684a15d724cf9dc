// Pictures that spots project: bilinear on a plane across the axis, sampled by cells between four of its points in proportion to
// their mean luminance, evenly within a cell.
#ifndef LUCERNA_LIB_PICTURES
#define LUCERNA_LIB_PICTURES
#include "lib/math.glsl"
#include "lib/hash.glsl"
#include "shaders/shared/scene.h"

uniform samplerBuffer light_pictures;

struct Picture {
  uint first, width, height;
  vec2 extent;        // half its sizes at distance 1
  vec3 front, right;  // of the lamp
};
// Of the lamp whose texels 1 to 3 these are.
Picture light_picture(vec4 b, vec4 c, vec4 d) {
  uvec3 head = floatBitsToUint(texelFetch(light_pictures, int(floatBitsToUint(d.w) >> k_light_profile_shift)).xyz);
  return Picture(head.x, head.y, head.z, vec2(b.w, c.w), c.xyz, d.xyz);
}

// Relative intensity along a direction, unit, and its density per solid angle.
vec3 picture_share(Picture p, vec3 direction, out float density) {
  float ahead = dot(direction, p.front);
  vec2 at = vec2(dot(direction, p.right), dot(direction, cross(p.right, p.front))) / max(ahead, 1e-6);
  vec2 uv = vec2(0.5, 0.5) + vec2(0.5, -0.5) * at / p.extent;
  bool inside = ahead > 1e-6 && all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, vec2(1.0)));
  vec2 g = clamp(uv, 0.0, 1.0) * vec2(p.width - 1u, p.height - 1u);
  uint x = min(uint(g.x), p.width - 2u), y = min(uint(g.y), p.height - 2u), i = p.first + y * p.width + x;
  vec2 f = g - vec2(x, y);
  vec4 a = texelFetch(light_pictures, int(i));
  vec3 b = texelFetch(light_pictures, int(i + 1u)).rgb;
  vec3 c = texelFetch(light_pictures, int(i + p.width)).rgb, d = texelFetch(light_pictures, int(i + p.width + 1u)).rgb;
  float away2 = 1.0 + dot(at, at);
  density = inside ? a.w * away2 * sqrt(away2) / (4.0 * p.extent.x * p.extent.y) : 0.0;
  return inside ? mix(mix(a.rgb, b, f.x), mix(c, d, f.x), f.y) : vec3(0.0);
}

// Uniform over a cell on the plane, which is chosen by 64 random bits.
vec3 sample_picture(Picture p, uvec2 bits, vec2 u) {
  uint columns = p.width - 1u, cells = columns * (p.height - 1u), i, fraction, more, lost, carry;
  umulExtended(bits.x, cells, i, fraction);
  umulExtended(bits.y, cells, more, lost);
  fraction = uaddCarry(fraction, more, carry);
  i += carry;
  vec4 cell = texelFetch(light_pictures, int(p.first + p.width * p.height + i));
  i = coin_below(fraction, cell.x) ? i : floatBitsToUint(cell.y);
  vec2 uv = (vec2(i % columns, i / columns) + u) / vec2(columns, p.height - 1u);
  vec2 at = vec2(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y) * p.extent;
  return normalize(at.x * p.right + at.y * cross(p.right, p.front) + p.front);
}

#endif
