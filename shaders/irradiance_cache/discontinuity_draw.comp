// Draws one level of the detail pyramid over the picture, where candidates are possible. Dims surfaces that are not diffuse
// or whose normal map is too steep for records.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/irradiance_cache/discontinuity.h"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { DiscontinuityDrawPush push; };
uniform samplerBuffer surface_texels;
layout(scalar) readonly buffer Details { float details[]; };
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uvec2 xy = uvec2(pixel % push.width, pixel / push.width) / push.stride;
  bool diffuse = texelFetch(surface_texels, int((xy.y * push.across + xy.x) * k_surface_texels)).w >= 0.0;
  uint cells = (push.across + (1u << push.level) - 1u) >> push.level;
  uvec2 cell = xy >> push.level;
  float detail = details[push.first + cell.y * cells + cell.x];
  vec3 color = picture_color(picture[pixel]);
  color = diffuse ? mix(color, ramp_color(k_ramp_magma, detail), 0.88) : 0.25 * color;
  picture[pixel] = picture_packed(color);
}
