// The light of records while they are relit, for display: that of the rays so far, mixed with that of before as far as the
// new does not contradict it. With v the variance of the new, u of the old and d their difference, whose square is on
// average v + u + change^2, the mix that errs least keeps v / (v + u + change^2) of the old. The old is scaled first, by
// what records around have of the new light and of the old: few rays of many say what few rays of one do not.
#include "lib/variants.glsl"
#include "irradiance_cache/light_change.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { RelightPreviewPush push; };
uniform samplerBuffer record_texels, irradiance_texels, old_texels, light_sums_texels;
uniform usamplerBuffer place_of_record;
layout(scalar) writeonly buffer Shown { vec4 shown[]; };
#if LUCERNA_GROUP_SUMS
#include "irradiance_cache/groups.glsl"
uniform usamplerBuffer old_group_texels;
layout(scalar) writeonly buffer ShownGroups { uvec4 shown_groups[]; };
layout(scalar) readonly buffer GroupFactors { vec4 group_factors[]; };  // of the light before

vec3 group_factor(uint group) { return group < k_group_count ? group_factors[group].rgb : vec3(1.0); }

// Of a record's light as it was: what all of it is multiplied by as its groups are.
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

// Groups of lights have their shares in what is shown by what they have in the new light and in the old.
// `factor`: that the old light has in it, by groups.
void mix_groups(uint record, vec3 new_light, vec3 old_light, vec3 factor) {
  vec3 all = new_light + old_light;
  for (uint t = 0u; t < k_group_texels; ++t) {
    int at = int(record * k_group_texels + t);
    uvec4 new_shares = texelFetch(record_group_texels, at), old_shares = texelFetch(old_group_texels, at), shares;
    for (uint i = 0u; i < 4u; ++i) {
      vec3 own = group_factor(4u * t + i) * share_unpack(old_shares[i]);
      vec3 light = new_light * share_unpack(new_shares[i]) + old_light * mix(vec3(0.0), own / factor, greaterThan(factor, vec3(0.0)));
      shares[i] = share_pack(mix(vec3(0.0), light / all, greaterThan(all, vec3(0.0))));
    }
    shown_groups[at] = shares;
  }
}
#endif

// Of its own luminance, what the old light is taken to be wrong by at least.
const float k_old_error = 0.05;
// Squares of a difference, over its variance, up to which it is taken for chance.
const float k_by_chance = 2.0;
// Rays from which on slopes are those of the new light; before, the old ones in proportion.
const uint k_slope_rays = 64u;

// How much the light around has changed, and of what is scaled by that the relative squares of what it is off and of how
// unsure that is.
vec3 ratio_around(uint cluster, bool tertiary, vec3 known, float records, out float off, out float unsure) {
  LightSums all = light_sums(light_sums_texels, push.clusters, tertiary), here = light_sums(light_sums_texels, cluster, tertiary);
  vec3 ratio = mix(known, light_ratio(all), light_belief(all, known));
  ratio = mix(ratio, light_ratio(here), light_belief(here, ratio));
  float scale = luminance(ratio * here.before);
  off = scale > 0.0 ? records * max(here.spread - here.noise, 0.0) / square(scale) : 0.0;
  unsure = scale > 0.0 ? here.spread / square(scale) : 0.0;
  return ratio;
}

vec3 part_factor(uint part, vec3 plain, vec3 tertiary, vec3 direct) {
  return part == k_part_tertiary ? tertiary : part == k_part_direct ? direct : plain;
}

