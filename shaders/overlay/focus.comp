// Depth of field over the picture: surfaces that the camera shows sharp are tinted, with a line where they cross the plane of
// focus; others are dimmed.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/overlay.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayFocusPush push; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_half_line = 0.8;  // pixels
const float k_dim = 0.55, k_tint = 0.45;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Seen s = seen_at(pixel, push.width, push.height);
  vec3 color = picture_color(picture[pixel]);
  float grey = dot(color, vec3(0.2126, 0.7152, 0.0722));
  bool sharp = s.solid && s.depth >= push.nearest && s.depth <= push.farthest;
  color = sharp ? mix(color, push.tint * mix(0.25, 1.0, grey), k_tint) : k_dim * color;
  if (s.solid) {
    mat2x3 steps = pixel_steps(s, push.width, push.height);
    float change = length(frame.camera_axis * steps);  // of the depth in a pixel
    float away = abs(s.depth - push.focus) / max(change, 1e-20);
    color = mix(color, push.line, clamp(k_half_line + 0.5 - away, 0.0, 1.0));
  }
  picture[pixel] = picture_packed(color);
}
