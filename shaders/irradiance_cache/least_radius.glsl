// The least radius of a record: some pixels wide as the camera sees it, and no more than the greatest.
#ifndef LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#define LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#include "lib/frame.glsl"

float least_radius(vec3 position, float least_pixels, float most) {
  float seen = frame.orthographic != 0u ? 1.0 : distance(position, frame.camera_origin);
  float pixel = 2.0 * seen * length(frame.camera_up) / float(frame.height);
  return min(least_pixels * pixel, most);
}
#endif
