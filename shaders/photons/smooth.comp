// Smooths the density view along one axis of the picture: mean over nearby pixels that show the same surface, because
// photons of a single round lie far apart. The pass over the second axis also writes the maximum, as the bits of a float.
#include "lib/invocation.glsl"
#include "shaders/shared/photons/inspect.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonSmoothPush push; };
uniform samplerBuffer surface_texels;  // for every pixel, as overlay/lookup_place.glsl reads them
layout(scalar) readonly buffer PhotonDensities { float densities[]; };
layout(scalar) writeonly buffer PhotonSmoothed { float smoothed[]; };
layout(scalar) buffer PhotonDensityMost { uint density_most; };

const float k_same_normal = 0.9, k_same_plane = 0.6;  // cosine; distance from the plane over distance in the picture

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  float value = densities[pixel];
  if (value >= 0.0) {
    ivec2 xy = ivec2(pixel % push.width, pixel / push.width), size = ivec2(push.width, push.height);
    ivec2 along = push.down != 0u ? ivec2(0, 1) : ivec2(1, 0);
    vec3 place = texelFetch(surface_texels, int(k_surface_texels * pixel)).xyz;
    vec3 normal = texelFetch(surface_texels, int(k_surface_texels * pixel + 1u)).xyz;
    float sum = value, weight = 1.0;
    for (int i = -int(push.taps); i <= int(push.taps); ++i) {
      ivec2 at = xy + i * along;
      if (i == 0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
      uint other = uint(at.y) * push.width + uint(at.x);
      float there = densities[other];
      if (there < 0.0) continue;
      vec3 away = texelFetch(surface_texels, int(k_surface_texels * other)).xyz - place;
      vec3 facing = texelFetch(surface_texels, int(k_surface_texels * other + 1u)).xyz;
      if (dot(facing, normal) < k_same_normal || abs(dot(away, normal)) > k_same_plane * length(away)) continue;
      float x = float(i) / (float(push.taps) + 1.0), w = (1.0 - x * x) * (1.0 - x * x);
      sum += w * there, weight += w;
    }
    value = sum / weight;
  }
  smoothed[pixel] = value;
  if (push.down != 0u && value > 0.0) atomicMax(density_most, floatBitsToUint(value));
}
