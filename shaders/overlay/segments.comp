// Marks the pixels of segments: push.pieces invocations per segment, each for a part of its length.
#include "overlay/mark.glsl"
layout(scalar) readonly buffer OverlaySegments { OverlaySegment segments[]; };

const float k_near = 1e-3;  // clip depth over the depth of the farther end

float slack;

bool shows(Seen seen, float t, float depth) { return !behind(seen, depth, slack); }

vec2 stroke_at(vec2 a, vec2 b, float t) { return mix(a, b, t); }

void main() {
  uint index = global_index() / push.pieces, piece = global_index() % push.pieces;
  if (index >= push.count) return;
  OverlaySegment s = segments[index];
  uint number = push.first + index;
  if (piece == 0u) inks[number] = vec4(s.color, s.alpha);
  slack = s.slack;
  if (is_wide(frame.projection)) {
    // A line is bent there: each invocation draws its part of the length straight.
    vec2 part = vec2(piece, piece + 1u) / float(push.pieces);
    vec3 a = to_picture(mix(s.from, s.to, part.x), push.width, push.height),
         b = to_picture(mix(s.from, s.to, part.y), push.width, push.height);
    bool seam = abs(a.x - b.x) > 0.5 * float(push.width);  // of a panorama
    if (!seam) draw_stroke(a, b, Stroke(s.half_width, s.edge_width, s.strength, s.rank, number), 0u, 1u);
    return;
  }
  float from = dot(s.from - frame.camera_origin, frame.camera_axis);
  float to = dot(s.to - frame.camera_origin, frame.camera_axis), near = k_near * max(from, to);
  vec3 a = from < near ? mix(s.from, s.to, (near - from) / (to - from)) : s.from;
  vec3 b = to < near ? mix(s.to, s.from, (near - to) / (from - to)) : s.to;
  draw_stroke(to_picture(a, push.width, push.height), to_picture(b, push.width, push.height),
              Stroke(s.half_width, s.edge_width, s.strength, s.rank, number), piece, push.pieces);
}
