// What the two halves of the film say of the noise in the blocks of a work item: one invocation a row of a block, eight
// blocks a workgroup. All sums are taken in a fixed order. With LUCERNA_STOPPING_ONLY just what decides whether a tile goes
// on, `relative` and `quadrant_pixels`: nobody asks for the rest after every pass.
#include "lib/variants.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ErrorPush push; };
layout(scalar) writeonly buffer BlockErrors { BlockError block_errors[]; };
#if LUCERNA_LOOKUP_ERRORS
layout(scalar) readonly buffer FilmRecords { vec2 film_records[]; };  // squares: noise of records, of interpolation
// What lookups blur, with its sign: sums over the even and over the odd samples.
layout(scalar) readonly buffer FilmBiasEven { float film_bias_even[]; };
layout(scalar) readonly buffer FilmBiasOdd { float film_bias_odd[]; };
#endif

#if LUCERNA_STOPPING_ONLY
const uint k_sums = 4u;
#else
const uint k_sums = 4u + 12u;
#endif
// Of a row, by what is summed. First its two halves of four pixels: luminance, and how many are there; then luminance
// [0..4], variance [0..4], fourth, difference. All of a kind lie together, so that neighbouring invocations write side by side.
shared float values[k_sums * 64u];

float half_luminance(FilmHalf h, float n) { return luminance(h.sum + h.compensation) / n; }

float sum_of_rows(uint what, uint first, uint rows) {
  float sum = 0.0;
  for (uint i = 0u; i < rows; ++i) sum += values[what * 64u + first + i];
  return sum;
}

// A row of a block.
struct Row {
  float y[k_block], v[k_block];  // of its pixels: luminance and variance, of [0]; 0 where there are no two samples
  float half_y[2], half_n[2];    // of its halves
#if LUCERNA_LOOKUP_ERRORS
  vec2 squares[k_block];  // of its pixels, as FilmRecords
  vec2 records;           // their sum
  vec2 bias;              // sums over the row, of the even and of the odd samples' mean
  float unmixed;          // sum over the row: luminance as samples have brought it
#endif
#if !LUCERNA_STOPPING_ONLY
  float ys[5], vs[5], fourth, total_difference;  // sums over the row, as BlockError
#endif
};

// Means of the luminance in the film's two halves, of the sum and by component; `unmixed`: twice the luminance as samples
// have brought it.
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
}

// The row that begins at the pixel `first`; an empty one where there is no work.
Row read_row(bool working, uvec2 first) {
  Row r;
  r.half_y[0] = r.half_y[1] = r.half_n[0] = r.half_n[1] = 0.0;
#if LUCERNA_LOOKUP_ERRORS
  r.records = r.bias = vec2(0.0);
  r.unmixed = 0.0;
#endif
#if !LUCERNA_STOPPING_ONLY
  r.fourth = r.total_difference = 0.0;
  for (uint c = 0u; c < 5u; ++c) r.ys[c] = r.vs[c] = 0.0;
#endif
  for (uint x = 0u; x < k_block; ++x) {
    bool inside = working && first.x + x < push.width && first.y < push.height;
    uint pixel = inside ? first.y * push.width + first.x + x : 0u;
    uint count = inside ? film_count[pixel] : 0u;
    bool there = count >= 2u;
    float a[5], b[5], unmixed;
    read_halves(pixel, count, a, b, unmixed);
    float difference = 0.5 * (a[0] - b[0]);
    r.y[x] = there ? 0.5 * (a[0] + b[0]) : 0.0;
    r.v[x] = there ? difference * difference : 0.0;
#if LUCERNA_LOOKUP_ERRORS
    // Lookups err in proportion to their light, in that of each group alike.
    float mixed = unmixed > 0.0 ? (a[0] + b[0]) / unmixed : 1.0;
    r.squares[x] = there && push.records != 0u ? square(mixed) * film_records[pixel] : vec2(0.0);
    r.unmixed += there ? 0.5 * unmixed : 0.0;
    // The halves are independent: in the mean the product of theirs is the square, without the noise of either.
    vec2 bias = vec2(0.0);
    if (there && push.bias != 0u) bias = vec2(film_bias_even[pixel], film_bias_odd[pixel]) / vec2((count + 1u) / 2u, count / 2u);
    bias *= mixed;
    r.squares[x].y += bias.x * bias.y;
    r.bias += bias;
    r.records += r.squares[x];
#endif
    r.half_y[x / 4u] += r.y[x];
    r.half_n[x / 4u] += there ? 1.0 : 0.0;
#if !LUCERNA_STOPPING_ONLY
    r.ys[0] += r.y[x];
    r.vs[0] += r.v[x];
    r.fourth += r.v[x] * r.v[x];
    r.total_difference += there ? difference : 0.0;
    for (uint c = 1u; c < 5u; ++c) {
      difference = 0.5 * (a[c] - b[c]);
      r.ys[c] += there ? 0.5 * (a[c] + b[c]) : 0.0;
      r.vs[c] += there ? difference * difference : 0.0;
    }
#endif
  }
  return r;
}

