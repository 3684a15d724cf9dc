// Sky portals: rectangles through which the sky is sampled. Read by C++ and GLSL.
//
// B. Bitterli, J. Novak and W. Jarosz, "Portal-masked environment map sampling" (EGSR 2015): for each portal the sky is
// rectified, so that axis-parallel rectangles in the portal's plane, seen from any point, are axis-parallel rectangles of the
// map; a summed-area table then samples the sky's brightness within what is seen through the portal.
//
// With X and Y the coordinates of a direction, over its height above the portal's plane, along the portal's sides, the map's
// coordinate is m = X / (1 + |X|), -1 ... 1, and likewise for Y. Any monotone function of each would serve; unlike the angles
// of the paper, this one has an exact inverse. Solid angle over area in (m_x, m_y): (a + |x|)^2 (a + |y|)^2 / a for the unit
// direction (x, y, a).
//
// Texel buffers (RGBA32F; integers as bit patterns):
// scene_portals: k_portal_texels a portal: (centre, half width) (unit vector along the width, half height) (unit vector along
// the height, probability among the portals). The cross product of the vectors points towards the room, where points are lit.
// portal_sums: for each portal (k_portal_side + 1)^2 words, four a texel, padded to k_portal_words: the sum of the weights of
// all texels of its map with smaller column and row. Weights are integers, so that differences of sums are exact.
#ifndef LUCERNA_SHARED_PORTALS_H
#define LUCERNA_SHARED_PORTALS_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_portal_texels = 3u;
LUCERNA_CONST uint k_portal_side = 256u;     ///< texels of a map along a side
LUCERNA_CONST uint k_portal_words = 66052u;  ///< a multiple of four
/// Share of the sky's light samples that portals have without learning. The others are taken from the whole sky, so that
/// openings without a portal are found.
LUCERNA_CONST float k_portal_share = 0.5f;

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(lucerna::shared::k_portal_words >=
              (lucerna::shared::k_portal_side + 1) * (lucerna::shared::k_portal_side + 1));
#endif
#endif
