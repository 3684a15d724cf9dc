// Where the pixels of what was shown before are in the picture of another camera: every pixel goes where its surface now
// is, and the nearest stays (preview_gather.comp takes them over).
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewReprojectPush push; };
uniform samplerBuffer from_surfaces;
layout(scalar) buffer NearestDepth { uint nearest_depth[]; };  // bits of a float above 0
layout(scalar) buffer NearestPixel { uint nearest_pixel[]; };

const float k_far = 1e8;  // where there is no surface

// Of a pixel before: its pixel now (k_preview_none: outside) and depth.
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
  if (depth <= 0.0 || from < 0.0) return k_preview_none;
  float ratio = (push.orthographic & 2u) != 0u ? 1.0 : 1.0 / depth;
  vec2 q = ratio * vec2(dot(point, push.now.right) / dot(push.now.right, push.now.right),
                        dot(point, push.now.up) / dot(push.now.up, push.now.up));
  if (any(greaterThanEqual(abs(q), vec2(1.0)))) return k_preview_none;
  uvec2 at = min(uvec2((q * vec2(0.5, -0.5) + 0.5) * vec2(push.width, push.height)), uvec2(push.width, push.height) - 1u);
  return at.y * push.width + at.x;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  float depth;
  uint to = moved(pixel, depth);
  if (to == k_preview_none) return;
  if (push.pass == 0u) {
    atomicMin(nearest_depth[to], floatBitsToUint(depth));
  } else if (floatBitsToUint(depth) == nearest_depth[to]) {
    atomicMin(nearest_pixel[to], pixel);
  }
}
