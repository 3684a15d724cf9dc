// Draws the normals of records as short lines over the picture. One invocation a record.
#include "lib/invocation.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "shaders/shared/overlay.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CacheNormalsPush push; };
uniform samplerBuffer record_texels;
#include "irradiance_cache/ink.glsl"
layout(scalar) writeonly buffer OverlaySegments { OverlaySegment segments[]; };

// [pixels]. Normals of small discs fade out, because they lie close together and would hide the structure.
const float k_longest = 13.0, k_half_width = 0.5, k_edge = 1.0;
const float k_least_disc = 4.0, k_full_disc = 12.0;

void main() {
  uint record = global_index();
  if (record >= push.records) return;
  vec4 place = texelFetch(record_texels, int(record * k_record_texels));
  vec4 facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
  vec3 foot = to_picture(place.xyz, push.width, push.height);
  float size = pixel_size(foot.z, push.height);
  bool shown = foot.z > 0.0 && place.w > k_least_disc * size && all(greaterThan(foot.xy, vec2(-k_longest))) &&
               all(lessThan(foot.xy, vec2(push.width, push.height) + k_longest));
  vec3 tip = place.xyz + min(0.6 * place.w, k_longest * size) * facing.xyz;
  shown = shown && to_picture(tip, push.width, push.height).z > 0.0;
  float strength = shown ? clamp((place.w / size - k_least_disc) / (k_full_disc - k_least_disc), 0.0, 1.0) : 0.0;
  // Lighter than the discs, to stand out from their rims.
  vec3 ink = mix(record_ink(record, push.color, push.lo, push.hi), vec3(1.0), 0.4);
  segments[record] = OverlaySegment(place.xyz, tip, k_half_width, k_edge, ink, 0.95, strength, 2.0 * size, k_rank_least);
}
