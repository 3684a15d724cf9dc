// What was shown before, as the camera sees it now, is the picture until there is new light. What has come into view takes
// the light of what is next to it, rather of what is behind.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "film/preview.glsl"
#include "shaders/shared/tone.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewRecallPush push; };
uniform samplerBuffer history_texels, history_surfaces;
layout(scalar) writeonly buffer Picture { uint picture[]; };

const int k_reach = 256;   // pixels
const float k_sky = 10.0;  // depth that the background is taken for [m], so that it does not outweigh a wall that is next

// Of what was shown: about where its surface is; 0: it is not known, nor its light.
float depth_at(int pixel) {
  float depth = texelFetch(history_surfaces, pixel).x;
  if (depth < 0.0 && depth > k_preview_about) return 0.0;
  depth = depth < 0.0 ? k_preview_about - depth : depth;
  return depth > 0.0 ? depth : k_sky;
}
vec3 shown_at(int pixel) {
  PreviewLight l = preview_unpack(texelFetch(history_texels, 2 * pixel), texelFetch(history_texels, 2 * pixel + 1));
  vec3 sum = vec3(0.0);
  for (uint c = 0u; c < k_component_count; ++c) sum += l.of[c].rgb * float(push.show >> c & 1u);
  return sum;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 xy = ivec2(pixel % push.width, pixel / push.width), size = ivec2(push.width, push.height);
  vec3 here = shown_at(int(pixel));
  if (depth_at(int(pixel)) <= 0.0) {
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 9; ++k) {
      ivec2 way = ivec2(k % 3, k / 3) - 1;
      // Steps that double: all of a picture may have to be looked for.
      for (int far = k == 4 ? 2 * k_reach : 1; far <= k_reach; far *= 2) {
        ivec2 at = xy + far * way;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
        int there = at.y * size.x + at.x;
        float depth = depth_at(there);
        if (depth <= 0.0) continue;
        sum += square(square(depth)) / float(far) * vec4(shown_at(there), 1.0);
        break;
      }
    }
    here = sum.rgb / max(sum.w, 1e-20);
  }
  picture[pixel] = picture_packed(tone_map(here * push.history_scale, push.curve));
}
