// Lamps with a shape: sphere, rectangle, disk, tube. They emit the same radiance everywhere and in all directions of their
// emitting side: a sphere and a tube (a cylinder without ends) outwards, a rectangle and a disk to their front or both sides.
//
// A lamp is no surface of the scene: rays meet it beside the tree, get its light, and go on. It blocks nothing, so that moving
// and resizing it changes the table of lights alone.
//
// Light samples: directions of a sphere's cone; a rectangle by solid angle; disk and tube by the solid angle of a rectangle
// around what is visible of them, where samples beside the lamp carry no light (M. N. Gamito, "Solid Angle Sampling of Disk and
// Cylinder Lights", 2016).
#ifndef LUCERNA_LIB_SHAPES
#define LUCERNA_LIB_SHAPES
#include "lib/variants.glsl"
#include "shaders/shared/scene.h"
#include "lib/spherical_rectangle.glsl"

// Share of a ray's length by which a surface may lie in front of a lamp and hide nothing of it: a lamp on a ceiling lights.
const float k_shape_gap = 1e-4;

struct LampShape {
  uint kind;
  uint bits;             // k_light_both_sides, k_light_hidden
  vec3 centre;
  vec3 front, right, up; // unit, perpendicular; front: direction of the emitting side, right: axis of a tube
  vec2 half_size;        // along right and up; radius of a sphere or disk in both; radius of a tube in y
  vec3 radiance;
};

bool is_shape(uint kind) { return kind >= k_light_sphere && kind <= k_light_tube; }

// Texels a, b, c, d of the table of lights.
LampShape lamp_shape(vec4 a, vec4 b, vec4 c, vec4 d) {
  LampShape s;
  s.kind = floatBitsToUint(a.w);
  s.bits = floatBitsToUint(d.w);
  s.centre = a.xyz;
  s.front = c.xyz;
  s.right = d.xyz;
  s.up = cross(d.xyz, c.xyz);
  s.half_size = vec2(b.w, c.w);
  bool round = s.kind == k_light_sphere || s.kind == k_light_disk;
  // Intensity over the area seen from the front.
  s.radiance = b.xyz / ((round ? k_pi : 4.0) * b.w * c.w);
  return s;
}

// Distance along the ray to the lamp's emitting side; 0: it is not met.
float shape_hit(LampShape s, vec3 origin, vec3 direction) {
  vec3 to = s.centre - origin;
  float t = 0.0;
  if (s.kind == k_light_sphere) {
    float along = dot(to, direction), r2 = s.half_size.x * s.half_size.x;
    vec3 off = to - along * direction;
    float inside = r2 - dot(off, off);
    t = inside > 0.0 && dot(to, to) > r2 ? along - sqrt(inside) : 0.0;
  } else if (s.kind == k_light_tube) {
    float step = dot(direction, s.right), start = dot(to, s.right), r2 = s.half_size.y * s.half_size.y;
    vec3 across = direction - step * s.right, away = start * s.right - to;
    float a = dot(across, across), nearest = -dot(away, across) / max(a, 1e-37);
    vec3 off = away + nearest * across;
    float inside = r2 - dot(off, off);
    t = nearest - sqrt(max(inside, 0.0) / max(a, 1e-37));
    bool met = inside > 0.0 && a > 0.0 && dot(away, away) > r2 && abs(t * step - start) <= s.half_size.x;
    t = met ? t : 0.0;
  } else {
    float cosine = dot(s.front, direction);
    t = dot(to, s.front) / (abs(cosine) > 1e-30 ? cosine : 1e-30);
    vec3 p = t * direction - to;
    vec2 at = vec2(dot(p, s.right), dot(p, s.up)) / s.half_size;
    bool within = s.kind == k_light_disk ? dot(at, at) <= 1.0 : max(abs(at.x), abs(at.y)) <= 1.0;
    bool emits = cosine < 0.0 || (s.bits & k_light_both_sides) != 0u;
    t = within && emits ? t : 0.0;
  }
  return max(t, 0.0);
}

// Rectangle around the part of a rectangle, disk or tube that is visible from p; false: nothing is.
bool shape_window(LampShape s, vec3 p, out SphericalRectangle window) {
  vec3 to = s.centre - p;
  vec2 middle = vec2(dot(to, s.right), dot(to, s.up));
  vec2 lo = middle - s.half_size, hi = middle + s.half_size;
  vec3 y = s.up, n = s.front;
  float height = dot(to, s.front);
  bool visible = height < 0.0 || (s.bits & k_light_both_sides) != 0u;
  n = height < 0.0 ? -n : n;
  height = abs(height);
  if (s.kind == k_light_tube) {
    // Through the two lines in which planes from p touch the tube; visible points in front are seen through it.
    vec3 away = middle.x * s.right - to;
    float d = length(away), r = s.half_size.y, up = (d + r) / max(d, 1e-30);
    visible = d > r;
    n = -away / max(d, 1e-30);
    y = cross(n, s.right);
    height = (d - r) * up;
    float wide = r * sqrt(max(0.0, 1.0 - square(r / max(d, 1e-30))));
    lo = vec2(min(lo.x, lo.x * up), -wide);
    hi = vec2(max(hi.x, hi.x * up), wide);
  }
  visible = visible && height > 0.0;
  window = spherical_rectangle(s.right, y, n, max(height, 1e-30), lo, hi);
  return visible;
}

