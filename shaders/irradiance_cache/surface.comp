// Stores the hits of the rays of overlay/centre.comp, as the kernels noted them (k_probe_screen).
#include "shaders/shared/sight.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/frame.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SeePush push; };
uniform samplerBuffer candidate_texels;
layout(scalar) writeonly buffer Surfaces { vec4 surfaces[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  vec4 place = texelFetch(candidate_texels, int(slot * k_candidate_texels));
  vec4 facing = texelFetch(candidate_texels, int(slot * k_candidate_texels + 1u));
  float depth = max(camera_depth(place.xyz - frame.camera_origin), 0.0);
  uint at = (push.first + slot) * k_surface_texels;
  uint origin_code = uint(abs(place.w)), media = (max(origin_code, 1u) - 1u) / k_candidate_media;
  bool met = origin_code > 0u && (origin_code - 1u) % k_candidate_media == k_origin_screen, fits = place.w > 0.0 && media < k_surface_media;
  surfaces[at] = met ? vec4(place.xyz, fits ? depth : k_surface_bent) : vec4(0.0, 0.0, 0.0, k_surface_none);
  uint bits = floatBitsToUint(facing.w) | (fits ? media << k_surface_media_shift : 0u);
  surfaces[at + 1u] = met ? vec4(facing.xyz, uintBitsToFloat(bits)) : vec4(0.0);
}
