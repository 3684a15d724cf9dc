// Takes from each half what the other does not confirm: light of a pixel that is brighter than all that the other half has met
// around it is no more than that. What both halves have is light, however small it is.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights;
layout(scalar) writeonly buffer FilterTamed { vec4 tamed[]; };

const int k_reach = 2;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  FilterLight here = filter_light(texelFetch(filter_lights, int(pixel)));
  vec2 most = vec2(0.0);  // of the even and of the odd half
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -k_reach; x <= k_reach; ++x) {
      ivec2 at = clamp(xy + ivec2(x, y), ivec2(0), size - 1);
      FilterLight l = filter_light(texelFetch(filter_lights, at.y * size.x + at.x));
      most = max(most, vec2(luminance(l.even), luminance(l.odd)));
    }
  most *= k_filter_confirmed;
  float even = luminance(here.even), odd = luminance(here.odd);
  if (even > most.y) here.even *= most.y / even;
  if (odd > most.x) here.odd *= most.x / odd;
  tamed[pixel] = filter_texel(here);
}
