// How much light has changed since what was shown before, told by few samples of many pixels: by component, pooled over
// blocks of the grid's cells and over the whole picture. One workgroup a block, then one for all.
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewChangePush push; };
uniform samplerBuffer grid_texels, grid_surfaces, before_texels;
layout(scalar) buffer Sums { vec4 sums[]; };              // 4 a block: light now, before, square of what is off, by component; samples
layout(scalar) writeonly buffer Ratios { vec4 ratios[]; };  // of a block: now over before
shared vec4 lanes[4][64];

void add_up(uint lane) {
  for (uint half_way = 32u; half_way > 0u; half_way >>= 1) {
    barrier();
    if (lane < half_way)
      for (int k = 0; k < 4; ++k) lanes[k][lane] += lanes[k][lane + half_way];
  }
  barrier();
}

// No cell weighs more than one of a tenth of its block's mean.
const float k_dark = 0.1;
const float k_most_ratio = 16.0;
const float k_unusual = 2.0;  // noise of a block over that of the picture, up to which it is expected
const uint k_cells = k_preview_change_step * k_preview_change_step / 64u;  // of a lane

// What sums say of the ratio where `known` is known without them: nothing within two standard errors of it, by what has been
// found or by the square that was to be expected.
vec4 ratio_of(vec4 now, vec4 before, vec4 spread, vec4 expected, vec4 known) {
  vec4 off = now - known * before, told = min(now / max(before, vec4(1e-20)), vec4(k_most_ratio));
  vec4 belief = clamp(1.0 - 4.0 * spread / max(off * off, vec4(1e-20)), 0.0, 1.0);
  belief *= smoothstep(4.0 * expected, 9.0 * expected + 1e-20, off * off);
  return mix(known, mix(known, told, belief), greaterThan(before, vec4(0.0)));
}

void main() {
  uint lane = gl_LocalInvocationID.x, blocks = push.blocks_across * push.blocks_down;
  if (push.all != 0u) {
    for (int k = 0; k < 4; ++k) lanes[k][lane] = vec4(0.0);
    for (uint b = lane; b < blocks; b += 64u)
      for (uint k = 0u; k < 4u; ++k) lanes[k][lane] += sums[4u * b + k];
    add_up(lane);
    vec4 all = ratio_of(lanes[0][0], lanes[1][0], lanes[2][0], vec4(0.0), vec4(1.0));
    // Of a sample over the square of its light. A block whose few samples have found nothing seems to be without noise.
    vec4 usual = lanes[2][0] * lanes[3][0].x / max(lanes[1][0] * lanes[1][0], vec4(1e-20));
    for (uint b = lane; b < blocks; b += 64u) {
      vec4 before = sums[4u * b + 1u], expected = k_unusual * usual * before * before / max(sums[4u * b + 3u].x, 1e-3);
      ratios[b] = ratio_of(sums[4u * b], before, sums[4u * b + 2u], expected, all);
    }
    return;
  }
  uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uvec2 first = k_preview_change_step * uvec2(block % push.blocks_across, block / push.blocks_across);
  vec4 now[k_cells], before[k_cells];
  float samples[k_cells];
  for (int k = 0; k < 4; ++k) lanes[k][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    uint at = 64u * i + lane;
    uvec2 xy = first + uvec2(at % k_preview_change_step, at / k_preview_change_step);
    samples[i] = 0.0, now[i] = before[i] = vec4(0.0);
    if (xy.x >= push.across || xy.y >= push.down || block >= blocks) continue;
    int cell = int(xy.y * push.across + xy.x);
    PreviewSurface s = preview_surface(texelFetch(grid_surfaces, cell));
    if (s.samples <= 0.0) continue;
    samples[i] = s.samples;
    now[i] = preview_luminances(preview_light(grid_texels, cell));
    before[i] = max(texelFetch(before_texels, cell), vec4(0.0));
    lanes[0][lane] += before[i], lanes[1][lane].x += 1.0;
  }
  add_up(lane);
  vec4 dark = k_dark * lanes[0][0] / max(lanes[1][0].x, 1.0);
  barrier();
  for (int k = 0; k < 4; ++k) lanes[k][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    lanes[3][lane].x += samples[i];
    vec4 weight = samples[i] / max(max(before[i], dark), vec4(1e-6));
    lanes[0][lane] += weight * now[i], lanes[1][lane] += weight * before[i];
  }
  add_up(lane);
  vec4 sum_now = lanes[0][0], sum_before = lanes[1][0], count = lanes[3][0], ratio = sum_now / max(sum_before, vec4(1e-20));
  barrier();
  lanes[0][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    vec4 off = samples[i] / max(max(before[i], dark), vec4(1e-6)) * (now[i] - ratio * before[i]);
    // Cells that share a sample of a draft err alike.
    lanes[0][lane] += samples[i] > 0.0 ? off * off / min(samples[i], 1.0) : vec4(0.0);
  }
  add_up(lane);
  if (lane == 0u && block < blocks)
    sums[4u * block] = sum_now, sums[4u * block + 1u] = sum_before, sums[4u * block + 2u] = lanes[0][0], sums[4u * block + 3u] = count;
}
