// Estimates the noise in the blocks of a work item from the two halves of the film: one invocation a row of a block, eight
// blocks a workgroup. The order of all sums is fixed. With LUCERNA_STOPPING_ONLY it computes only `relative` and
// `quadrant_pixels`, which decide whether a tile continues; the rest is not needed after every pass. With
// LUCERNA_ERROR_LAYERS four layers by path expressions stand in place of the components, and the errors of lookups, which
// are known of the sum alone, are left out.
#include "lib/variants.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ErrorPush push; };
#if LUCERNA_ERROR_LAYERS
layout(scalar) writeonly buffer LayerBlockErrors { BlockError block_errors[]; };
uniform samplerBuffer film_layer_0, film_layer_1, film_layer_2, film_layer_3;
FilmPixel layer_load(uint layer, uint pixel) {
  if (layer == 0u) return LUCERNA_FILM_LOAD(film_layer_0, pixel);
  if (layer == 1u) return LUCERNA_FILM_LOAD(film_layer_1, pixel);
  if (layer == 2u) return LUCERNA_FILM_LOAD(film_layer_2, pixel);
  return LUCERNA_FILM_LOAD(film_layer_3, pixel);
}
#else
layout(scalar) writeonly buffer BlockErrors { BlockError block_errors[]; };
#endif
#if LUCERNA_LOOKUP_ERRORS
layout(scalar) readonly buffer FilmLookups { vec2 film_lookups[]; };  // squares: noise of stored light, of interpolation
// Blur error of lookups, signed: sums over the even and over the odd samples.
layout(scalar) readonly buffer FilmBiasEven { float film_bias_even[]; };
layout(scalar) readonly buffer FilmBiasOdd { float film_bias_odd[]; };
#endif

#if LUCERNA_STOPPING_ONLY
const uint k_sums = 4u;
#else
const uint k_sums = 17u;
#endif
// Sums of each row: number of pixels in its two halves of four, then luminance [0..4], variance [0..4], fourth, difference.
// Equal quantities of all rows are adjacent, so that neighbouring invocations write to adjacent words.
shared float values[k_sums * 64u];
// shown(Y) of the pixels of each block and those around it; negative: no pixel.
const uint k_around = k_block + 2u * k_seen_reach;
shared float around[8u * k_around * k_around];

float half_luminance(FilmHalf h, float n) { return luminance(h.sum + h.compensation) / n; }

float sum_of_rows(uint what, uint first, uint rows) {
  float sum = 0.0;
  for (uint i = 0u; i < rows; ++i) sum += values[what * 64u + first + i];
  return sum;
}

// A row of a block.
struct Row {
  float shown[k_block], seen[k_block];  // per pixel: shown(Y) and D of seen_error.h; 0 with less than two samples
  float half_n[2];                      // number of pixels of its halves
  uint there;                           // bit x: pixel x has two samples
#if LUCERNA_LOOKUP_ERRORS
  vec2 squares[k_block];  // per pixel: FilmLookups, weighted by visibility
  vec2 lookups;           // sum of FilmLookups
  vec2 bias;              // sums over the row, of the means of the even and of the odd samples
  float unmixed;          // sum over the row: luminance before the mix
#endif
#if !LUCERNA_STOPPING_ONLY
  float seen_of[4 * k_block];                                 // per pixel: D of each component
  float ys[5], vs[5], fourth, total_difference, white, dark;  // sums over the row, as in BlockError
#endif
};

// Mean luminance of the film's two halves, total and by component; `unmixed`: twice the luminance before the mix.
void read_halves(uint pixel, uint count, out float a[5], out float b[5], out float unmixed) {
  float even = float(max((count + 1u) / 2u, 1u)), odd = float(max(count / 2u, 1u));
  FilmRatio ratio = film_ratio(pixel);
  vec2 halves = vec2(0.0);
  for (uint c = 0u; c < k_component_count; ++c) {
    FilmPixel p = film_load(c, pixel);
    a[1u + c] = half_luminance(film_mixed(p.even, ratio.even), even);
    b[1u + c] = half_luminance(film_mixed(p.odd, ratio.odd), odd);
#if LUCERNA_LOOKUP_ERRORS
    halves += vec2(half_luminance(p.even, even), half_luminance(p.odd, odd));
#endif
  }
  unmixed = halves.x + halves.y;
  a[0] = a[1] + a[2] + a[3] + a[4];
  b[0] = b[1] + b[2] + b[3] + b[4];
#if LUCERNA_ERROR_LAYERS
  for (uint l = 0u; l < 4u; ++l) {
    FilmPixel p = layer_load(l, pixel);
    a[1u + l] = half_luminance(film_mixed(p.even, ratio.even), even);
    b[1u + l] = half_luminance(film_mixed(p.odd, ratio.odd), odd);
  }
#endif
}

