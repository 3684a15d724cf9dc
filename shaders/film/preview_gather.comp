// Previous picture from another camera (after preview_scatter.comp): a pixel between pixels that moved apart takes that of a
// neighbour. Seams and newly visible surfaces stay unknown.
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewReprojectPush push; };
uniform samplerBuffer from_texels, from_surfaces;
uniform usamplerBuffer nearest_depths, nearest_pixels;
layout(scalar) writeonly buffer Packed { vec4 packed[]; };
layout(scalar) writeonly buffer PackedSurfaces { vec4 packed_surfaces[]; };

const int k_apart = 3;  // pixels

uint depth_bits(int at) { return texelFetch(nearest_depths, at >> 2)[at & 3]; }
uint nearest_pixel(int at) { return texelFetch(nearest_pixels, at >> 2)[at & 3]; }

// Pixels that the camera approached lie farther apart: finds the nearest one, if there are some on at least three sides.
bool between(ivec2 xy, ivec2 size, out ivec2 nearest) {
  uint sides = 0u;
  int least = 3 * k_apart * k_apart;
  for (int y = -k_apart; y <= k_apart; ++y)
    for (int x = -k_apart; x <= k_apart; ++x) {
      ivec2 at = xy + ivec2(x, y);
      if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size)) || depth_bits(at.y * size.x + at.x) == k_preview_none)
        continue;
      sides |= 1u << ((x > 0 || (x == 0 && y > 0) ? 1 : 0) + (y > 0 || (y == 0 && x < 0) ? 2 : 0));
      if (x * x + y * y < least) {
        least = x * x + y * y;
        nearest = at;
      }
    }
  return bitCount(sides) >= 3;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint from = nearest_pixel(int(pixel)), depth = depth_bits(int(pixel));
  ivec2 xy = ivec2(pixel % push.width, pixel / push.width), size = ivec2(push.width, push.height);
  // Gaps between pixels that moved apart take the nearest neighbour, if most neighbours are known. So do pixels of a surface
  // behind that shows through.
  uint around = 0u, best_depth = k_preview_none;
  ivec2 best_at = xy;
  float near = from == k_preview_none ? uintBitsToFloat(0x7f7fffffu) : 0.95 * uintBitsToFloat(depth);
  for (int k = 0; k < 9; ++k) {
    ivec2 at = xy + ivec2(k % 3, k / 3) - 1;
    bool inside = k != 4 && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
    uint d = inside ? depth_bits(at.y * size.x + at.x) : k_preview_none;
    if (d == k_preview_none || uintBitsToFloat(d) >= near) continue;
    ++around;
    if (d < best_depth) best_at = at, best_depth = d;
  }
  if (around >= (from == k_preview_none ? 3u : 6u)) {
    from = nearest_pixel(best_at.y * size.x + best_at.x);
    depth = best_depth;
  }
  if (from == k_preview_none) {
    ivec2 at;
    if (between(xy, size, at)) {
      int there = at.y * size.x + at.x;
      from = nearest_pixel(there);
      depth = depth_bits(there);
    }
  }
  vec4 surface = vec4(-1.0, 0.0, 0.0, 0.0), a = preview_texel(vec4(0.0, 0.0, 0.0, -1.0), vec4(0.0)), b = vec4(0.0);
  if (from != k_preview_none) {
    surface = texelFetch(from_surfaces, int(from));
    if (surface.x > 0.0) surface.x = uintBitsToFloat(depth);
    if (surface.x < k_preview_about) surface.x = k_preview_about - uintBitsToFloat(depth);
    a = texelFetch(from_texels, int(2u * from));
    b = texelFetch(from_texels, int(2u * from) + 1);
  }
  packed_surfaces[pixel] = surface;
  packed[2u * pixel] = a;
  packed[2u * pixel + 1u] = b;
}
