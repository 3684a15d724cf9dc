// The light of records while they are relit, for display: that of the rays so far, mixed with that of before as far as the
// new does not contradict it. With v the variance of the new, u of the old and d their difference, whose square is on
// average v + u + change^2, the mix that errs least keeps v / (v + u + change^2) of the old.
#include "lib/variants.glsl"
#include "lib/math.glsl"
#include "lib/invocation.glsl"
#include "shaders/shared/irradiance_cache/records.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { RelightPreviewPush push; };
uniform samplerBuffer record_texels, irradiance_texels, old_texels;
layout(scalar) writeonly buffer Shown { vec4 shown[]; };
#if LUCERNA_GROUP_SUMS
#include "irradiance_cache/groups.glsl"
uniform usamplerBuffer old_group_texels;
layout(scalar) writeonly buffer ShownGroups { uvec4 shown_groups[]; };

// Groups of lights have their shares in what is shown by what they have in the new light and in the old.
void mix_groups(uint record, vec3 new_light, vec3 old_light) {
  vec3 all = new_light + old_light;
  for (uint t = 0u; t < k_group_texels; ++t) {
    int at = int(record * k_group_texels + t);
    uvec4 new_shares = texelFetch(record_group_texels, at), old_shares = texelFetch(old_group_texels, at), shares;
    for (uint i = 0u; i < 4u; ++i) {
      vec3 light = new_light * share_unpack(new_shares[i]) + old_light * share_unpack(old_shares[i]);
      shares[i] = share_pack(mix(vec3(0.0), light / all, greaterThan(all, vec3(0.0))));
    }
    shown_groups[at] = shares;
  }
}
#endif

// Of its own luminance, what the old light is taken to be wrong by at least.
const float k_old_error = 0.05;
// Rays from which on slopes are those of the new light; before, the old ones in proportion.
const uint k_slope_rays = 64u;

void main() {
  uint record = global_index();
  if (record >= push.count) return;
  vec4 told = texelFetch(record_texels, int(record * k_record_texels) + 2);
  bool crowded = (floatBitsToUint(told.w) & k_record_crowded) != 0u;
  int at = int(record * k_part_count * k_part_texels);
  float y_new = 0.0, y_old = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) {
    if ((push.parts >> p & 1u) == 0u) continue;
    y_new += luminance(texelFetch(irradiance_texels, at + int(p * k_part_texels)).rgb);
    y_old += luminance(push.factor * texelFetch(old_texels, at + int(p * k_part_texels)).rgb);
  }
  // Few rays that find nothing tell of no noise.
  float v = square(told.z) + square(y_old) / float(max(push.rays, 1u)), u = square(k_old_error * y_old);
  float change = max(square(y_new - y_old) - v - u, 0.0);
  float keep = push.rays == 0u ? 1.0 : v > 0.0 ? v / (v + u + change) : 0.0;
#if LUCERNA_GROUP_SUMS
  vec3 new_light = vec3(0.0), old_light = vec3(0.0);
  for (uint p = k_part_direct + 1u; p < k_part_count; ++p) {
    bool anew = (push.parts >> p & 1u) != 0u && keep < 1.0;
    vec3 was = texelFetch(old_texels, at + int(p * k_part_texels)).rgb;
    new_light += anew ? (1.0 - keep) * texelFetch(irradiance_texels, at + int(p * k_part_texels)).rgb : vec3(0.0);
    old_light += anew ? keep * push.factor * was : was;
  }
  if (!crowded) mix_groups(record, new_light, old_light);
#endif
  for (uint p = 0u; p < k_part_count; ++p) {
    int to = at + int(p * k_part_texels);
    vec4 o[4], n[4];
    for (int k = 0; k < 4; ++k) o[k] = texelFetch(old_texels, to + k), n[k] = texelFetch(irradiance_texels, to + k);
    bool gathered = (push.parts >> p & 1u) != 0u && !crowded;
    vec3 e = keep >= 1.0 ? push.factor * o[0].rgb : mix(n[0].rgb, push.factor * o[0].rgb, keep);
    float ratio = clamp(luminance(e) / max(luminance(o[0].rgb), 1e-20), 0.0, 4.0);
    bool slopes = push.rays >= k_slope_rays;
    for (int k = 0; k < 4; ++k) {
      vec4 mixed = slopes ? mix(n[k], ratio * o[k], keep) : ratio * o[k];
      if (k == 0) mixed.rgb = e;
      shown[to + k] = gathered ? mixed : o[k];
    }
  }
}