// 1 - cosine of the half angle under which a sphere is seen.
float sphere_cone(LampShape s, vec3 p) {
  vec3 to = s.centre - p;
  float sin2 = square(s.half_size.x) / max(dot(to, to), 1e-37);
  return sin2 < 1.0 ? sin2 / (1.0 + sqrt(1.0 - sin2)) : 0.0;
}

// Density, per solid angle, with which sample_shape() samples a direction from p in which the lamp is met.
float shape_pdf(LampShape s, vec3 p, vec3 direction) {
  if (s.kind == k_light_sphere) return 1.0 / max(2.0 * k_pi * sphere_cone(s, p), 1e-37);
  SphericalRectangle window;
  if (!shape_window(s, p, window)) return 0.0;
  float along = dot(direction, window.n);
  vec2 at = vec2(dot(direction, window.x), dot(direction, window.y)) * (window.height / max(along, 1e-30));
  return along > 0.0 ? spherical_rectangle_pdf(window, at) : 0.0;
}

// A direction from p, unit, with its density and the distance to the lamp, 0 if it is not met.
vec3 sample_shape(LampShape s, vec3 p, vec2 u, out float pdf, out float distance) {
  vec3 direction;
  if (s.kind == k_light_sphere) {
    vec3 to = s.centre - p, axis = normalize(to), t, b;
    float width = sphere_cone(s, p), m = u.y * width, sin2 = m * (2.0 - m), phi = 2.0 * k_pi * u.x, d = length(to);
    make_basis(axis, t, b);
    direction = sqrt(max(sin2, 0.0)) * (cos(phi) * t + sin(phi) * b) + (1.0 - m) * axis;
    pdf = width > 0.0 ? 1.0 / (2.0 * k_pi * width) : 0.0;
    distance = width > 0.0 ? max(0.0, (1.0 - m) * d - sqrt(max(0.0, square(s.half_size.x) - sin2 * d * d))) : 0.0;
    return normalize(direction);
  }
  SphericalRectangle window;
  bool visible = shape_window(s, p, window);
  vec2 at = sample_spherical_rectangle(window, u);
  direction = normalize(at.x * window.x + at.y * window.y + window.height * window.n);
  pdf = visible ? spherical_rectangle_pdf(window, at) : 0.0;
  distance = sqrt(dot(at, at) + window.height * window.height);
  if (s.kind == k_light_tube) distance = shape_hit(s, p, direction);
  if (s.kind == k_light_disk) {
    vec3 off = p + distance * direction - s.centre;
    distance = square(dot(off, s.right)) + square(dot(off, s.up)) <= square(s.half_size.x) ? distance : 0.0;
  }
  distance = visible ? distance : 0.0;
  return direction;
}

// Area from which the lamp emits [m^2]; both sides count.
float shape_area(LampShape s) {
  float plain = s.half_size.x * s.half_size.y;
  if (s.kind == k_light_sphere) return 4.0 * k_pi * plain;
  if (s.kind == k_light_tube) return 4.0 * k_pi * plain;  // 2 pi radius times 2 half lengths
  return (s.kind == k_light_disk ? k_pi : 4.0) * plain * ((s.bits & k_light_both_sides) != 0u ? 2.0 : 1.0);
}

// A point on the lamp, uniform in that area, and the normal of its emitting side. `back`: chooses the back of two sides.
vec3 shape_place(LampShape s, vec2 u, bool back, out vec3 normal) {
  if (s.kind == k_light_sphere) {
    float z = 1.0 - 2.0 * u.y, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * k_pi * u.x;
    normal = normalize(vec3(r * cos(phi), r * sin(phi), z));
    return s.centre + s.half_size.x * normal;
  }
  if (s.kind == k_light_tube) {
    float phi = 2.0 * k_pi * u.x;
    normal = normalize(cos(phi) * s.front + sin(phi) * s.up);
    return s.centre + s.half_size.x * (2.0 * u.y - 1.0) * s.right + s.half_size.y * normal;
  }
  vec2 at = s.half_size * (s.kind == k_light_disk ? sample_disk(u) : 2.0 * u - 1.0);
  normal = back && (s.bits & k_light_both_sides) != 0u ? -s.front : s.front;
  return s.centre + at.x * s.right + at.y * s.up;
}

// Share of the intensity in front that the lamp sends along a direction from it, at least a little.
float shape_facing(LampShape s, vec3 direction) {
  float along = dot(direction, s.front), of_axis = dot(direction, s.right);
  float flat_share = (s.bits & k_light_both_sides) != 0u ? abs(along) : along;
  float share = s.kind == k_light_sphere ? 1.0 : s.kind == k_light_tube ? sqrt(max(0.0, 1.0 - of_axis * of_axis)) : flat_share;
  return max(share, 0.02);
}

#endif
