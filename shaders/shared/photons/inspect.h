// Display of photons around visible surfaces. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_INSPECT_H
#define LUCERNA_SHARED_PHOTONS_INSPECT_H
#include "shaders/shared/compat.h"
#include "shaders/shared/sight.h"
LUCERNA_SHARED_BEGIN

/// One float a pixel, and their maximum.
struct PhotonDensityPush {
  uint width, height;
  uint of;          ///< k_density_of_*, k_photons_in_disc
  uint first, count;  ///< pixels, in raster order
  SightGrid grid;   ///< of surfaces seen through glass and in mirrors
};
LUCERNA_CONST uint k_density_of_photons = 1u;     ///< [1/m^2]
LUCERNA_CONST uint k_density_of_irradiance = 2u;  ///< luminance [W/m^2, of the scene's unit]
LUCERNA_CONST uint k_density_of_importance = 3u;  ///< importance of the pilot's lookups, up to a factor
LUCERNA_CONST uint k_density_of_caustics = 4u;       ///< share of samples with caustics from photons
LUCERNA_CONST uint k_photons_in_disc = 5u;        ///< number of photons
LUCERNA_CONST float k_density_none = -1.0f;       ///< no visible surface
LUCERNA_CONST float k_density_normals = 0.7f;     ///< minimum cosine to the visible normal, which may be of a normal map

/// Mean over `taps` pixels to either side.
struct PhotonSmoothPush {
  uint width, height;
  uint taps;
  uint down;        ///< not 0: vertical
};

struct PhotonHeatPush {
  uint width, height;  ///< of the sheet
  uint scale;          ///< SheetView::scale: densities are of the film's pixels
  float lo, hi;        ///< of a logarithmic scale
};

struct PhotonInspectPush {
  uint width, height;
  uint pixel;
  SightGrid grid;   ///< as above
};
LUCERNA_CONST uint k_photons_inspected = 512u;  ///< maximum number of listed photons

struct PhotonInspectHeader {
  vec3 position;
  float radius;     ///< [m]
  vec3 normal;
  float area;       ///< surface area over the disc's
  vec3 irradiance;
  float density;    ///< [1/m^2]
  uint solid;       ///< 0: no visible surface
  uint count;       ///< photons within the disc
  uint pad0, pad1;
};
struct PhotonInspected {
  vec3 position;
  float contribution;     ///< to the irradiance's luminance
  vec3 direction;   ///< towards its origin
  uint bits;        ///< Photon::bits
  vec3 flux;
  float pad0;
};

LUCERNA_SHARED_END
#endif
