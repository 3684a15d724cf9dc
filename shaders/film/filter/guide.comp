// Smooths each half over the same surface nearby, for comparing pixels later, and computes its remaining noise.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights, filter_surfaces;
layout(scalar) writeonly buffer FilterGuides { vec4 guides[]; };
#include "film/filter/window.glsl"

const int k_reach = 2;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Window window = window_at(pixel);
  vec3 even = vec3(0.0), odd = vec3(0.0);
  float weights = 0.0, variance = 0.0;
  FilterLight here = filter_light(texelFetch(filter_lights, int(pixel)));
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -k_reach; x <= k_reach; ++x) {
      ivec2 at = window.xy + ivec2(x, y);
      bool inside = window_has(at);
      int there = inside ? at.y * int(push.width) + at.x : int(pixel);
      FilterLight l = filter_light(texelFetch(filter_lights, there));
      float alike = filter_log_alike(window.surface, filter_surface(texelFetch(filter_surfaces, there)), vec2(x, y), window.slope);
      float w = inside ? exp2(alike - 0.5 * float(x * x + y * y)) : 0.0;
      even += w * l.even;
      odd += w * l.odd;
      variance += square(w * l.deviation);
      weights += w;
    }
  guides[pixel] = filter_texel(FilterLight(even / weights, odd / weights, sqrt(variance) / weights, here.in_both));
}
