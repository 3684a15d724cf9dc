// Inspection of an irradiance cache at a pixel, and its overlays. Read by C++ and GLSL. Places in the picture are in pixels
// from its upper left corner; depths are along the view axis [m].
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_INSPECT_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_INSPECT_H
#include "shaders/shared/compat.h"
#include "shaders/shared/irradiance_cache/discontinuity.h"
#include "shaders/shared/wide_sum.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_inspect_most = 256u;      ///< records listed at most
LUCERNA_CONST uint k_no_record = 0xffffffffu;  ///< no index of a record

struct InspectPush {
  uint width, height;
  uint pixel;
  SightGrid grid;
};

LUCERNA_CONST uint k_lookup_none = 0u;  ///< the surface is not diffuse
LUCERNA_CONST uint k_lookup_too_steep = 1u;  ///< the normal map is too steep for records (k_surface_bent)
LUCERNA_CONST uint k_lookup_possible = 2u;
/// The visible surface of a pixel and its lookup.
struct InspectHeader {
  uint solid;  ///< 0: no surface; then nothing else is valid
  uint lookup;   ///< k_lookup_*
  uint count;  ///< number of records that serve; the first k_inspect_most are listed
  uint gathers;  ///< not 0: no record serves and paths gather (k_record_crowded)
  uint under;  ///< among the records whose discs cover the pixel, the one with the nearest centre; k_no_record:
               ///< none
  float size;   ///< width of a pixel there [m]
  float depth;  ///< [m]
  vec3 position, normal;  ///< those of the lookup, or without one of the visible surface
  vec3 under_at;  ///< centre of `under` in the picture, and its depth
};
/// A record valid there.
struct InspectServing {
  uint record;
  float weight;  ///< weight in lookups, above 0; not divided by the sum of weights
  vec2 at;       ///< position of its centre in the picture
  float depth;   ///< depth of its centre; 0 or less: behind the eye
};

LUCERNA_CONST uint k_overlap_bins = 33u;  ///< bins of pixels by number of valid records: 0, 1, ... and 32 or more
struct OverlapPush {
  uint width, height;
  SightGrid grid;
};
/// Counts over the picture's pixels with a diffuse surface; sums of large pictures need 64 bits.
struct OverlapCounts {
  uint pixels[k_overlap_bins];
  uint gathered;  ///< among those without a record, number of pixels where paths gather (k_record_crowded)
  uint most;        ///< maximum number of valid records at a pixel
  WideSum records;  ///< sum of valid records over the pixels
  WideSum listed;   ///< likewise, of the records in the octree's leaf there
};

/// Lines, and the disc of one record, over a rectangle of the picture.
struct CacheLinesPush {
  uint width, height;
  uint left, top, across, down;
  uint lines;
  uint ring;  ///< record with a drawn border; k_no_record: none
};

/// Normals of records as short lines from their centres.
struct CacheNormalsPush {
  uint width, height;
  uint records;
  uint color;    ///< k_record_by_*
  float lo, hi;  ///< as in OverlayPush
};

LUCERNA_SHARED_END
#endif
