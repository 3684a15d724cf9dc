// One lookup at every visible surface, as paths make it. For timing only.
#include "lib/invocation.glsl"
#include "irradiance_cache/lookup.glsl"
#include "overlay/lookup_place.glsl"
#include "shaders/shared/irradiance_cache/inspect.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlapPush push; };
layout(scalar) writeonly buffer LookedUp { float looked_up[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  LookupPlace a = lookup_place(pixel, push.width, push.grid, seen_at(pixel, push.width, push.height));
  Cached found = cache_lookup(a.position, a.normal, a.normal, 0u, a.answerable, 0.0);
  float light = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) light += luminance(found.part[p]);
  looked_up[pixel] = light;
}
