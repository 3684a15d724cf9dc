// Photons around what pixels show, for a person. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_INSPECT_H
#define LUCERNA_SHARED_PHOTONS_INSPECT_H
#include "shaders/shared/compat.h"
#include "shaders/shared/sight.h"
LUCERNA_SHARED_BEGIN

/// One float a pixel, and of all the greatest.
struct PhotonDensityPush {
  uint width, height;
  uint of;          ///< k_density_of_*, k_photons_in_disc
  uint first, count;  ///< pixels, in raster order
  SightGrid grid;   ///< of what is seen through glass and in mirrors
};
LUCERNA_CONST uint k_density_of_photons = 1u;     ///< [1/m^2]
LUCERNA_CONST uint k_density_of_irradiance = 2u;  ///< luminance [W/m^2, of the scene's unit]
LUCERNA_CONST uint k_density_of_importance = 3u;  ///< of lookups of the pilot, up to a factor
LUCERNA_CONST uint k_density_of_caustics = 4u;       ///< share of the samples in which photons bring caustics
LUCERNA_CONST uint k_photons_in_disc = 5u;        ///< their number
LUCERNA_CONST float k_density_none = -1.0f;       ///< nothing is seen there
LUCERNA_CONST float k_density_normals = 0.7f;     ///< least cosine to the normal that is seen, which may be of a normal map

/// The mean over `taps` pixels to either side.
struct PhotonSmoothPush {
  uint width, height;
  uint taps;
  uint down;        ///< nonzero: above and below
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
LUCERNA_CONST uint k_photons_inspected = 512u;  ///< that are listed at most

struct PhotonInspectHeader {
  vec3 position;
  float radius;     ///< [m]
  vec3 normal;
  float area;       ///< of the disc's, how much there is
  vec3 irradiance;
  float density;    ///< [1/m^2]
  uint solid;       ///< 0: nothing is seen there
  uint count;       ///< photons within the disc
  uint pad0, pad1;
};
struct PhotonInspected {
  vec3 position;
  float contribution;     ///< of the irradiance's luminance
  vec3 direction;   ///< whence it comes
  uint bits;        ///< Photon::bits
  vec3 flux;
  float pad0;
};

LUCERNA_SHARED_END
#endif
