// Heat map over the picture: share of unblocked shadow rays at a pixel's surface. Where it is unknown or there is no surface,
// the picture is dimmed.
#include "lib/variants.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "lib/learned_lights.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/learned_view.h"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LearnedViewPush push; };
layout(scalar) readonly buffer RowArrivals { float row_arrivals[]; };
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Seen s = seen_at(pixel, push.width, push.height);
  uint row = learned_row(s.position, s.normal);
  float share = s.solid && row < push.rows ? row_arrivals[row] : -1.0;
  vec3 color = picture_color(picture[pixel]);
  vec3 dim = 0.35 * vec3(dot(color, vec3(0.2126, 0.7152, 0.0722)));
  picture[pixel] = picture_packed(mix(dim, ramp_color(k_ramp_viridis, share), share >= 0.0 ? 0.85 : 0.0));
}
