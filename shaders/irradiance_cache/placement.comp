// Marks the pixels that places of records go over while they are being chosen: a dot each, and a ring in its plane as wide
// as its record would be. Hidden by what is in front. One invocation a dot or a segment of a ring; where several cross, the
// greatest mark stays, whoever came first. placement_draw.comp lays the marks over the picture.
#include "lib/invocation.glsl"
#include "irradiance_cache/seen.glsl"
#include "shaders/shared/cache_placement.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacementPush push; };
layout(scalar) readonly buffer Places { PlacedPoint places[]; };
layout(scalar) buffer Marks { uint marks[]; };

// Pixels. Rings of small discs, which lie close together, fade out, so that the structure stays readable.
const float k_rejected_dot = 0.6, k_tried_dot = 0.75, k_edge = 0.7, k_half_ring = 0.4;  // dots: of push.tried_dot
const float k_least_ring = 4.0, k_full_ring = 30.0, k_faint = 0.35;
const int k_most_cells = 16384;  // of the pixels that one invocation looks at; lavapipe ends long loops

void mark(uint pixel, uint rank, float cover, uint point) {
  uint share = uint(clamp(cover, 0.0, 1.0) * 127.0 + 0.5);
  if (share > 0u) atomicMax(marks[pixel], rank << k_mark_rank_shift | share << k_mark_cover_shift | (k_mark_point - point));
}

void main() {
  uint each = max(push.segments, 1u), index = global_index(), point = index / each;
  if (point >= push.count) return;
  PlacedPoint place = places[point];
  uint kind = place.bits & k_placed_mask;
  bool ring = push.segments > 0u;
  float radius = ring ? place.radius : 0.0;
  vec3 from = place.position, to = place.position;
  if (ring) {
    vec3 tangent, bitangent;
    make_basis(place.normal, tangent, bitangent);
    float step = 2.0 * k_pi / float(push.segments), angle = step * float(index % each);
    from += radius * (cos(angle) * tangent + sin(angle) * bitangent);
    to += radius * (cos(angle + step) * tangent + sin(angle + step) * bitangent);
  }
  vec3 a = to_picture(from, push.width, push.height), b = to_picture(to, push.width, push.height);
  vec2 film = vec2(push.width, push.height);
  float size = 2.0 * length(frame.camera_up) / film.y * (frame.orthographic != 0u ? 1.0 : a.z);
  // By how wide the ring is seen: many lie one behind the other on surfaces seen at a grazing angle.
  vec3 away = frame.orthographic != 0u ? frame.camera_forward : normalize(place.position - frame.camera_origin);
  float wide = radius / size * abs(dot(place.normal, away));
  float strength = ring ? clamp((wide - k_least_ring) / (k_full_ring - k_least_ring), 0.0, 1.0) : 1.0;
  bool chosen = kind == k_placed_chosen, plain = kind == k_placed_candidate;
  uint rank = chosen                      ? k_rank_chosen
              : kind == k_placed_tried    ? k_rank_tried
              : kind == k_placed_rejected ? k_rank_rejected
                                          : k_rank_candidate;
  float half_width = push.tried_dot * (chosen ? 1.0 : kind == k_placed_tried ? k_tried_dot : k_rejected_dot);
  if (plain) half_width = push.dot;
  if (ring) {
    rank = chosen ? k_rank_ring : k_rank_faint_ring;
    half_width = k_half_ring;
    strength *= chosen ? 1.0 : k_faint;
  }
  float edge_width = chosen || kind == k_placed_tried && !ring ? k_edge : 0.0;
  float reach = half_width + edge_width + 1.0;
  bool shown = a.z > 0.0 && b.z > 0.0 && strength > 0.0 && all(greaterThan(max(a.xy, b.xy), vec2(-reach))) &&
               all(lessThan(min(a.xy, b.xy), film + reach));
  vec2 along = b.xy - a.xy;
  ivec2 lo = max(ivec2(floor(min(a.xy, b.xy) - reach)), ivec2(0));
  ivec2 hi = min(ivec2(floor(max(a.xy, b.xy) + reach)), ivec2(film) - 1);
  int across = hi.x - lo.x + 1, cells = shown && across > 0 ? across * (hi.y - lo.y + 1) : 0;
  cells = cells <= k_most_cells ? cells : 0;
  for (int i = 0; i < cells; ++i) {
    ivec2 xy = lo + ivec2(i % across, i / across);
    vec2 here = vec2(xy) + 0.5;
    float t = clamp(dot(here - a.xy, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = distance(here, a.xy + t * along);
    float core = clamp(half_width + 0.5 - away, 0.0, 1.0), edge = clamp(half_width + edge_width + 0.5 - away, 0.0, 1.0);
    if (edge <= 0.0) continue;
    uint pixel = uint(xy.y) * push.width + uint(xy.x);
    Seen seen = seen_at(pixel, push.width, push.height);
    // Hidden is what lies both behind the surface that the pixel shows and below its plane: depth alone would hide what
    // lies on a surface seen at a grazing angle, where it changes much within a pixel.
    float below = dot(seen.position - mix(from, to, t), seen.normal);
    if (seen.solid && depth_between(a.z, b.z, t) > 1.005 * seen.depth + 2.0 * size && below > 1.2 * seen.size) continue;
    // Rings lie on surfaces that face as their places do, as discs of records; elsewhere they would hang in the air.
    bool on = seen.solid && abs(below) < 2.0 * seen.size + 0.1 * radius && dot(seen.normal, place.normal) > 0.7;
    if (ring && !on) continue;
    bool drawn = core > 0.2 || edge_width == 0.0;
    mark(pixel, drawn ? rank : k_rank_edge, strength * (drawn ? core : edge), point);
  }
}
