// Draws the density view over the picture as a heat map; dims pixels without a value.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/photons/inspect.h"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonHeatPush push; };
layout(scalar) readonly buffer PhotonDensities { float densities[]; };
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uvec2 below = uvec2(pixel % push.width, pixel / push.width) / push.scale;
  float value = densities[below.y * (push.width / push.scale) + below.x];
  vec3 color = picture_color(picture[pixel]);
  vec3 dim = 0.35 * vec3(dot(color, vec3(0.2126, 0.7152, 0.0722)));
  vec3 ink = mix(dim, ramp_color(k_ramp_magma, mix(0.08, 1.0, ramp_position(value, push.lo, push.hi, 1u))), value > push.lo ? 0.85 : 0.0);
  picture[pixel] = picture_packed(ink);
}
