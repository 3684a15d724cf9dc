// Draws photons as points over the picture, one invocation each. Photons have nearly equal flux, so only its colour is
// shown.
#include "lib/invocation.glsl"
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/overlay.h"
#include "shaders/shared/ramp.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonPointsPush push; };
uniform samplerBuffer photon_texels;
layout(scalar) writeonly buffer OverlayPoints { OverlayPoint points[]; };

const uint k_last_hue = 5u;

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint photon = index * push.step;
  vec4 a = texelFetch(photon_texels, int(k_photon_texels * photon)), b = texelFetch(photon_texels, int(k_photon_texels * photon + 1u));
  uint events = floatBitsToUint(b.w) >> k_photon_events_shift & k_photon_most_events;
  vec3 light = sqrt(b.rgb / max(max(b.r, max(b.g, b.b)), 1e-37));  // sRGB-encoded
  OverlayPoint p;
  p.position = a.xyz;
  p.half_width = 0.6;
  p.color = light;
  if (push.by == k_photons_by_bounce) p.color = ramp_hue(min(events, k_last_hue));
  if (push.by == k_photons_by_map) p.color = ramp_hue(floatBitsToUint(b.w) >> k_photon_part_shift & 3u);
  if (push.by == k_photons_by_light) p.color = ramp_hue(floatBitsToUint(b.w) >> k_photon_group_shift);
  if (push.by == k_photons_by_round) p.color = ramp_hue(push.round);
  p.alpha = 0.9;
  p.edge_width = 0.0;
  p.rank = k_rank_least;
  points[index] = p;
}
