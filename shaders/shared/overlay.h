// Strokes drawn over the picture: points, segments and the rims of discs in the scene, hidden by surfaces in front of them.
// Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_OVERLAY_H
#define LUCERNA_SHARED_OVERLAY_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// If several strokes cover a pixel, the highest rank is visible; among equal ranks the larger coverage; among equal coverage
// the first: points before segments before discs. Ranks: k_rank_low, or k_rank_least to k_rank_most.
LUCERNA_CONST uint k_rank_low = 1u;   ///< below the edges of all others
LUCERNA_CONST uint k_rank_edge = 2u;  ///< dark edge of strokes with an edge_width
LUCERNA_CONST uint k_rank_least = 3u;
LUCERNA_CONST uint k_rank_most = 7u;

// All three: positions in world space [m]; widths in pixels, a few at most; `color` encoded, 0..1, blended over the picture
// with `alpha`, 0..1; `strength`, 0..1, fades a stroke with its edge, 0 omits it.

/// A dot.
struct OverlayPoint {
  vec3 position;
  float half_width;
  vec3 color;
  float alpha;
  float edge_width;  ///< beyond half_width; 0: none
  uint rank;
};

/// A line. The part behind the eye is cut off.
struct OverlaySegment {
  vec3 from, to;
  float half_width;
  float edge_width;
  vec3 color;
  float alpha;
  float strength;
  float slack;  ///< distance behind a pixel's surface at which it is still visible, plus 0.5 % of the depth [m]
  uint rank;
};

/// The rim of a disc, where it lies on surfaces of similar orientation; elsewhere it would hang in the air. Discs seen at a
/// grazing angle fade, so that many close together do not become fog.
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
LUCERNA_CONST uint k_disc_pieces = 32u;  ///< straight pieces of a rim

// The mark of a stroke at a pixel: bits 29-31 its rank, bits 22-28 its coverage of the pixel, below them the complement of
// its number. The greatest mark is visible, in any order of drawing.
LUCERNA_CONST uint k_mark_rank_shift = 29u;
LUCERNA_CONST uint k_mark_cover_shift = 22u;
LUCERNA_CONST uint k_mark_number = 0x3fffffu;
LUCERNA_CONST uint k_most_strokes = k_mark_number + 1u;  ///< maximum in one drawing

struct OverlayMarkPush {
  uint width, height;
  uint count;   ///< of points, segments or discs
  uint first;   ///< number of the first one in the drawing
  uint pieces;  ///< invocations per stroke
};

struct OverlayLayPush {
  uint width, height;
  uint dimmed;       ///< not 0: the picture under the marks is dimmed
  float edge_alpha;  ///< of dark edges
};

/// Depth of field over the picture (overlay/focus.comp). Depths along the view axis [m], colours encoded.
struct OverlayFocusPush {
  uint width, height;
  float focus;              ///< of the plane of focus
  float nearest, farthest;  ///< between which surfaces are sharp
  vec3 line, tint;          ///< of the plane of focus, and of what is sharp
};

/// A line over the picture, between positions in pixels from its upper left corner; faint where a surface hides it.
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
  uint light;    ///< entry of emission_alias whose paths are drawn; k_all_lights: all
  float radius;  ///< of the scene [m]
  uint pad0;
};
LUCERNA_CONST uint k_all_lights = 0xffffffffu;
LUCERNA_CONST uint k_drawn_events = 8u;  ///< maximum per path, including undeflected passages through panes

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::OverlayPoint) == 40 && sizeof(lucerna::shared::OverlaySegment) == 60 &&
              sizeof(lucerna::shared::OverlayDisc) == 60);
#endif
#endif
