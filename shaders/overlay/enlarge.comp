// Copies the film's picture to the sheet; each pixel becomes a square.
#include "lib/invocation.glsl"
#include "shaders/shared/sheet.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { EnlargePush push; };
layout(scalar) readonly buffer FilmPicture { uint film_picture[]; };
layout(scalar) writeonly buffer Picture { uint picture[]; };

void main() {
  uint index = global_index(), width = push.width * push.scale;
  if (index >= width * push.height * push.scale) return;
  uvec2 xy = uvec2(index % width, index / width) / push.scale;
  picture[index] = film_picture[xy.y * push.width + xy.x];
}
