// The preview of a picture until it has enough samples: data layout and kernel parameters. Read by C++ and GLSL.
//
// For each pixel: k_preview_texels texels of sixteen half floats, by component red, green, blue and the standard error of the
// luminance (negative: unknown), in units of display white; and one texel of its surface: depth along the view axis [m] (0: no
// surface; negative: unknown, or, if known from a preview sample, k_preview_about minus the approximate depth), bits
// packSnorm2x16(octahedral normal), bits packUnorm4x8(albedo, share of the samples that hit it, or 0 if it is known to emit
// light), number of samples, or for a ray's hit: k_preview_beyond or k_preview_direct.
#ifndef LUCERNA_SHARED_PREVIEW_H
#define LUCERNA_SHARED_PREVIEW_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_preview_texels = 2u;
LUCERNA_CONST uint k_preview_none = 0xffffffffu;  ///< no pixel
LUCERNA_CONST float k_preview_about = -2.0f;
LUCERNA_CONST float k_preview_beyond = -1.0f;  ///< surface seen in a mirror or through glass
/// ... seen directly: k_preview_direct minus half of SightStep::mirrors.
LUCERNA_CONST float k_preview_direct = -0.25f;
/// Result of a ray through a pixel, as bits (film/preview_look.comp).
LUCERNA_CONST uint k_sight_met = 1u, k_sight_beyond = 2u, k_sight_emits = 4u;
LUCERNA_CONST float k_sight_mirrors = 0.5f;  ///< times SightStep::mirrors, added to these
LUCERNA_CONST uint k_preview_step = 2u;  ///< pixels along the side of a cell of the filtered grid
LUCERNA_CONST uint k_preview_first_step = 4u;  ///< ... with only a preview sample of a quarter of the resolution

// Source of the surface of a pixel without samples.
LUCERNA_CONST uint k_preview_surface_unknown = 0u;
LUCERNA_CONST uint k_preview_surface_before = 1u;  ///< the previous picture
LUCERNA_CONST uint k_preview_surface_seen = 2u;    ///< a traced ray

struct PreviewCamera {
  vec3 origin, right, up, forward;  ///< as Frame's; forward to the middle of the picture
};

struct PreviewPackPush {
  uint width, height;
  float exposure;
  uint guided;  ///< not 0: surfaces of pixels without samples are known from the guide
  uint show;    ///< bit i: component i is shown
  float noise;  ///< factor on the standard errors that the halves of the samples give
  uint taken;   ///< not 0: the result is a previous picture
};

struct PreviewHalvePush {
  uint width, height;              ///< of the picture
  uint across, down;               ///< of the grid
  uint draft_width, draft_height;  ///< 0: none
  uint history;                    ///< 0: there is no previous picture
  uint repainted;                  ///< not 0: surfaces may have other colours than in the previous picture
  vec3 history_scale;              ///< factor on the previous picture
  float draft_share;               ///< of a preview sample per cell of the grid: the cell's area over its pixel's
  uint step;                       ///< pixels along the side of a cell
  uint sampled;                    ///< 0: the film has no sample yet
  uint surfaces;                   ///< k_preview_surface_*
  uint moved;                      ///< not 0: the camera has moved since the previous picture
};

struct PreviewFilterPush {
  uint across, down;
  uint step;             ///< between the weighted cells; in the first pass at least the width of a preview sample's pixel
  uint projection;       ///< k_projection_*
  uint history;          ///< 0: there is no previous picture
  uint blocks_across, blocks_down;  ///< as in PreviewResolvePush
  vec3 right, up, forward;
};

/// Cells along the side of a block that measures the change of light.
LUCERNA_CONST uint k_preview_change_step = 16u;
LUCERNA_CONST uint k_preview_change_texels = 5u;  ///< texels of a block's sums
struct PreviewChangePush {
  uint across, down;                 ///< of the grid
  uint blocks_across, blocks_down;
  uint all;                          ///< 0: sums of each block; not 0: ratios of all blocks from the sums
};

struct PreviewReprojectPush {
  uint width, height;
  uint pass;             ///< of preview_scatter.comp. 0: depths, 1: nearest pixel
  uint projections;      ///< bits 0-3: k_projection_* before, bits 4-7: now
  PreviewCamera before, now;
};

struct PreviewFetchPush {
  uint width, height;    ///< of the previous picture
  uint across, down;     ///< of the surfaces
  uint projections;      ///< as in PreviewReprojectPush
  uint keep;             ///< not 0: surfaces without known light stay known
  PreviewCamera before, now;
};

struct PreviewRecallPush {
  uint width, height;    ///< of the recalled pixels
  uint pass;             ///< 0: known cells, 1: unknown cells, 2: the pixels, 3: the picture from pixels of another size
  uint show;             ///< bit i: component i is shown
  uint curve;
  vec3 history_scale;    ///< factor on the previous picture
  uint seen;             ///< not 0: all surfaces are known, and unknown light is found over their colours
  uint across, down;     ///< of the picture
  uint tint;             ///< not 0: tints the picture as light from before the last edit
};

struct PreviewResolvePush {
  uint width, height, across, down;
  uint show;             ///< bit i: component i is shown
  uint curve;
  uint filtering;        ///< 0: pixels with samples are shown unfiltered
  uint history;          ///< 0: there is no previous picture
  uint repainted;        ///< as in PreviewHalvePush
  vec3 history_scale;    ///< factor on the previous picture
  uint step;             ///< pixels along the side of a cell of the grid
  uint sampled;          ///< 0: the film has no sample yet
  uint same_light;       ///< not 0: no light has changed since, only the camera or the solver
  uint recoloured;       ///< not 0: surfaces had other colours in the previous picture
  uint blocks_across, blocks_down;  ///< blocks that measure the change of light; 0: it has not changed
  uint surfaces;         ///< k_preview_surface_*
  uint moved;            ///< not 0: the camera has moved since the previous picture
  uint tint;             ///< not 0: tints light from before the last edit
  float doubt;           ///< expected change of the previous picture's light by the edit, relative
};

/// Colour of light from before the last edit, sRGB.
LUCERNA_CONST vec3 k_preview_former_tint = vec3(0.36f, 0.55f, 1.0f);

LUCERNA_CONST uint k_preview_tile = 16u;  ///< pixels along the side of a tile for error estimates
struct PreviewJudgePush {
  uint width, height;            ///< of the picture
  uint film_width, film_height;  ///< of the film whose new samples measure the error
  uint step;                     ///< picture pixels along the side of a film pixel; 0: there are no new samples
};
/// A tile of the shown picture. Errors are relative: of means over a few pixels, over their luminance or k_preview_dark.
struct PreviewTile {
  float error;   ///< expected error now: mean over its pixels
  float square;  ///< previous picture: squared mean error of the tile, measured by samples taken since; may be below 0 by chance
  float noise;   ///< relative variance of the tile's mean of these samples; below 0: there are none
};

/// Maximum factor on light from before an edit. A darker picture is no picture of the new light: its noise was not filtered,
/// as too dark to be seen.
LUCERNA_CONST float k_preview_most_growth = 16.0f;

/// Minimum luminance, of white, by which errors are divided.
LUCERNA_CONST float k_preview_dark = 0.02f;
/// Sums of luminance over a workgroup's pixels: all, older light, filtered light.
struct PreviewShares {
  float all, stale, filtered;
};

LUCERNA_SHARED_END
#endif
