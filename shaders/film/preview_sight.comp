// Stores the surfaces found by film/preview_look.comp as the preview's surfaces of pixels.
#include "shaders/shared/sight.h"
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SeePush push; };
uniform samplerBuffer feature_texels;
layout(scalar) writeonly buffer Surfaces { vec4 surfaces[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  vec4 colour = texelFetch(feature_texels, int(2u * slot)), facing = texelFetch(feature_texels, int(2u * slot + 1u));
  uint found = uint(colour.w);
  bool met = (found & k_sight_met) != 0u;
  float seen = preview_seen((found & k_sight_beyond) != 0u, fract(colour.w) / k_sight_mirrors);
  surfaces[push.first + slot] = preview_texel(
      PreviewSurface(met ? facing.w : 0.0, met ? normalize(facing.xyz) : vec3(0.0), colour.rgb, seen, (found & k_sight_emits) != 0u, 1.0));
}