void main() {
  uint record = global_index();
  if (record >= push.count) return;
  vec4 told = texelFetch(record_texels, int(record * k_record_texels) + 2);
  bool crowded = (floatBitsToUint(told.w) & k_record_crowded) != 0u;
  int at = int(record * k_part_count * k_part_texels);
  vec3 factor = push.factor, factor_tertiary, factor_direct = push.factor;
#if LUCERNA_GROUP_SUMS
  vec3 of_groups = factor_of_groups(record);
  factor = of_groups, factor_direct = group_factor(push.sky_group);
#endif
  factor_tertiary = factor;
  // Of the scaled old light, by what it is off in this cluster and how well the scale is known, relative squares.
  float off = 0.0, unsure = 0.0;
  bool has_rays = push.rays > 0u;
  if (has_rays) {
    uint place = texelFetch(place_of_record, int(record / 4u))[record % 4u], cluster = place / k_light_cluster;
    float n = float(push.leading != 0u ? k_light_cluster / k_light_leading : k_light_cluster);
    vec3 ratio = ratio_around(cluster, false, vec3(1.0), n, off, unsure), tertiary = ratio;
    // What the first rays have read was the old light: at first it changes as the light does from which it comes.
    float tertiary_off = off, tertiary_unsure = unsure;
    if (push.leading == 0u) tertiary = ratio_around(cluster, true, ratio, n, tertiary_off, tertiary_unsure);
    factor *= ratio, factor_direct *= ratio, factor_tertiary *= tertiary;
    off = max(off, tertiary_off), unsure = max(unsure, tertiary_unsure);
    has_rays = push.leading == 0u || place % k_light_leading == 0u;
  }
  float y_new = 0.0, y_old = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) {
    if ((push.parts >> p & 1u) == 0u) continue;
    y_new += luminance(texelFetch(irradiance_texels, at + int(p * k_part_texels)).rgb);
    y_old += luminance(part_factor(p, factor, factor_tertiary, factor_direct) * texelFetch(old_texels, at + int(p * k_part_texels)).rgb);
  }
  // Few rays that find nothing tell of no noise: they have at least what those before had.
  float v = max(square(told.z), square(y_old) * ray_noise(record) / float(max(push.rays, 1u))), u = (square(k_old_error) + unsure) * square(y_old);
  float change = max(square(y_new - y_old) - k_by_chance * (u + v), off * square(y_old));
  float keep = !has_rays ? 1.0 : v > 0.0 ? v / (v + u + change) : 0.0;
#if LUCERNA_GROUP_SUMS
  vec3 new_light = vec3(0.0), old_light = vec3(0.0);
  for (uint p = k_part_direct + 1u; p < k_part_count; ++p) {
    bool anew = (push.parts >> p & 1u) != 0u && keep < 1.0;
    vec3 was = texelFetch(old_texels, at + int(p * k_part_texels)).rgb;
    new_light += anew ? (1.0 - keep) * texelFetch(irradiance_texels, at + int(p * k_part_texels)).rgb : vec3(0.0);
    old_light += anew ? keep * part_factor(p, factor, factor_tertiary, factor_direct) * was : was;
  }
  if (!crowded) mix_groups(record, new_light, old_light, of_groups);
#endif
  for (uint p = 0u; p < k_part_count; ++p) {
    int to = at + int(p * k_part_texels);
    vec4 o[4], n[4];
    for (int k = 0; k < 4; ++k) o[k] = texelFetch(old_texels, to + k), n[k] = texelFetch(irradiance_texels, to + k);
    bool gathered = (push.parts >> p & 1u) != 0u && !crowded;
    vec3 old_light = part_factor(p, factor, factor_tertiary, factor_direct) * o[0].rgb;
    vec3 e = keep >= 1.0 ? old_light : mix(n[0].rgb, old_light, keep);
    float ratio = clamp(luminance(e) / max(luminance(o[0].rgb), 1e-20), 0.0, 4.0);
    bool slopes = push.rays >= k_slope_rays;
    for (int k = 0; k < 4; ++k) {
      vec4 mixed = slopes ? mix(n[k], ratio * o[k], keep) : ratio * o[k];
      if (k == 0) mixed.rgb = e;
      shown[to + k] = gathered ? mixed : o[k];
    }
  }
}
