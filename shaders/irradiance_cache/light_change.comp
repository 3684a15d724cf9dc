// Sums of the light that records have now and had before: of each cluster, then of all clusters (light_change.glsl). One
// workgroup a cluster; one for all of them.
#include "lib/variants.glsl"
#include "shaders/shared/irradiance_cache/records.h"
#define LUCERNA_SUM_ROWS int(k_light_sums_texels)
#include "lib/sum_rows.glsl"
#include "irradiance_cache/light_change.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightChangePush push; };
uniform samplerBuffer record_texels, irradiance_texels, old_texels;
uniform usamplerBuffer clustered;  // records, cluster after cluster
layout(scalar) buffer Sums { vec4 sums[]; };
// Sums other values, after all have read the sums of the last ones.
void add_up(uint lane, vec4 a, vec4 b, vec4 c, vec4 d) {
  barrier();
  lanes[0][lane] = a, lanes[1][lane] = b, lanes[2][lane] = c, lanes[3][lane] = d, lanes[4][lane] = vec4(0.0);
  add_up(lane);
}

// Over what there is on average, of those that count.
float weight_of(float light, float sum, float count) {
  float dark = k_dark_place * sum / max(count, 1.0);
  return dark > 0.0 ? 1.0 / max(light, dark) : 0.0;
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  if (push.clusters > 0u) {
    for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] = vec4(0.0);
    for (uint c = lane; c < push.clusters; c += 64u)
      for (uint k = 0u; k < k_light_sums_texels; ++k) lanes[k][lane] += sums[k_light_sums_texels * c + k];
    add_up(lane);
    if (lane < k_light_sums_texels) sums[k_light_sums_texels * push.clusters + lane] = lanes[lane][0];
    return;
  }
  uint cluster = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, entry = 64u * cluster + lane;
  // Tertiary light apart: it is read from records, which know of the change only when this is told.
  vec3 now[2] = vec3[2](vec3(0.0), vec3(0.0)), before[2] = now;
  float variance = 0.0, noise = 0.0;
  bool counts = entry < push.count && (push.leading == 0u || lane % k_light_leading == 0u);
  if (counts) {
    uint record = texelFetch(clustered, int(entry / 4u))[entry % 4u];
    int at = int(record * k_record_texels), light = int(record * k_part_count * k_part_texels);
    for (uint p = 0u; p < k_part_count; ++p) {
      if ((push.parts >> p & 1u) == 0u) continue;
      uint which = p == k_part_tertiary ? 1u : 0u;
      now[which] += texelFetch(irradiance_texels, light + int(p * k_part_texels)).rgb;
      before[which] += push.factor * texelFetch(old_texels, light + int(p * k_part_texels)).rgb;
    }
    variance = square(texelFetch(record_texels, at + 2).z);
    noise = ray_noise(record) / float(max(push.rays, 1u));
  }
  vec2 was = vec2(luminance(before[0]), luminance(before[1])), is = vec2(luminance(now[0]), luminance(now[1]));
  add_up(lane, vec4(was, counts ? 1.0 : 0.0, 0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  vec3 all = lanes[0][0].xyz;
  vec2 weight = vec2(weight_of(was.x, all.x, all.z), weight_of(was.y, all.y, all.z));
  add_up(lane, vec4(weight.x * now[0], 0.0), vec4(weight.x * before[0], 0.0), vec4(weight.y * now[1], 0.0),
         vec4(weight.y * before[1], 0.0));
  vec3 sum[4] = vec3[4](lanes[0][0].rgb, lanes[1][0].rgb, lanes[2][0].rgb, lanes[3][0].rgb);
  vec2 ratio = vec2(luminance(sum[0]) / max(luminance(sum[1]), 1e-20), luminance(sum[2]) / max(luminance(sum[3]), 1e-20));
  vec2 off = weight * (is - ratio * was);
  // The noise that rays tell is of all parts together; few that find nothing tell of none.
  vec2 told = weight * weight * (variance + square(ratio.x * was.x + ratio.y * was.y) / float(max(push.rays, 1u)));
  vec2 expected = weight * weight * max(vec2(variance), noise * was * was);
  add_up(lane, vec4(off * off, expected), vec4(told, 0.0, 0.0), vec4(0.0), vec4(0.0));
  vec4 squares = lanes[0][0], noises = lanes[1][0];
  if (lane == 0u && 64u * cluster < push.count) {
    uint at = k_light_sums_texels * cluster;
    sums[at] = vec4(sum[0], squares.x), sums[at + 1u] = vec4(sum[1], squares.z);
    sums[at + 2u] = vec4(sum[2], squares.y), sums[at + 3u] = vec4(sum[3], squares.w);
    sums[at + 4u] = noises;
  }
}
