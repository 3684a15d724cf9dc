// Estimates the noise of a half from the difference of the halves around each pixel.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_noisy, filter_surfaces;
layout(scalar) writeonly buffer FilterMeasured { vec4 measured[]; };
#include "film/filter/window.glsl"

const int k_reach = 2;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Window window = window_at(pixel);
  FilterLight here = filter_light(texelFetch(filter_noisy, int(pixel)));
  float sum = 0.0, weights = 0.0;
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -window_row(k_reach, y); x <= window_row(k_reach, y); ++x) {
      ivec2 step = int(push.stride) * ivec2(x, y), at = window.xy + step;
      bool inside = window_has(at);
      int there = inside ? at.y * int(push.width) + at.x : int(pixel);
      FilterLight l = filter_light(texelFetch(filter_noisy, there));
      FilterSurface s = filter_surface(texelFetch(filter_surfaces, there));
      vec3 d = l.even - l.odd;
      float alike = filter_log_alike(window.surface, s, vec2(step), window.slope);
      float w = inside ? exp2(alike - 0.08 * float(x * x + y * y)) : 0.0;
      sum += w * dot(d, d);
      weights += w;
    }
  vec3 own = here.even - here.odd;
  // The noise of an outlier exceeds that of its surroundings.
  here.deviation = sqrt(0.5 * max(sum / weights, dot(own, own)));
  measured[pixel] = filter_texel(here);
}
