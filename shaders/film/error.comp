// What the two halves of the film say of the noise in the blocks of a work item: one workgroup a block. All sums are taken
// in a fixed order.
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ErrorPush push; };
layout(scalar) writeonly buffer BlockErrors { BlockError block_errors[]; };

const uint k_sums = 11u;  // luminance [0..4], variance [5..9], fourth
shared float values[k_sums * 64u];
shared float relative[64];
shared float present[64];
shared float quadrant_mean[4];

float half_luminance(FilmHalf h, float n) { return luminance(h.sum + h.compensation) / n; }

void main() {
  uint code = gl_LocalInvocationIndex, entry = global_index() / 64u;
  if (entry >= push.block_count) return;
  WorkBlock block = blocks[entry];
  uvec2 xy = block_pixel(block.index, code, push.width);
  bool inside = xy.x < push.width && xy.y < push.height;
  uint pixel = inside ? xy.y * push.width + xy.x : 0u;
  uint count = inside ? film_count[pixel] : 0u;
  bool there = count >= 2u;
  float even = float(max((count + 1u) / 2u, 1u)), odd = float(max(count / 2u, 1u));
  float a[5], b[5];
  a[0] = 0.0;
  b[0] = 0.0;
  for (uint c = 0u; c < 4u; ++c) {
    FilmPixel p = film_load(c, pixel);
    a[c + 1u] = half_luminance(p.even, even);
    b[c + 1u] = half_luminance(p.odd, odd);
    a[0] += a[c + 1u];
    b[0] += b[c + 1u];
  }
  float y0 = 0.0, v0 = 0.0;
  for (uint c = 0u; c < 5u; ++c) {
    float difference = 0.5 * (a[c] - b[c]);
    float y = there ? 0.5 * (a[c] + b[c]) : 0.0, v = there ? difference * difference : 0.0;
    values[c * 64u + code] = y;
    values[(5u + c) * 64u + code] = v;
    if (c == 0u) {
      y0 = y;
      v0 = v;
    }
  }
  values[10u * 64u + code] = v0 * v0;
  present[code] = there ? 1.0 : 0.0;
  barrier();
  // A quadrant's pixels follow one another in Morton order.
  if (code < 4u) {
    float sum = 0.0, n = 0.0;
    for (uint i = 16u * code; i < 16u * code + 16u; ++i) {
      sum += values[i];
      n += present[i];
    }
    quadrant_mean[code] = sum / max(n, 1.0);
    block_errors[block.index].quadrant_pixels[code] = n;
  }
  if (code >= 16u && code < 16u + k_sums) {
    uint which = code - 16u;
    float sum = 0.0;
    for (uint i = 0u; i < 64u; ++i) sum += values[which * 64u + i];
    if (which < 5u) block_errors[block.index].luminance[which] = sum;
    else if (which < 10u) block_errors[block.index].variance[which - 5u] = sum;
    else block_errors[block.index].fourth = sum;
  }
  barrier();
  float scale = max(max(y0, quadrant_mean[code / 16u]), push.luminance_floor);
  relative[code] = 1.2533141 * sqrt(v0) / scale;  // sqrt(pi/2)
  barrier();
  if (code < 4u) {
    float sum = 0.0;
    for (uint i = 16u * code; i < 16u * code + 16u; ++i) sum += relative[i];
    block_errors[block.index].relative[code] = sum;
  }
  if (code == 16u) {
    float n = 0.0;
    for (uint i = 0u; i < 64u; ++i) n += present[i];
    block_errors[block.index].pixels = n;
  }
}