// The row that begins at the pixel `first`; empty unless `working`.
Row read_row(bool working, uvec2 first) {
  Row r;
  r.half_n[0] = r.half_n[1] = 0.0;
  r.there = 0u;
#if LUCERNA_LOOKUP_ERRORS
  r.lookups = r.bias = vec2(0.0);
  r.unmixed = 0.0;
#endif
#if !LUCERNA_STOPPING_ONLY
  r.fourth = r.total_difference = r.white = r.dark = 0.0;
  for (uint c = 0u; c < 5u; ++c) r.ys[c] = r.vs[c] = 0.0;
#endif
  for (uint x = 0u; x < k_block; ++x) {
    bool inside = working && first.x + x < push.width && first.y < push.height;
    uint pixel = inside ? first.y * push.width + first.x + x : 0u;
    uint count = inside ? film_count[pixel] : 0u;
    bool there = count >= 2u;
    float a[5], b[5], unmixed;
    read_halves(pixel, count, a, b, unmixed);
    float y = there ? 0.5 * (a[0] + b[0]) : 0.0, difference = there ? 0.5 * (a[0] - b[0]) : 0.0;
    float part = seen_part(y, min(a[0], b[0]), push.luminance_white);
    r.shown[x] = seen_shown(y, push.luminance_white);
    r.seen[x] = part * abs(difference);
#if LUCERNA_LOOKUP_ERRORS
    // The relative errors of lookups are taken as equal for all light groups.
    float mixed = unmixed > 0.0 ? (a[0] + b[0]) / unmixed : 1.0;
    r.squares[x] = there && push.lookup_errors != 0u ? square(mixed) * film_lookups[pixel] : vec2(0.0);
    r.unmixed += there ? 0.5 * unmixed : 0.0;
    // The halves are independent: the expected product of their errors is the square, without their noise.
    vec2 bias = vec2(0.0);
    if (there && push.bias != 0u) bias = vec2(film_bias_even[pixel], film_bias_odd[pixel]) / vec2((count + 1u) / 2u, count / 2u);
    bias *= mixed;
    r.squares[x].y += bias.x * bias.y;
    r.bias += bias;
    r.lookups += r.squares[x];
    r.squares[x] *= part * part;
#endif
    r.half_n[x / 4u] += there ? 1.0 : 0.0;
    r.there |= uint(there) << x;
#if !LUCERNA_STOPPING_ONLY
    r.ys[0] += y;
    r.vs[0] += difference * difference;
    r.fourth += square(difference * difference);
    r.total_difference += difference;
    r.white += there && y >= push.luminance_white ? 1.0 : 0.0;
    r.dark += there && y < push.luminance_floor ? 1.0 : 0.0;
    for (uint c = 1u; c < 5u; ++c) {
      difference = 0.5 * (a[c] - b[c]);
      r.seen_of[4u * x + c - 1u] = there ? part * difference : 0.0;
      r.ys[c] += there ? 0.5 * (a[c] + b[c]) : 0.0;
      r.vs[c] += there ? difference * difference : 0.0;
    }
#endif
  }
  return r;
}

// Writes a row to shared memory for the other rows of its block.
void share_row(Row r, uint lane) {
  for (uint h = 0u; h < 2u; ++h) values[h * 64u + lane] = r.half_n[h];
#if !LUCERNA_STOPPING_ONLY
  for (uint c = 0u; c < 5u; ++c) {
    values[(2u + c) * 64u + lane] = r.ys[c];
    values[(7u + c) * 64u + lane] = r.vs[c];
  }
  values[12u * 64u + lane] = r.fourth;
  values[13u * 64u + lane] = r.total_difference;
#endif
}

