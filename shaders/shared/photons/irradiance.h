// Precomputed irradiance of surface cells (solvers/photons/irradiance_cells.h). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_IRRADIANCE_H
#define LUCERNA_SHARED_PHOTONS_IRRADIANCE_H
#include "shaders/shared/transport.h"
LUCERNA_SHARED_BEGIN

// Texels of a node: one, and where light groups are separate one more for each group. (irradiance, link), (irradiance by
// that group's light, 0). A triangle is cut in four at the middles of its edges, and so on; link: the first of the four nodes of
// the quarters, or
LUCERNA_CONST uint k_irradiance_none = 0u;   ///< too few photons; node 0
LUCERNA_CONST uint k_irradiance_known = 1u;  ///< constant over the cell
LUCERNA_CONST uint k_irradiance_first = 2u;  ///< first link to nodes
LUCERNA_CONST uint k_irradiance_depth = 14u; ///< maximum number of splits

/// Events of the eye path before the lookup, for the length limit of stored light: paths have at most frame.max_depth
/// events.
LUCERNA_CONST uint k_irradiance_events = 1u;
LUCERNA_CONST uint k_irradiance_component = 2u;  ///< tertiary light
LUCERNA_CONST uint k_irradiance_whole = 65536u;   ///< 1 of what PhotonSurface::barycentric is in

/// Position within the quarter of a triangle that contains a point (x, y, quarter).
LUCERNA_INLINE uvec3 irradiance_quarter(uvec2 at) {
  const uint half_way = k_irradiance_whole / 2u, most = k_irradiance_whole - 1u;
  uvec3 q = at.x >= half_way            ? uvec3(at.x - half_way, at.y, 1u)
            : at.y >= half_way          ? uvec3(at.x, at.y - half_way, 2u)
            : at.x + at.y < half_way    ? uvec3(at.x, at.y, 0u)
                                        : uvec3(half_way - at.x, half_way - at.y, 3u);
  uint x = 2u * q.x, y = 2u * q.y;
  return uvec3(x < most ? x : most, y < most ? y : most, q.z);
}

/// Parameters of lookups.
struct IrradianceFrame {
  uint triangles;  ///< 0: there is no map
  uint states[2];  ///< bits: states of the eye path that read it
  uint gathers;    ///< 1: without data, photons with k_photon_unreachable are summed, whose light no path finds
};

LUCERNA_SHARED_END
#endif
