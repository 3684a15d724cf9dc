// Colour of a record in overlays.
#ifndef LUCERNA_IRRADIANCE_CACHE_INK
#define LUCERNA_IRRADIANCE_CACHE_INK
#include "shaders/shared/ramp.h"
#include "shaders/shared/irradiance_cache/records.h"

// sRGB-encoded colour, 0..1. `by`: k_record_by_*. `lo`, `hi`: ends of the scale (OverlayPush). Reads record_texels.
vec3 record_ink(uint record, uint by, float lo, float hi) {
  vec4 texel = texelFetch(record_texels, int(record * k_record_texels + 2u));
  uint flags = floatBitsToUint(texel.w);
  if (by == k_record_by_pass) return ramp_hue(flags & k_record_pass);
  if (by == k_record_by_origin) return ramp_hue((flags >> k_record_origin_shift) & 3u);
  float value = texel.z;
  if (by == k_record_by_rays) value = float(floatBitsToUint(texel.x));
  if (by == k_record_by_distance) value = texelFetch(record_texels, int(record * k_record_texels + 1u)).w;
  return ramp_color(k_ramp_viridis, ramp_position(value, lo, hi, 1u));
}
#endif
