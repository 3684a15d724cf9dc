// Error of the preview, tile by tile: its expected error, and the error measured by samples that it has not used.
//
// The picture shown at first, of luminance L, is compared with samples of the film taken since, of mean S. With d = (L - S) / D,
// D a scale of the tile, the mean of d_i d_j over pairs of different pixels is an unbiased estimate of the square of the mean of d
// over the tile: the samples' noise is independent from pixel to pixel and leaves no trace in products of two, however bright a
// rare path is. The tile's mean is measured, not its pixels: what filters leave is wide, and single pixels' noise is far larger.
#include "lib/invocation.glsl"
#include "lib/math.glsl"
#include "shaders/shared/preview.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewJudgePush push; };
layout(scalar) readonly buffer ShownBefore { uint shown_before[]; };
layout(scalar) readonly buffer ShownNow { uint shown_now[]; };
layout(scalar) readonly buffer SumsBefore { vec2 sums_before[]; };
layout(scalar) readonly buffer SumsNow { vec2 sums_now[]; };
layout(scalar) writeonly buffer Tiles { PreviewTile tiles[]; };

const uint k_pixels = k_preview_tile * k_preview_tile;
// Maximum factor by which the mean of the samples changes a tile's scale from that of the shown picture.
const float k_scale = 4.0;

shared vec4 lanes[64];
shared vec4 tile_sum;

// Sum of a vector over the workgroup, returned to all its invocations.
vec4 group_sum(vec4 value) {
  uint lane = gl_LocalInvocationIndex;
  barrier();
  lanes[lane] = value;
  barrier();
  if (lane == 0u) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 64u; ++i) sum += lanes[i];
    tile_sum = sum;
  }
  barrier();
  return tile_sum;
}

// Previously shown luminance of a film pixel, which may cover several of the picture, and luminance of its new samples. False
// if either is missing.
bool pair_of(uvec2 at, uint step, out float shown, out float sampled) {
  if (at.x >= push.film_width || at.y >= push.film_height) return false;
  uint film = at.y * push.film_width + at.x;
  vec2 fresh = sums_now[film] - sums_before[film];
  if (fresh.y < 0.5) return false;
  float sum = 0.0, count = 0.0;
  for (uint i = 0u; i < step * step; ++i) {
    uvec2 xy = at * step + uvec2(i % step, i / step);
    if (xy.x >= push.width || xy.y >= push.height) continue;
    sum += unpackHalf2x16(shown_before[xy.y * push.width + xy.x]).x;
    count += 1.0;
  }
  if (count == 0.0) return false;
  shown = sum / count;
  sampled = max(fresh.x, 0.0) / fresh.y;
  return true;
}

void main() {
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
  uint across = (push.width + k_preview_tile - 1u) / k_preview_tile, down = (push.height + k_preview_tile - 1u) / k_preview_tile;
  bool inside = tile < across * down;
  uvec2 first = k_preview_tile * uvec2(tile % across, tile / across);
  vec4 expected = vec4(0.0);  // sum, pixels
  for (uint k = lane; k < k_pixels; k += 64u) {
    uvec2 xy = first + uvec2(k % k_preview_tile, k / k_preview_tile);
    if (!inside || xy.x >= push.width || xy.y >= push.height) continue;
    expected.xy += vec2(unpackHalf2x16(shown_now[xy.y * push.width + xy.x]).y, 1.0);
  }
  expected = group_sum(expected);
  uint step = max(push.step, 1u), side = k_preview_tile / step;
  float shown, sampled;
  vec4 means = vec4(0.0);
  for (uint k = lane; k < side * side; k += 64u)
    if (inside && push.step != 0u && pair_of(first / step + uvec2(k % side, k / side), step, shown, sampled))
      means += vec4(shown, sampled, 1.0, 0.0);
  means = group_sum(means);
  float n = means.z;
  float ratio = means.x > 0.0 ? clamp(0.5 + 0.5 * means.y / means.x, 1.0 / k_scale, k_scale) : 1.0;
  float scale = 1.0 / max(ratio * means.x / max(n, 1.0), k_preview_dark);
  vec4 sums = vec4(0.0);
  for (uint k = lane; k < side * side; k += 64u)
    if (inside && push.step != 0u && pair_of(first / step + uvec2(k % side, k / side), step, shown, sampled)) {
      float d = scale * (shown - sampled);
      sums += vec4(d, d * d, 0.0, 0.0);
    }
  sums = group_sum(sums);
  if (lane == 0u && inside) {
    PreviewTile t;
    t.error = expected.x / max(expected.y, 1.0);
    t.square = n >= 2.0 ? (sums.x * sums.x - sums.y) / (n * (n - 1.0)) : 0.0;
    t.noise = n >= 2.0 ? max(sums.y - sums.x * sums.x / n, 0.0) / (n * (n - 1.0)) : -1.0;
    tiles[tile] = t;
  }
}
