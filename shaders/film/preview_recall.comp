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

const int k_reach = 256;      // pixels
const float k_sky = 10.0;     // depth that the background is taken for [m], so that it does not outweigh a wall that is next

// Of all components that are shown; w: its depth, 0 where it is not known.
vec4 shown_at(int pixel) {
  PreviewLight l = preview_unpack(texelFetch(history_texels, 2 * pixel), texelFetch(history_texels, 2 * pixel + 1));
  vec4 surface = texelFetch(history_surfaces, pixel);
  if (l.of[0].w < 0.0 && surface.w <= 0.0) return vec4(0.0);
  vec3 sum = vec3(0.0);
  for (uint c = 0u; c < k_component_count; ++c) sum += l.of[c].rgb * float(push.show >> c & 1u);
  float depth = surface.x <= k_preview_about ? k_preview_about - surface.x : surface.x;
  return vec4(sum, depth > 0.0 ? depth : k_sky);
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 xy = ivec2(pixel % push.width, pixel / push.width), size = ivec2(push.width, push.height);
  vec4 here = shown_at(int(pixel));
  if (here.w == 0.0) {
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 9; ++k) {
      ivec2 way = ivec2(k % 3, k / 3) - 1;
      if (k == 4) continue;
      for (int far = 1; far <= k_reach; far += (far + 3) / 4) {
        ivec2 at = xy + far * way;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
        vec4 there = shown_at(at.y * size.x + at.x);
        if (there.w == 0.0) continue;
        float weight = square(square(there.w)) / float(far);
        sum += weight * vec4(there.rgb, 1.0);
        break;
      }
    }
    here.rgb = sum.rgb / max(sum.w, 1e-20);
  }
  picture[pixel] = picture_packed(tone_map(here.rgb * push.history_scale, push.curve));
}
