// Draws the state of the tiles over the picture: those at work outlined and tinted by how far their error is from the
// target, done ones dimmed, those given up hatched, heavy-tailed ones with a marked corner.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TilesPush push; };
layout(scalar) buffer Picture { uint picture[]; };
layout(scalar) readonly buffer TileMarks { TileMark marks[]; };

bool at_work(uint bits) { return (bits & k_tile_state) <= k_tile_active; }

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uvec2 xy = uvec2(pixel % push.width, pixel / push.width), at = xy / push.side;
  uint tile = at.y * push.across + at.x;
  TileMark mark = marks[tile];
  uint state = mark.bits & k_tile_state;
  vec3 color = picture_color(picture[pixel]);
  // The last column and row of tiles may be cut off by the picture's edge.
  uvec2 from = xy - at * push.side, last = min((at + 1u) * push.side, uvec2(push.width, push.height)) - 1u, to = last - xy;
  bool known = mark.position >= 0.0;
  vec3 ink = known ? ramp_color(k_ramp_tiles, mark.position) : vec3(0.62);
  if (at_work(mark.bits)) {
    // Before the minimum of samples an error decides nothing: it is shown, but not in full strength.
    float strength = !known ? 0.25 : state == k_tile_waiting ? 0.55 : 0.85;
    color = mix(color, ink, known ? 0.25 * strength : 0.0);
    // Active neighbours share a line: each tile draws its left and upper line, and the others next to inactive tiles.
    bool right = to.x < push.line && (at.x + 1u == push.across || !at_work(marks[tile + 1u].bits));
    bool below = to.y < push.line && (last.y + 1u == push.height || !at_work(marks[tile + push.across].bits));
    bool line = from.x < push.line || from.y < push.line || right || below;
    if (line) color = mix(color, ink, strength);
  } else {
    float y = dot(color, vec3(0.2126, 0.7152, 0.0722));
    color = mix(color, vec3(y), 0.4) * 0.42;
    if (state == k_tile_capped && (xy.x + xy.y) % 6u < 1u + push.line / 2u) color = mix(color, ink, 0.8);
  }
  if ((mark.bits & k_tile_heavy) != 0u) {
    uint reach = push.side * 4u / 16u + push.line, diagonal = to.x + from.y;
    if (diagonal <= reach) color = diagonal == reach ? vec3(0.05) : vec3(at_work(mark.bits) ? 0.93 : 0.5);
  }
  picture[pixel] = picture_packed(color);
}
