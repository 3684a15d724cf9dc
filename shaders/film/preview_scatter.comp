// Moves the pixels of the previous picture into the picture of another camera: each covers the projection of its surface, in
// its projected width, and the nearest one stays (preview_gather.comp reads them).
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewReprojectPush push; };
uniform samplerBuffer from_surfaces;
layout(scalar) buffer NearestDepth { uint nearest_depth[]; };  // bits of a float above 0
layout(scalar) buffer NearestPixel { uint nearest_pixel[]; };

const float k_widest = 4.0;   // pixels

// Projection of a previous pixel: its centre [pixels], depth (0: outside) and width [pixels].
vec2 moved(uint pixel, out float depth, out float width) {
  float from = texelFetch(from_surfaces, int(pixel)).x;
  if (from <= k_preview_about) from = k_preview_about - from;
  vec2 size = vec2(push.width, push.height), p = preview_position(uvec2(pixel % push.width, pixel / push.width), size);
  float far = from > 0.0 ? from : k_preview_far;
  uint projection = push.projections & 15u, projection_now = push.projections >> 4;
  vec3 point = push.before.origin - push.now.origin + preview_point(push.before, projection, p, far);
  vec2 there = preview_projection(push.now, projection_now, point, size, depth);
  width = 1.0;
  if (depth <= 0.0 || from < 0.0) {
    depth = 0.0;
    return vec2(0.0);
  }
  float extent = length(push.before.up) * (is_parallel(projection) ? 1.0 : far), extent_now = length(push.now.up) * (is_parallel(projection_now) ? 1.0 : depth);
  width = clamp(extent / extent_now, 1.0, k_widest);
  return there;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  float depth, width;
  vec2 middle = moved(pixel, depth, width);
  ivec2 size = ivec2(push.width, push.height), at = ivec2(floor(middle));
  if (depth <= 0.0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) return;
  // The pixels whose centres it covers, and the one that contains its centre.
  ivec2 first = clamp(min(ivec2(ceil(middle - 0.5 * width - 0.5)), at), ivec2(0), size - 1);
  ivec2 last = clamp(max(ivec2(floor(middle + 0.5 * width - 0.5)), at), ivec2(0), size - 1);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      int to = y * size.x + x;
      if (push.pass == 0u) {
        atomicMin(nearest_depth[to], floatBitsToUint(depth));
      } else if (floatBitsToUint(depth) == nearest_depth[to]) {
        atomicMin(nearest_pixel[to], pixel);
      }
    }
}
