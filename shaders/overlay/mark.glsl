// Strokes mark the pixels they cover; lay.comp draws the marks over the picture (shaders/shared/overlay.h). The including
// file defines shows(), the visibility of a stroke, and stroke_at(), the position of a part of it.
#ifndef LUCERNA_OVERLAY_MARK
#define LUCERNA_OVERLAY_MARK
#include "lib/invocation.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/overlay.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayMarkPush push; };
layout(scalar) buffer OverlayMarks { uint marks[]; };
layout(scalar) writeonly buffer OverlayInks { vec4 inks[]; };  // color, alpha of all strokes

struct Stroke {
  float half_width, edge_width, strength;
  uint rank, number;
};

// Whether the part of the stroke at parameter t (0..1), at that depth, is visible in a pixel that shows the surface `seen`.
bool shows(Seen seen, float t, float depth);
// Its position in the picture, between the ends a and b.
vec2 stroke_at(vec2 a, vec2 b, float t);

const float k_most_away = 1e7;  // pixels; farther strokes are not drawn (out of the range of int)

void draw_mark(uint pixel, uint rank, float cover, uint number) {
  uint share = uint(clamp(cover, 0.0, 1.0) * 127.0 + 0.5);
  if (share > 0u) atomicMax(marks[pixel], rank << k_mark_rank_shift | share << k_mark_cover_shift | (k_mark_number - number));
}

// Marks part `piece` of `pieces` of the stroke from a to b, both from to_picture(). Iterates along the longer axis over the few
// pixels near the line on the other, so that the cost is proportional to the length.
void draw_stroke(vec3 a, vec3 b, Stroke s, uint piece, uint pieces) {
  bool there = a.z > 0.0 && b.z > 0.0 && s.strength > 0.0 && all(lessThan(abs(vec4(a.xy, b.xy)), vec4(k_most_away)));
  if (!there) return;
  vec2 along = b.xy - a.xy;
  bool upright = abs(along.y) > abs(along.x);
  vec2 from = upright ? a.yx : a.xy, to = upright ? b.yx : b.xy;
  ivec2 room = upright ? ivec2(push.height, push.width) : ivec2(push.width, push.height);
  float slope = from.x != to.x ? (to.y - from.y) / (to.x - from.x) : 0.0;
  float reach = s.half_width + s.edge_width + 1.0;
  int beside = int(ceil(reach * sqrt(1.0 + slope * slope))), across = 2 * beside + 1;
  float lo = min(from.x, to.x), hi = max(from.x, to.x);
  int first = int(floor(max(lo - reach, 0.0))), last = int(floor(min(hi + reach, float(room.x - 1))));
  int each = (max(last - first + 1, 0) + int(pieces) - 1) / int(pieces);
  first += int(piece) * each;
  int cells = max(min(each, last - first + 1), 0) * across;
  for (int i = 0; i < cells; ++i) {
    int x = first + i / across;
    int y = int(floor(from.y + slope * (clamp(float(x) + 0.5, lo, hi) - from.x))) - beside + i % across;
    if (y < 0 || y >= room.y) continue;
    uvec2 xy = uvec2(upright ? ivec2(y, x) : ivec2(x, y));
    vec2 here = vec2(xy) + 0.5;
    float t = clamp(dot(here - a.xy, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = distance(here, stroke_at(a.xy, b.xy, t));
    float core = clamp(s.half_width + 0.5 - away, 0.0, 1.0);
    float edge = clamp(s.half_width + s.edge_width + 0.5 - away, 0.0, 1.0);
    if (edge <= 0.0) continue;
    uint pixel = xy.y * push.width + xy.x;
    if (!shows(seen_at(pixel, push.width, push.height), t, depth_between(a.z, b.z, t))) continue;
    // A stroke covers all edges, and strokes of equal rank with a smaller coverage.
    bool drawn = core > 0.2 || s.edge_width == 0.0;
    draw_mark(pixel, drawn ? s.rank : k_rank_edge, s.strength * (drawn ? core : edge), s.number);
  }
}

// Whether a depth is behind the pixel's surface by more than `slack` and 0.5 % of the depth.
bool behind(Seen seen, float depth, float slack) { return seen.solid && depth > 1.005 * seen.depth + slack; }

// Likewise, for points that may lie on a surface. At grazing angles depth varies much within a pixel, so the point must also be
// below the surface's plane, by the distance `below`.
bool buried(Seen seen, float depth, float slack, float below) {
  return behind(seen, depth, slack) && below > 1.2 * seen.size;
}
#endif
