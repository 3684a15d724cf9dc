// What is shown of a picture until its samples are enough: layout and what the kernels are told. Read by C++ and GLSL.
//
// Of a pixel: k_preview_texels texels of sixteen half floats, component by component red, green, blue and the standard
// error of the luminance (below 0: not known), in units of what is shown white; and one texel of its surface: depth along the
// view axis [m] (0: nothing is there; below 0: not known, and where a draft has seen it about k_preview_about less
// this), bits packSnorm2x16(octahedral normal), bits packUnorm4x8(albedo, share of the samples that have met
// it or, where it is known to emit light, 0), samples – of what a ray has met: 0, or k_preview_beyond.
#ifndef LUCERNA_SHARED_PREVIEW_H
#define LUCERNA_SHARED_PREVIEW_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_preview_texels = 2u;
LUCERNA_CONST uint k_preview_none = 0xffffffffu;  ///< no pixel
LUCERNA_CONST float k_preview_about = -2.0f;
LUCERNA_CONST float k_preview_beyond = -1.0f;  ///< it is seen in a mirror or through glass
/// Bits of what a ray through a pixel has found (film/preview_look.comp).
LUCERNA_CONST uint k_sight_met = 1u, k_sight_beyond = 2u, k_sight_emits = 4u;
LUCERNA_CONST uint k_preview_step = 2u;  ///< pixels along the side of a cell of the grid that is filtered
LUCERNA_CONST uint k_preview_first_step = 4u;  ///< ... while there is a draft of a quarter of the resolution alone

// What is known of the surface of a pixel that has no sample.
LUCERNA_CONST uint k_preview_surface_unknown = 0u;
LUCERNA_CONST uint k_preview_surface_before = 1u;  ///< what was shown before
LUCERNA_CONST uint k_preview_surface_seen = 2u;    ///< what a ray has met

struct PreviewCamera {
  vec3 origin, right, up, forward;  ///< as Frame's
};

struct PreviewPackPush {
  uint width, height;
  float exposure;
  uint guided;  ///< not 0: where there are no samples the surface is known otherwise
  uint show;    ///< bit i: component i is part of what is shown
};

struct PreviewHalvePush {
  uint width, height;              ///< of the picture
  uint across, down;               ///< of the grid
  uint draft_width, draft_height;  ///< 0: none
  uint history;                    ///< 0: nothing was shown before
  uint repainted;                  ///< not 0: surfaces may have other colours than were shown before
  vec3 history_scale;              ///< of what was shown before
  float draft_share;               ///< of a draft's sample, what a cell of the grid gets: its area over the draft pixel's
  uint step;                       ///< pixels along the side of a cell
  uint sampled;                    ///< 0: the film has no sample yet
  uint surfaces;                   ///< k_preview_surface_*
  uint moved;                      ///< not 0: what was shown before was seen from elsewhere
};

struct PreviewFilterPush {
  uint across, down;
  uint step;             ///< between the cells that are weighed: in the first pass no less than a draft's pixel is wide
  uint orthographic;
  uint history;          ///< 0: nothing was shown before
  uint blocks_across, blocks_down;  ///< as PreviewResolvePush has them
  vec3 right, up, forward;
};

/// Cells along the side of a block that tells how much light has changed.
LUCERNA_CONST uint k_preview_change_step = 16u;
LUCERNA_CONST uint k_preview_change_texels = 5u;  ///< of its sums
struct PreviewChangePush {
  uint across, down;                 ///< of the grid
  uint blocks_across, blocks_down;
  uint all;                          ///< 0: each block's sums; not 0: from these all blocks' ratios
};

struct PreviewReprojectPush {
  uint width, height;
  uint pass;             ///< of preview_scatter.comp. 0: depths, 1: which pixel is the nearest
  uint orthographic;     ///< bit 0: before, bit 1: now
  PreviewCamera before, now;
};

struct PreviewRecallPush {
  uint width, height;
  uint pass;             ///< 0: cells, 1: those that are not known, 2: the picture
  uint show;             ///< bit i: component i is part of what is shown
  uint curve;
  vec3 history_scale;    ///< of what was shown before
};

struct PreviewResolvePush {
  uint width, height, across, down;
  uint show;             ///< bit i: component i is part of what is shown
  uint curve;
  uint filtering;        ///< 0: where there are samples they are shown as they are
  uint history;          ///< 0: there is none
  uint repainted;        ///< as PreviewHalvePush has it
  vec3 history_scale;    ///< of what was shown before
  uint step;             ///< pixels along the side of a cell of the grid
  uint sampled;          ///< 0: the film has no sample yet
  uint same_light;       ///< not 0: no light has changed since, only the camera or how it is computed
  uint recoloured;       ///< not 0: surfaces had other colours when what was shown before was shown
  uint blocks_across, blocks_down;  ///< that tell how much light has changed; 0: it has not
  uint surfaces;         ///< k_preview_surface_*
  uint moved;            ///< not 0: what was shown before was seen from elsewhere
};

LUCERNA_CONST uint k_preview_tile = 16u;  ///< pixels along the side of a tile of which errors are estimated
struct PreviewJudgePush {
  uint width, height;            ///< of the picture
  uint film_width, film_height;  ///< of the film whose new samples judge it
  uint step;                     ///< pixels along the side of one of the film's; 0: there are no new samples
};
/// A tile of what is shown. Errors are relative: of means over a few pixels, over their luminance or k_preview_dark.
struct PreviewTile {
  float error;   ///< expected of what is shown now: mean over its pixels
  float square;  ///< of what was shown before: square of the tile's mean error by samples taken since; below 0 by chance
  float noise;   ///< variance of the tile's mean of these samples, relative; below 0: there are none
};

/// Pixels darker than this, of white, err in proportion to it.
LUCERNA_CONST float k_preview_dark = 0.02f;
/// Sums over a workgroup's pixels, of luminance: all, and what of it is older light or filtered.
struct PreviewShares {
  float all, stale, filtered;
};

LUCERNA_SHARED_END
#endif