// Puts a row where the others of its block see it.
void share_row(Row r, uint lane) {
  for (uint h = 0u; h < 2u; ++h) {
    values[h * 64u + lane] = r.half_y[h];
    values[(2u + h) * 64u + lane] = r.half_n[h];
  }
#if !LUCERNA_STOPPING_ONLY
  for (uint c = 0u; c < 5u; ++c) {
    values[(4u + c) * 64u + lane] = r.ys[c];
    values[(9u + c) * 64u + lane] = r.vs[c];
  }
  values[14u * 64u + lane] = r.fourth;
  values[15u * 64u + lane] = r.total_difference;
#endif
}

#if !LUCERNA_STOPPING_ONLY
// What does not hang on the quadrants, each sum by a row of its own.
void write_sums(uint block, uint row, uint first_row) {
  if (row < 5u) block_errors[block].luminance[row] = sum_of_rows(4u + row, first_row, k_block);
  if (row < 5u) block_errors[block].variance[row] = sum_of_rows(9u + row, first_row, k_block);
  if (row == 5u) block_errors[block].fourth = sum_of_rows(14u, first_row, k_block);
  if (row == 6u) block_errors[block].pixels = sum_of_rows(2u, first_row, k_block) + sum_of_rows(3u, first_row, k_block);
  if (row == 7u) block_errors[block].difference = sum_of_rows(15u, first_row, k_block);
}
#endif

// Sums over the row of the pixels' relative errors, by half; `mean`: luminance of the halves' quadrants. `records`: of the
// lookups' squares, over the square of what the errors are held against.
void relative_errors(Row r, float mean[2], out float relative[2], out vec2 records) {
  relative[0] = relative[1] = 0.0;
  records = vec2(0.0);
  for (uint x = 0u; x < k_block; ++x) {
    float scale = max(max(r.y[x], mean[x / 4u]), push.luminance_floor);
    relative[x / 4u] += 1.2533141 * sqrt(r.v[x]) / scale;  // sqrt(pi/2)
#if LUCERNA_LOOKUP_ERRORS
    records += r.squares[x] / (scale * scale);
#endif
  }
}

void main() {
  uint lane = gl_LocalInvocationIndex, row = lane % k_block, entry = global_index() / k_block;
  bool working = entry < push.block_count;
  WorkBlock block = blocks[working ? entry : 0u];
  uint across = (push.width + k_block - 1u) / k_block;
  Row r = read_row(working, k_block * uvec2(block.index % across, block.index / across) + uvec2(0u, row));
  share_row(r, lane);
  barrier();
  // Each row's halves belong to the two quadrants above or below the middle.
  uint first_row = lane - row, quadrant_row = lane / 4u * 4u;
  float mean[2], pixels[2];
  for (uint h = 0u; h < 2u; ++h) {
    pixels[h] = sum_of_rows(2u + h, quadrant_row, 4u);
    mean[h] = sum_of_rows(h, quadrant_row, 4u) / max(pixels[h], 1.0);
  }
#if !LUCERNA_STOPPING_ONLY
  if (working) write_sums(block.index, row, first_row);
#endif
  float relative[2];
  vec2 records_relative;
  relative_errors(r, mean, relative, records_relative);
  barrier();
  for (uint h = 0u; h < 2u; ++h) values[h * 64u + lane] = relative[h];
  barrier();
#if LUCERNA_LOOKUP_ERRORS
  values[2u * 64u + lane] = records_relative.x;
  values[3u * 64u + lane] = records_relative.y;
  barrier();
  if (working && row == 2u) block_errors[block.index].records_relative = sum_of_rows(2u, first_row, k_block);
  if (working && row == 3u) block_errors[block.index].interpolation_relative = sum_of_rows(3u, first_row, k_block);
#if !LUCERNA_STOPPING_ONLY
  barrier();
  values[2u * 64u + lane] = r.records.x;
  values[3u * 64u + lane] = r.records.y;
  values[4u * 64u + lane] = r.bias.x;
  values[5u * 64u + lane] = r.bias.y;
  values[6u * 64u + lane] = r.unmixed;
  barrier();
  if (working && row < 2u) block_errors[block.index].bias[row] = sum_of_rows(4u + row, first_row, k_block);
  if (working && row == 5u) block_errors[block.index].unmixed = sum_of_rows(6u, first_row, k_block);
  if (working && row == 6u) block_errors[block.index].records = sum_of_rows(2u, first_row, k_block);
  if (working && row == 7u) block_errors[block.index].interpolation = sum_of_rows(3u, first_row, k_block);
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
