// Keeps what the rays of overlay/centre.comp have met, as the kernels have noted it (k_probe_screen).
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
  float screen = 1.0 + float(k_origin_screen);
  float depth = max(dot(place.xyz - frame.camera_origin, frame.camera_forward), 0.0);
  uint at = (push.first + slot) * k_surface_texels;
  bool met = abs(place.w) == screen;
  surfaces[at] = met ? vec4(place.xyz, place.w > 0.0 ? depth : k_surface_bent) : vec4(0.0, 0.0, 0.0, k_surface_none);
  surfaces[at + 1u] = met ? facing : vec4(0.0);
}