#if !LUCERNA_STOPPING_ONLY
// Sums that do not depend on the quadrants, each computed by a different row.
void write_sums(uint block, uint row, uint first_row) {
  if (row < 5u) block_errors[block].luminance[row] = sum_of_rows(2u + row, first_row, k_block);
  if (row < 5u) block_errors[block].variance[row] = sum_of_rows(7u + row, first_row, k_block);
  if (row == 5u) block_errors[block].fourth = sum_of_rows(12u, first_row, k_block);
  if (row == 6u) block_errors[block].pixels = sum_of_rows(0u, first_row, k_block) + sum_of_rows(1u, first_row, k_block);
  if (row == 7u) block_errors[block].difference = sum_of_rows(13u, first_row, k_block);
}
#endif

// shown(Y) of a pixel, which may be outside of the picture; negative: less than two samples.
float shown_at(ivec2 at) {
  bool inside = at.x >= 0 && at.y >= 0 && uint(at.x) < push.width && uint(at.y) < push.height;
  uint pixel = inside ? uint(at.y) * push.width + uint(at.x) : 0u;
  uint count = inside ? film_count[pixel] : 0u;
  if (count < 2u) return -1.0;
  float a[5], b[5], unmixed;
  read_halves(pixel, count, a, b, unmixed);
  return seen_shown(0.5 * (a[0] + b[0]), push.luminance_white);
}

// A row's part of `around`: its own pixels, and ten of the block's eighty neighbours.
void share_shown(Row r, bool working, ivec2 first, uint lane, uint row) {
  const uint k_edge = k_seen_reach * k_around, k_sides = 2u * k_seen_reach;
  uint base = lane / k_block * k_around * k_around;
  for (uint x = 0u; x < k_block; ++x)
    around[base + (row + k_seen_reach) * k_around + x + k_seen_reach] = (r.there >> x & 1u) != 0u ? r.shown[x] : -1.0;
  const uint k_each = (2u * k_edge + k_block * k_sides) / k_block;
  for (uint i = 0u; i < k_each; ++i) {
    uint n = row * k_each + i, side = (n - 2u * k_edge) % k_sides;
    // Rows above, rows below, then the pixels to the left and to the right.
    uvec2 at = n < k_edge        ? uvec2(n % k_around, n / k_around)
               : n < 2u * k_edge ? uvec2(n % k_around, n / k_around + k_block)
                                 : uvec2(side < k_seen_reach ? side : side + k_block,
                                         (n - 2u * k_edge) / k_sides + k_seen_reach);
    around[base + at.y * k_around + at.x] = working ? shown_at(first + ivec2(at) - int(k_seen_reach)) : -1.0;
  }
}

// Mean of shown(Y) around a pixel of the block.
float local_shown(uint lane, uint x, uint row) {
  uint from = lane / k_block * k_around * k_around + row * k_around + x;
  float sum = 0.0, count = 0.0;
  for (uint v = 0u; v <= 2u * k_seen_reach; ++v)
    for (uint u = 0u; u <= 2u * k_seen_reach; ++u) {
      float y = around[from + v * k_around + u];
      sum += max(y, 0.0);
      count += y >= 0.0 ? 1.0 : 0.0;
    }
  return sum / max(count, 1.0);
}

// Sums over a row of errors relative to the shown luminance around: r by half, squared lookup errors, e^2 and e^4.
struct Relative {
  float of_half[2];
  vec2 lookups;
#if !LUCERNA_STOPPING_ONLY
  float seen[5], fourth;
#endif
};

Relative relative_errors(Row r, uint lane, uint row) {
  Relative sum;
  sum.of_half[0] = sum.of_half[1] = 0.0;
  sum.lookups = vec2(0.0);
#if !LUCERNA_STOPPING_ONLY
  sum.fourth = 0.0;
  for (uint c = 0u; c < 5u; ++c) sum.seen[c] = 0.0;
#endif
  for (uint x = 0u; x < k_block; ++x) {
    float scale = seen_scale(r.shown[x], local_shown(lane, x, row), push.luminance_floor), e = r.seen[x] / scale;
    sum.of_half[x / 4u] += 1.2533141 * min(e, 1.0);  // sqrt(pi/2)
#if LUCERNA_LOOKUP_ERRORS
    sum.lookups += r.squares[x] / (scale * scale);
#endif
#if !LUCERNA_STOPPING_ONLY
    sum.seen[0] += e * e;
    sum.fourth += square(e * e);
    for (uint c = 1u; c < 5u; ++c) sum.seen[c] += square(r.seen_of[4u * x + c - 1u] / scale);
#endif
  }
  return sum;
}

