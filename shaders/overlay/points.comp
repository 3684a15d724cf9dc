// Marks the pixels of points: one invocation a point.
#include "overlay/mark.glsl"
layout(scalar) readonly buffer OverlayPoints { OverlayPoint points[]; };

vec3 place;
float size;  // of a pixel there

bool shows(Seen seen, float t, float depth) {
  return !buried(seen, depth, 2.0 * size, dot(seen.position - place, seen.normal));
}

vec2 stroke_at(vec2 a, vec2 b, float t) { return a; }

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  OverlayPoint p = points[index];
  uint number = push.first + index;
  inks[number] = vec4(p.color, p.alpha);
  place = p.position;
  vec3 at = to_picture(place, push.width, push.height);
  size = pixel_size(at.z, push.height);
  draw_stroke(at, at, Stroke(p.half_width, p.edge_width, 1.0, p.rank, number), 0u, 1u);
}
