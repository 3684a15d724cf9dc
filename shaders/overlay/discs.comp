// Marks the pixels of discs' rims: one invocation for each segment of one.
#include "overlay/mark.glsl"
layout(scalar) readonly buffer OverlayDiscs { OverlayDisc discs[]; };

const float k_least_width = 4.0, k_full_width = 30.0;  // apparent width [pixels] at which a rim starts to show, and shows fully

vec3 from, to, normal;
float size, radius;  // of a pixel there; of the disc

bool shows(Seen seen, float t, float depth) {
  float below = dot(seen.position - mix(from, to, t), seen.normal);
  bool on = seen.solid && abs(below) < 2.0 * seen.size + 0.1 * radius && dot(seen.normal, normal) > 0.7;
  return on && !buried(seen, depth, 2.0 * size, below);
}

vec2 stroke_at(vec2 a, vec2 b, float t) { return a + t * (b - a); }

void main() {
  uint index = global_index() / push.pieces, piece = global_index() % push.pieces;
  if (index >= push.count) return;
  OverlayDisc d = discs[index];
  uint number = push.first + index;
  if (piece == 0u) inks[number] = vec4(d.color, d.alpha);
  normal = d.normal;
  radius = d.radius;
  vec3 tangent, bitangent;
  make_basis(normal, tangent, bitangent);
  float step = 2.0 * k_pi / float(push.pieces), angle = step * float(piece);
  from = d.position + radius * (cos(angle) * tangent + sin(angle) * bitangent);
  to = d.position + radius * (cos(angle + step) * tangent + sin(angle + step) * bitangent);
  vec3 a = to_picture(from, push.width, push.height), b = to_picture(to, push.width, push.height);
  size = pixel_size(a.z, push.height);
  // Narrow discs fade: on surfaces seen at a grazing angle many lie one behind the other.
  vec3 away = camera_towards(d.position);
  float wide = radius / size * abs(dot(normal, away));
  float strength = clamp((wide - k_least_width) / (k_full_width - k_least_width), 0.0, 1.0);
  draw_stroke(a, b, Stroke(d.half_width, d.edge_width, strength * d.strength, d.rank, number), 0u, 1u);
}