void main() {
  uint lane = gl_LocalInvocationIndex, row = lane % k_block, entry = global_index() / k_block;
  bool working = entry < push.block_count;
  WorkBlock block = blocks[working ? entry : 0u];
  uint across = (push.width + k_block - 1u) / k_block;
  uvec2 first = k_block * uvec2(block.index % across, block.index / across);
  Row r = read_row(working, first + uvec2(0u, row));
  share_row(r, lane);
  share_shown(r, working, ivec2(first), lane, row);
  barrier();
  // Each row's halves belong to the two quadrants above or below the middle.
  uint first_row = lane - row, quadrant_row = lane / 4u * 4u;
  float pixels[2];
  for (uint h = 0u; h < 2u; ++h) pixels[h] = sum_of_rows(h, quadrant_row, 4u);
#if !LUCERNA_STOPPING_ONLY
  if (working) write_sums(block.index, row, first_row);
#endif
  Relative relative = relative_errors(r, lane, row);
  barrier();
  for (uint h = 0u; h < 2u; ++h) values[h * 64u + lane] = relative.of_half[h];
#if LUCERNA_LOOKUP_ERRORS
  values[2u * 64u + lane] = relative.lookups.x;
  values[3u * 64u + lane] = relative.lookups.y;
#endif
#if !LUCERNA_STOPPING_ONLY
  for (uint c = 0u; c < 5u; ++c) values[(4u + c) * 64u + lane] = relative.seen[c];
  values[9u * 64u + lane] = relative.fourth;
  values[10u * 64u + lane] = r.white;
  values[11u * 64u + lane] = r.dark;
#if LUCERNA_LOOKUP_ERRORS
  values[12u * 64u + lane] = r.lookups.x;
  values[13u * 64u + lane] = r.lookups.y;
  values[14u * 64u + lane] = r.bias.x;
  values[15u * 64u + lane] = r.bias.y;
  values[16u * 64u + lane] = r.unmixed;
#endif
#endif
  barrier();
#if LUCERNA_LOOKUP_ERRORS
  if (working && row == 2u) block_errors[block.index].lookup_noise_relative = sum_of_rows(2u, first_row, k_block);
  if (working && row == 3u) block_errors[block.index].interpolation_relative = sum_of_rows(3u, first_row, k_block);
#endif
#if !LUCERNA_STOPPING_ONLY
  if (working && row < 5u) block_errors[block.index].seen[row] = sum_of_rows(4u + row, first_row, k_block);
  if (working && row == 5u) block_errors[block.index].seen_fourth = sum_of_rows(9u, first_row, k_block);
  if (working && row == 6u) block_errors[block.index].white = sum_of_rows(10u, first_row, k_block);
  if (working && row == 7u) block_errors[block.index].dark = sum_of_rows(11u, first_row, k_block);
#if LUCERNA_LOOKUP_ERRORS
  if (working && row < 2u) block_errors[block.index].bias[row] = sum_of_rows(14u + row, first_row, k_block);
  if (working && row == 5u) block_errors[block.index].unmixed = sum_of_rows(16u, first_row, k_block);
  if (working && row == 6u) block_errors[block.index].lookup_noise = sum_of_rows(12u, first_row, k_block);
  if (working && row == 7u) block_errors[block.index].interpolation = sum_of_rows(13u, first_row, k_block);
#endif
#endif
  // Rows 0 and 1 write the upper two quadrants, 4 and 5 the lower.
  uint side = row % 4u;
  if (working && side < 2u) {
    uint quadrant = row / 4u * 2u + side;
    block_errors[block.index].relative[quadrant] = sum_of_rows(side, quadrant_row, 4u);
    block_errors[block.index].quadrant_pixels[quadrant] = side == 0u ? pixels[0] : pixels[1];
  }
}
