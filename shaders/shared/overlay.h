// What is drawn over the picture: points, segments and the rims of discs in the scene, hidden by what is in front of them.
// Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_OVERLAY_H
#define LUCERNA_SHARED_OVERLAY_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// Where several cover a pixel the one of the highest rank is seen, of these the one that covers more of it, of these the
// first: points before segments before discs. Ranks: k_rank_low, or from k_rank_least to k_rank_most.
LUCERNA_CONST uint k_rank_low = 1u;   ///< below the edges of all others
LUCERNA_CONST uint k_rank_edge = 2u;  ///< dark, around what has an edge_width
LUCERNA_CONST uint k_rank_least = 3u;
LUCERNA_CONST uint k_rank_most = 7u;

// Of all three: `position` and the like are world space [m]; widths are in pixels, a few at most; `color` is encoded, 0..1,
// and laid over the picture with `alpha`, 0..1; `strength`, 0..1, lets a stroke fade with its edge, 0 leaves it out.

/// A dot.
struct OverlayPoint {
  vec3 position;
  float half_width;
  vec3 color;
  float alpha;
  float edge_width;  ///< beyond half_width; 0: none
  uint rank;
};

/// A line. What of it lies behind the eye is cut off.
struct OverlaySegment {
  vec3 from, to;
  float half_width;
  float edge_width;
  vec3 color;
  float alpha;
  float strength;
  float slack;  ///< so far behind what a pixel shows it is not hidden yet, besides half a percent of the depth [m]
  uint rank;
};

/// The rim of a disc, where it lies on surfaces that face as it does: elsewhere it would hang in the air. Those that are
/// seen narrow fade, so that many that lie close together do not become fog.
struct OverlayDisc {
  vec3 position;
  float radius;  ///< [m]
  vec3 normal;   ///< unit
  float half_width;
  vec3 color;
  float alpha;
  float edge_width;
  float strength;
  uint rank;
};
LUCERNA_CONST uint k_disc_pieces = 32u;  ///< straight ones that a rim is drawn in

// A mark is what a stroke leaves at a pixel: bits 29-31 a rank, bits 22-28 how much of the pixel it covers, below them the
// complement of its number, so that the greatest mark is what is to be seen, in any order.
LUCERNA_CONST uint k_mark_rank_shift = 29u;
LUCERNA_CONST uint k_mark_cover_shift = 22u;
LUCERNA_CONST uint k_mark_number = 0x3fffffu;
LUCERNA_CONST uint k_most_strokes = k_mark_number + 1u;  ///< in one drawing

struct OverlayMarkPush {
  uint width, height;
  uint count;   ///< of points, segments or discs
  uint first;   ///< number of the first of them in the drawing
  uint pieces;  ///< invocations that share one of them
};

struct OverlayLayPush {
  uint width, height;
  uint dimmed;       ///< not 0: the picture under the marks is dimmed
  float edge_alpha;  ///< of dark edges
};

/// A line over the picture, between places in pixels from its upper left corner; where a surface hides it it is faint.
struct OverlayLine {
  vec2 from, to;
  float from_depth, to_depth;  ///< along the view axis [m]
  float half_width;            ///< pixels
  float alpha;
  vec3 color;  ///< encoded, 0..1
};

/// Which light paths are drawn.
struct LightPathsView {
  uint step;     ///< 2^32 / paths
  uint light;    ///< entry of emission_alias whose paths alone are drawn; k_all_lights
  float radius;  ///< of the scene [m]
  uint pad0;
};
LUCERNA_CONST uint k_all_lights = 0xffffffffu;
LUCERNA_CONST uint k_drawn_events = 8u;  ///< of a path, straight on through panes with them

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::OverlayPoint) == 40 && sizeof(lucerna::shared::OverlaySegment) == 60 &&
              sizeof(lucerna::shared::OverlayDisc) == 60);
#endif
#endif
