// Points of a thin lens, uniform over its area (LUCERNA_THIN_LENS).
//
// The lens is a disc, or a regular polygon within it, across the view axis at the eye. All rays that leave it for one point of
// the picture meet at one point of the plane of focus: with s = camera_shift() the ray from the lens's point p goes to
// (camera_forward + s) * focus_distance. Each point of the lens is thus the eye of a pinhole camera whose picture is moved by
// -p / focus_distance in the plane at distance 1. A pixel is the mean over pixel and lens, so the brightness of the picture does
// not depend on the lens.
#ifndef LUCERNA_LIB_LENS
#define LUCERNA_LIB_LENS
#include "lib/frame.glsl"

// A point of a regular polygon with its corners on the unit circle, the first of them at (1, 0). u.x chooses a triangle between
// the centre and two corners; its remainder and u.y choose the place in it.
vec2 sample_polygon(vec2 u, uint corners) {
  float scaled = u.x * float(corners), triangle = min(floor(scaled), float(corners) - 1.0);
  vec2 angles = (triangle + vec2(0.0, 1.0)) * (2.0 * k_pi / float(corners));
  float away = sqrt(scaled - triangle);  // from the centre
  return away * mix(vec2(cos(angles.x), sin(angles.x)), vec2(cos(angles.y), sin(angles.y)), u.y);
}

// From the lens's centre [m].
vec3 lens_point(vec2 u) {
  vec2 p = frame.lens_blades == 0u ? sample_disk(u) : sample_polygon(u, frame.lens_blades);
  float c = cos(frame.lens_rotation), s = sin(frame.lens_rotation);
  p = frame.lens_radius * vec2(c * p.x - s * p.y, s * p.x + c * p.y);
  return p.x * normalize(frame.camera_right) + p.y * normalize(frame.camera_up);
}
#endif
