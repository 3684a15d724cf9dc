// Luminance of both halves of each pixel, and the largest of each half around it: input of tame.comp.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights;
layout(scalar) writeonly buffer FilterSpread { vec4 spread[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  vec2 own = vec2(0.0), most = vec2(0.0);
  for (int y = -k_filter_near; y <= k_filter_near; ++y)
    for (int x = -k_filter_near; x <= k_filter_near; ++x) {
      ivec2 at = clamp(xy + ivec2(x, y), ivec2(0), size - 1);
      FilterLight l = filter_light(texelFetch(filter_lights, at.y * size.x + at.x));
      vec2 value = vec2(luminance(l.even), luminance(l.odd));
      most = max(most, value);
      if (x == 0 && y == 0) own = value;
    }
  spread[pixel] = vec4(own, most);
}
