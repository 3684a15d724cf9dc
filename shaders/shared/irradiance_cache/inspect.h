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
/// What the camera sees in a pixel.
struct InspectHeader {
  uint solid;  ///< 0: no surface; then nothing else is valid
  uint lookup;   ///< k_lookup_*
  uint count;  ///< number of records that serve; the first k_inspect_most are listed
  uint gathers;  ///< not 0: no record serves and paths gather (k_record_crowded)
  uint under;  ///< of the records whose discs are drawn there the one whose centre is nearest; k_no_record:
               ///< none
  float size;   ///< of a pixel there [m]
  float depth;  ///< [m]
  vec3 position, normal;  ///< of the lookup; without a lookup, of the visible surface
  vec3 under_at;  ///< centre of `under` in the picture, and its depth
};
/// A record that serves there.
struct InspectServing {
  uint record;
  float weight;  ///< as lookups weigh it, above 0; not yet divided by their sum
  vec2 at;       ///< its centre in the picture
  float depth;   ///< of its centre; not above 0: behind the eye
};

LUCERNA_CONST uint k_overlap_bins = 33u;  ///< pixels by the records that serve them: 0, 1, ... and 32 or more
struct OverlapPush {
  uint width, height;
  SightGrid grid;
};
/// Counts over the picture's pixels that show something diffuse; the sums of large pictures need the width.
struct OverlapCounts {
  uint pixels[k_overlap_bins];
  uint gathered;  ///< of those that none serves: where records say that paths gather (k_record_crowded)
  uint most;        ///< records that serve one pixel
  WideSum records;  ///< over the pixels
  WideSum listed;   ///< likewise, of those that the octree lists there
};

/// Lines, and the disc of one record, over a rectangle of the picture.
struct CacheLinesPush {
  uint width, height;
  uint left, top, across, down;
  uint lines;
  uint ring;  ///< record whose border is drawn; k_no_record: none
};

/// Normals of records as short lines from their centres.
struct CacheNormalsPush {
  uint width, height;
  uint records;
  uint color;    ///< k_record_by_*
  float lo, hi;  ///< as OverlayPush
};

LUCERNA_SHARED_END
#endif
