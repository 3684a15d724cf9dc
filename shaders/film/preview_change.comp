// Estimates how much the light has changed since the last display, from few samples of many pixels: by component, pooled
// over blocks of grid cells and over the whole picture. One workgroup a block, then one for all.
#include "film/preview.glsl"
#define LUCERNA_SUM_ROWS int(k_preview_change_texels)
#include "lib/sum_rows.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewChangePush push; };
uniform samplerBuffer grid_texels, grid_surfaces, before_texels;
// Per block: light now, light before, squared residual, by component; samples; squared noise.
layout(scalar) buffer Sums { vec4 sums[]; };
// Per block: light now over light before; then, for the picture, the variance of a sample over the square of its light.
layout(scalar) writeonly buffer Ratios { vec4 ratios[]; };

const float k_unusual = 2.0;  // expected maximum of a block's noise over that of the picture
const float k_least_noise = 1.0, k_most_noise = 1e4;  // squared noise of a sample over the square of its light
const uint k_cells = k_preview_change_step * k_preview_change_step / 64u;  // per lane

// Weight of measured sums, 0..1, given the squared deviation `off` of the prior estimate from them: 0 within two standard
// errors, by the measured square `spread` or the `expected` one; 1 far outside.
vec4 belief(vec4 off, vec4 spread, vec4 expected) {
  vec4 found = clamp(1.0 - 4.0 * spread / max(off, vec4(1e-20)), 0.0, 1.0);
  return found * smoothstep(4.0 * expected, 9.0 * expected + 1e-20, off);
}

// Estimate of the ratio from sums and the prior estimate `known`. Light that has grown by more than k_preview_most_growth,
// such as from none, is not that from before, however scaled: k_preview_other_light.
vec4 ratio_of(vec4 now, vec4 before, vec4 spread, vec4 expected, vec4 known) {
  vec4 scaled = min(known, vec4(k_preview_most_growth));
  vec4 off = now - scaled * before, measured = min(now / max(before, vec4(1e-20)), vec4(k_preview_most_growth));
  vec4 ratio = mix(scaled, mix(scaled, measured, belief(off * off, spread, expected)), greaterThan(before, vec4(0.0)));
  vec4 grown = max(now - k_preview_most_growth * before, vec4(0.0));
  // A block without evidence of its own follows the picture.
  vec4 less = max(k_preview_most_growth * before - now, vec4(0.0));
  uvec4 other = uvec4(greaterThan(belief(grown * grown, spread, expected), vec4(0.5)));
  uvec4 follows = uvec4(greaterThan(known, vec4(k_preview_most_growth))) &
                  uvec4(lessThan(belief(less * less, spread, square(k_preview_most_growth) * expected), vec4(0.5)));
  return mix(ratio, vec4(k_preview_other_light), bvec4(other | follows));
}

void main() {
  uint lane = gl_LocalInvocationID.x, blocks = push.blocks_across * push.blocks_down;
  if (push.all != 0u) {
    for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] = vec4(0.0);
    for (uint b = lane; b < blocks; b += 64u)
      for (uint k = 0u; k < k_preview_change_texels; ++k) lanes[k][lane] += sums[k_preview_change_texels * b + k];
    add_up(lane);
    vec4 all = ratio_of(lanes[0][0], lanes[1][0], lanes[2][0], vec4(0.0), vec4(1.0));
    // Noise of a sample over the square of its light. A block whose few samples found no light would seem noise-free.
    vec4 usual = lanes[2][0] * lanes[3][0].x / max(lanes[1][0] * lanes[1][0], vec4(1e-20));
    // Mean of its logarithm over blocks, so that a few bright paths do not dominate.
    barrier();
    lanes[0][lane] = lanes[1][lane] = vec4(0.0);
    for (uint b = lane; b < blocks; b += 64u) {
      vec4 light = sums[k_preview_change_texels * b + 1u], square_noise = sums[k_preview_change_texels * b + 4u];
      vec4 noise = square_noise * sums[k_preview_change_texels * b + 3u].x / max(light * light, vec4(1e-20));
      vec4 counts = vec4(greaterThan(light * noise, vec4(0.0)));
      lanes[0][lane] += counts * log2(clamp(noise, vec4(k_least_noise), vec4(k_most_noise))), lanes[1][lane] += counts;
    }
    add_up(lane);
    vec4 noise = exp2(lanes[0][0] / max(lanes[1][0], vec4(1.0)));
    for (uint b = lane; b < blocks; b += 64u) {
      vec4 before = sums[k_preview_change_texels * b + 1u], expected = k_unusual * usual * before * before / max(sums[k_preview_change_texels * b + 3u].x, 1e-3);
      ratios[b] = ratio_of(sums[k_preview_change_texels * b], before, sums[k_preview_change_texels * b + 2u], expected, all);
    }
    if (lane == 0u) ratios[blocks] = noise;
    return;
  }
  uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uvec2 first = k_preview_change_step * uvec2(block % push.blocks_across, block / push.blocks_across);
  vec4 now[k_cells], before[k_cells], weights[k_cells], noise[k_cells];
  float samples[k_cells];
  for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    uint at = 64u * i + lane;
    uvec2 xy = first + uvec2(at % k_preview_change_step, at / k_preview_change_step);
    samples[i] = 0.0, now[i] = before[i] = vec4(0.0), noise[i] = vec4(-1.0);
    if (xy.x >= push.across || xy.y >= push.down || block >= blocks) continue;
    int cell = int(xy.y * push.across + xy.x);
    PreviewSurface s = preview_surface(texelFetch(grid_surfaces, cell));
    if (s.samples <= 0.0) continue;
    samples[i] = s.samples;
    PreviewLight l = preview_light(grid_texels, cell);
    now[i] = preview_luminances(l), noise[i] = preview_errors(l);
    before[i] = max(texelFetch(before_texels, cell), vec4(0.0));
    lanes[0][lane] += before[i], lanes[1][lane].x += 1.0;
  }
  add_up(lane);
  // One weight for the block: weights by single cells' light would favour cells that are dark by noise.
  vec4 mean = max(lanes[0][0] / max(lanes[1][0].x, 1.0), vec4(1e-6));
  barrier();
  for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    lanes[3][lane].x += samples[i];
    weights[i] = samples[i] / mean;
    lanes[0][lane] += weights[i] * now[i], lanes[1][lane] += weights[i] * before[i];
  }
  add_up(lane);
  vec4 sum_now = lanes[0][0], sum_before = lanes[1][0], count = lanes[3][0], ratio = sum_now / max(sum_before, vec4(1e-20));
  barrier();
  lanes[0][lane] = lanes[1][lane] = vec4(0.0);
  for (uint i = 0u; i < k_cells; ++i) {
    vec4 off = weights[i] * (now[i] - ratio * before[i]);
    // Cells that share a preview sample have the same error.
    vec4 spread = samples[i] > 0.0 ? off * off / min(samples[i], 1.0) : vec4(0.0), own = weights[i] * noise[i];
    lanes[0][lane] += spread;
    lanes[1][lane] += mix(own * own, spread, lessThan(noise[i], vec4(0.0)));  // unknown with one sample
  }
  add_up(lane);
  if (lane == 0u && block < blocks) {
    uint at = k_preview_change_texels * block;
    sums[at] = sum_now, sums[at + 1u] = sum_before, sums[at + 2u] = lanes[0][0], sums[at + 3u] = count, sums[at + 4u] = lanes[1][0];
  }
}
