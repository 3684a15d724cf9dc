// What was shown before, as another camera sees it: every pixel goes where its surface now is, the nearest stays; a pixel
// between them takes that of a neighbour. Seams and what comes into view stay unknown.
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewReprojectPush push; };
uniform samplerBuffer from_texels, from_surfaces;
layout(scalar) buffer NearestDepth { uint nearest_depth[]; };  // bits of a float above 0
layout(scalar) buffer NearestPixel { uint nearest_pixel[]; };
layout(scalar) writeonly buffer Packed { vec4 packed[]; };
layout(scalar) writeonly buffer PackedSurfaces { vec4 packed_surfaces[]; };

const float k_far = 1e8;  // where there is no surface
const uint k_none = 0xffffffffu;

// Of a pixel before: its pixel now (k_none: outside) and depth.
uint moved(uint pixel, out float depth) {
  float from = texelFetch(from_surfaces, int(pixel)).x;
  if (from <= k_preview_about) from = k_preview_about - from;
  vec2 p = vec2(2.0, -2.0) * (vec2(pixel % push.width, pixel / push.width) + 0.5) / vec2(push.width, push.height) +
           vec2(-1.0, 1.0);
  float far = from > 0.0 ? from : k_far;
  vec3 ray = p.x * push.before.right + p.y * push.before.up;
  bool parallel = (push.orthographic & 1u) != 0u;
  vec3 point = push.before.origin - push.now.origin +
               (parallel ? ray + far * push.before.forward : far * (ray + push.before.forward));
  depth = dot(point, push.now.forward);
  if (depth <= 0.0 || from < 0.0) return k_none;
  float ratio = (push.orthographic & 2u) != 0u ? 1.0 : 1.0 / depth;
  vec2 q = ratio * vec2(dot(point, push.now.right) / dot(push.now.right, push.now.right),
                        dot(point, push.now.up) / dot(push.now.up, push.now.up));
  if (any(greaterThanEqual(abs(q), vec2(1.0)))) return k_none;
  uvec2 at = min(uvec2((q * vec2(0.5, -0.5) + 0.5) * vec2(push.width, push.height)), uvec2(push.width, push.height) - 1u);
  return at.y * push.width + at.x;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  if (push.pass < 2u) {
    float depth;
    uint to = moved(pixel, depth);
    if (to == k_none) return;
    if (push.pass == 0u) {
      atomicMin(nearest_depth[to], floatBitsToUint(depth));
    } else if (floatBitsToUint(depth) == nearest_depth[to]) {
      atomicMin(nearest_pixel[to], pixel);
    }
    return;
  }
  uint from = nearest_pixel[pixel];
  uint depth = nearest_depth[pixel];
  ivec2 xy = ivec2(pixel % push.width, pixel / push.width);
  // What lies between pixels that moved apart: the nearest of its neighbours, where most of them are there. So are pixels
  // of what is behind that show through.
  uint around = 0u, best = k_none, best_depth = k_none;
  for (int k = 0; k < 9; ++k) {
    ivec2 at = xy + ivec2(k % 3, k / 3) - 1;
    if (k == 4 || any(lessThan(at, ivec2(0))) || at.x >= int(push.width) || at.y >= int(push.height)) continue;
    uint there = uint(at.y) * push.width + uint(at.x);
    uint other = nearest_pixel[there];
    if (other == k_none) continue;
    uint d = nearest_depth[there];
    bool nearer = from == k_none || uintBitsToFloat(d) < 0.95 * uintBitsToFloat(depth);
    around += nearer ? 1u : 0u;
    if (nearer && d < best_depth) best = other, best_depth = d;
  }
  if (around >= (from == k_none ? 3u : 6u)) from = best, depth = best_depth;
  vec4 surface = vec4(-1.0, 0.0, 0.0, 0.0), a = preview_texel(vec4(0.0, 0.0, 0.0, -1.0), vec4(0.0)), b = vec4(0.0);
  if (from != k_none) {
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
