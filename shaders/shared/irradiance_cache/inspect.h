// What a person asks of an irradiance cache at a pixel of the picture, and what is drawn to answer. Read by
// C++ and GLSL. Places in the picture are in pixels from its upper left corner; depths are along the view
// axis [m].
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

LUCERNA_CONST uint k_lookup_none = 0u;  ///< nothing diffuse is seen
LUCERNA_CONST uint k_lookup_too_steep = 1u;  ///< no record can serve so steep a normal map (k_surface_bent)
LUCERNA_CONST uint k_lookup_possible = 2u;
/// What the camera sees in a pixel.
struct InspectHeader {
  uint solid;  ///< 0: nothing, and then nothing else here holds
  uint lookup;   ///< k_asks_*
  uint count;  ///< records that serve there; the first k_inspect_most of them are listed
  uint gathers;  ///< not 0: none does, and those that are there say that paths gather (k_record_crowded)
  uint under;  ///< of the records whose discs are drawn there the one whose centre is nearest; k_no_record:
               ///< none
  float size;   ///< of a pixel there [m]
  float depth;  ///< [m]
  vec3 position, normal;  ///< as lookups are asked there; where nothing asks, of what is seen
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
