// Keeps of what the rays of overlay/centre.comp have met first what the preview knows of a pixel's surface.
#include "shaders/shared/sight.h"
#include "lib/invocation.glsl"
#include "lib/radiance.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SeePush push; };
uniform samplerBuffer feature_texels;
// That together are all light of a path.
const uint k_light_lanes = LUCERNA_GROUP_SUMS != 0 ? k_component_count : k_no_lane;
layout(scalar) writeonly buffer Surfaces { vec4 surfaces[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  vec4 colour = texelFetch(feature_texels, int(2u * slot)), facing = texelFetch(feature_texels, int(2u * slot + 1u));
  bool met = colour.w > 0.0;
  // The rays end there: what they bring is what the surface itself sends.
  vec3 sent = vec3(0.0);
  for (uint lane = 0u; lane < k_light_lanes; ++lane) sent += texelFetch(radiance_texels, int(radiance_texel(slot, lane))).rgb;
  surfaces[push.first + slot] = preview_texel(PreviewSurface(met ? facing.w : 0.0, met ? normalize(facing.xyz) : vec3(0.0),
                                                             colour.rgb, 0.0, met && max3(sent) > 0.0, 1.0));
}
