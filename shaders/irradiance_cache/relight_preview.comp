// Preview of record light during relighting: the light before the edit, times the known factor of the edit for each light
// group or for all light.
#include "lib/variants.glsl"
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { RelightPreviewPush push; };
uniform samplerBuffer old_texels;
layout(scalar) writeonly buffer Shown { vec4 shown[]; };
#if LUCERNA_GROUP_SUMS
#include "irradiance_cache/groups.glsl"
uniform usamplerBuffer old_group_texels;
layout(scalar) writeonly buffer ShownGroups { uvec4 shown_groups[]; };
layout(scalar) readonly buffer GroupFactors { vec4 group_factors[]; };  // relative to the light before the edit

vec3 group_factor(uint group) { return group < k_group_count ? group_factors[group].rgb : vec3(1.0); }

// Factor of a record's total light, from its group shares.
vec3 factor_of_groups(uint record) {
  vec3 sum = vec3(0.0), all = vec3(0.0);
  for (uint t = 0u; t < k_group_texels; ++t) {
    uvec4 shares = texelFetch(old_group_texels, int(record * k_group_texels + t));
    for (uint i = 0u; i < 4u; ++i) {
      vec3 share = share_unpack(shares[i]);
      sum += share * group_factor(4u * t + i), all += share;
    }
  }
  return mix(vec3(1.0), sum / all, greaterThan(all, vec3(0.0)));
}

// Group shares after the total has been multiplied by `factor`.
void scale_shares(uint record, vec3 factor) {
  for (uint t = 0u; t < k_group_texels; ++t) {
    int at = int(record * k_group_texels + t);
    uvec4 old_shares = texelFetch(old_group_texels, at), shares;
    for (uint i = 0u; i < 4u; ++i)
      shares[i] = share_pack(mix(vec3(0.0), group_factor(4u * t + i) * share_unpack(old_shares[i]) / factor, greaterThan(factor, vec3(0.0))));
    shown_groups[at] = shares;
  }
}
#endif

void main() {
  uint record = global_index();
  if (record >= push.count) return;
  vec3 factor = push.factor, factor_direct = push.factor;
#if LUCERNA_GROUP_SUMS
  factor = factor_of_groups(record), factor_direct = group_factor(push.sky_group);
  scale_shares(record, factor);
#endif
  for (uint p = 0u; p < k_part_count; ++p) {
    int at = int((record * k_part_count + p) * k_part_texels);
    vec4 light = texelFetch(old_texels, at);
    vec3 scaled = (p == k_part_direct ? factor_direct : factor) * light.rgb;
    // Gradients scale with the luminance.
    float ratio = luminance(scaled) / max(luminance(light.rgb), 1e-20);
    shown[at] = vec4(scaled, ratio * light.a);
    for (int k = 1; k + 1 < int(k_part_texels); ++k) shown[at + k] = ratio * texelFetch(old_texels, at + k);
    vec4 last = texelFetch(old_texels, at + int(k_part_texels) - 1);
    shown[at + int(k_part_texels) - 1] = vec4(ratio * last.xyz, last.w);
  }
}
