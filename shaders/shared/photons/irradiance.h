// Irradiance known beforehand, on pieces of surfaces (solvers/photons/irradiance_cells.h). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_IRRADIANCE_H
#define LUCERNA_SHARED_PHOTONS_IRRADIANCE_H
#include "shaders/shared/transport.h"
LUCERNA_SHARED_BEGIN

// Texels of a node: one, and where groups of lights are kept apart one more for each group. (irradiance, link), (irradiance by
// that group's light, 0). A triangle is cut in four at the middles of its edges, and so on; link: the first of the four nodes of
// the quarters, or
LUCERNA_CONST uint k_irradiance_none = 0u;   ///< there have been too few photons; this is node 0
LUCERNA_CONST uint k_irradiance_known = 1u;  ///< it is the same all over the piece
LUCERNA_CONST uint k_irradiance_first = 2u;  ///< least link to nodes
LUCERNA_CONST uint k_irradiance_depth = 14u; ///< most cuts

/// Of an eye path that looks it up: for these the light is kept that paths of frame.max_depth events bring.
LUCERNA_CONST uint k_irradiance_events = 1u;
LUCERNA_CONST uint k_irradiance_component = 2u;  ///< tertiary light
LUCERNA_CONST uint k_irradiance_whole = 65536u;   ///< 1 of what PhotonSurface::barycentric is in

/// Of a point in a triangle: where in which of its quarters it lies (x, y, quarter).
LUCERNA_INLINE uvec3 irradiance_quarter(uvec2 at) {
  const uint half_way = k_irradiance_whole / 2u, most = k_irradiance_whole - 1u;
  uvec3 q = at.x >= half_way            ? uvec3(at.x - half_way, at.y, 1u)
            : at.y >= half_way          ? uvec3(at.x, at.y - half_way, 2u)
            : at.x + at.y < half_way    ? uvec3(at.x, at.y, 0u)
                                        : uvec3(half_way - at.x, half_way - at.y, 3u);
  uint x = 2u * q.x, y = 2u * q.y;
  return uvec3(x < most ? x : most, y < most ? y : most, q.z);
}

/// What lookups read.
struct IrradianceFrame {
  uint triangles;  ///< 0: nothing is known
  uint states[2];  ///< bits: in these states of the eye path it is looked up
  uint gathers;    ///< 1: where nothing is known the photons with k_photon_unreachable are added up, which no path finds
};

LUCERNA_SHARED_END
#endif
