// What the display shows of exposed linear radiance: a tone curve, or a table made from an OCIO configuration.
#ifndef LUCERNA_LIB_DISPLAY
#define LUCERNA_LIB_DISPLAY
#include "shaders/shared/tone.h"
#ifndef LUCERNA_DISPLAY_LUT
#define LUCERNA_DISPLAY_LUT 0
#endif
#if LUCERNA_DISPLAY_LUT
#include "shaders/shared/display_lut.h"
layout(scalar) readonly buffer DisplayLut { vec4 display_lut[]; };

vec3 display_node(uvec3 at) {
  at = min(at, uvec3(k_display_lut_size - 1u));
  return display_lut[(at.z * k_display_lut_size + at.y) * k_display_lut_size + at.x].rgb;
}

// Tetrahedral interpolation: greys are interpolated between greys.
vec3 display_color(vec3 radiance, uint curve) {
  vec3 place = vec3(display_lut_place(radiance.x), display_lut_place(radiance.y), display_lut_place(radiance.z));
  uvec3 at = uvec3(place);
  vec3 f = place - vec3(at);
  // From the lower corner along the axis of the largest fraction, then of the middle one, then of the least.
  bvec3 first = bvec3(f.x >= f.y && f.x >= f.z, f.y > f.x && f.y >= f.z, f.z > f.x && f.z > f.y);
  bvec3 last = bvec3(f.x < f.y && f.x < f.z, f.y <= f.x && f.y < f.z, f.z <= f.x && f.z <= f.y);
  uvec3 one = uvec3(first), two = uvec3(not(last));
  float most = max(f.x, max(f.y, f.z)), least = min(f.x, min(f.y, f.z)), middle = f.x + f.y + f.z - most - least;
  return (1.0 - most) * display_node(at) + (most - middle) * display_node(at + one) + (middle - least) * display_node(at + two) +
         least * display_node(at + 1u);
}
#else
vec3 display_color(vec3 radiance, uint curve) { return tone_map(radiance, curve); }
#endif
#endif
