// The media around a path: a stack of entered media, as one number with base 1 + the number of media; the lowest digit is
// the last one entered, which absorbs. A full stack drops the outermost medium. Leaving a medium removes its topmost entry,
// wherever it is, so overlapping volumes may be left in any order.
#ifndef LUCERNA_LIB_MEDIA
#define LUCERNA_LIB_MEDIA
#include "lib/variants.glsl"
#include "shaders/shared/scene.h"
#include "lib/math.glsl"
#include "lib/hash.glsl"
#include "lib/triangle_test.glsl"

#if LUCERNA_VOLUMES
uniform samplerBuffer scene_media;

const uint k_media_base = uint(LUCERNA_MEDIA) + 1u;

uint media_enter(uint stack, uint medium) {
  while (stack > 0u && stack >= k_media_stacks / k_media_base) {
    uint above = 1u;
    while (stack / above >= k_media_base) above *= k_media_base;
    stack %= above;
  }
  return stack * k_media_base + medium;
}

uint media_leave(uint stack, uint medium) {
  uint below = stack, above = 0u, place = 1u;
  while (below > 0u) {
    uint digit = below % k_media_base;
    below /= k_media_base;
    if (digit == medium) return below * place + above;
    above += digit * place;
    place *= k_media_base;
  }
  return stack;
}

vec3 media_transmittance(uint stack, float distance) {
  return stack == 0u ? vec3(1.0) : exp(-texelFetch(scene_media, int(stack % k_media_base)).rgb * distance);
}

// The media around a place: those that a ray from outside has entered on its way there. A shell encloses the place if a ray
// from it leaves the shell more often than it enters; near shells lie within far ones. `lot`: selects the ray's direction,
// so that no place is bad for all paths that start there.
uint media_at(vec3 place, uint lot) {
  const uint k_most = 6u;  // shells around a place: the nearest
  uvec4 header = floatBitsToUint(texelFetch(scene_media, 0));
  float z = float(hash_mix(lot) >> 8) * (2.0 / 16777216.0) - 1.0, phi = float(hash_mix(lot ^ 0x68bc21ebu) >> 8) * (6.2831853 / 16777216.0);
  float r = sqrt(max(0.0, 1.0 - z * z));
  Ray ray = Ray(place, 0.0, vec3(r * cos(phi), r * sin(phi), z), 0u);
  ShearedRay sheared = bvh_shear(ray);
  vec3 inverse = bvh_inverse(ray.direction);
  float far[k_most];
  uint entered[k_most];  // 2 * medium, + 1 if it has been left there: a hollow
  [[unroll]] for (uint k = 0u; k < k_most; ++k) far[k] = k_infinity, entered[k] = 0u;
  int around = 0;  // number of exits from the current shell minus entries
  float nearest = k_infinity;
  uint medium = 0u;
  for (uint node = 0u; node <= header.y && header.y > 0u;) {
    bool last = node == header.y;
    int at = int(header.x + 2u * min(node, header.y - 1u));
    vec4 a = texelFetch(scene_media, at), b = texelFetch(scene_media, at + 1);
    uint next = floatBitsToUint(a.w), word = floatBitsToUint(b.w);
    if (last || (next & k_media_around) != 0u) {
      // The former shell is complete.
      float t = around != 0 ? nearest : k_infinity;
      uint what = 2u * medium + (around < 0 ? 1u : 0u);
      [[unroll]] for (uint k = 0u; k < k_most; ++k) {
        bool nearer = t < far[k];
        float farther = nearer ? far[k] : t;
        uint other = nearer ? entered[k] : what;
        far[k] = nearer ? t : far[k];
        entered[k] = nearer ? what : entered[k];
        t = farther, what = other;
      }
      around = 0, nearest = k_infinity;
    }
    vec3 lo = (a.xyz - place) * inverse, hi = (b.xyz - place) * inverse;
    vec3 in_at = min(lo, hi), out_at = max(lo, hi);
    in_at -= k_bvh_slack * abs(in_at), out_at += k_bvh_slack * abs(out_at);
    bool meets = max(max(in_at.x, in_at.y), max(in_at.z, 0.0)) <= min(out_at.x, min(out_at.y, out_at.z));
    bool within = all(lessThanEqual(a.xyz, place)) && all(lessThanEqual(place, b.xyz));
    bool on = !last && ((next & k_media_around) != 0u ? within : meets);
    uint first = header.z + 3u * (word >> 3), count = on ? word & 7u : 0u;
    for (uint i = 0u; i < count; ++i) {
      vec4 p = texelFetch(scene_media, int(first + 3u * i));
      vec3 q = texelFetch(scene_media, int(first + 3u * i + 1u)).xyz, s = texelFetch(scene_media, int(first + 3u * i + 2u)).xyz;
      float t, u, v;
      bool hit = bvh_test(sheared, p.xyz, q, s, t, u, v) && t > 0.0;
      around += hit ? dot(cross(q - p.xyz, s - p.xyz), ray.direction) > 0.0 ? 1 : -1 : 0;
      nearest = hit ? min(nearest, t) : nearest;
      medium = hit ? uint(p.w) : medium;
    }
    node = last ? node + 1u : on ? node + 1u : next & ~k_media_around;
  }
  uint stack = 0u;
  [[unroll]] for (uint k = k_most; k > 0u; --k) {
    uint what = entered[k - 1u];
    if (what != 0u) stack = (what & 1u) != 0u ? media_leave(stack, what >> 1) : media_enter(stack, what >> 1);
  }
  return stack;
}
#endif
#endif
