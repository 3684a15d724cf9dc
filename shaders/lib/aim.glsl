// Aiming at boxes. From a point: selects a face that is visible from it, in proportion to the solid angle at its centre, and
// a uniform point on it. From afar: uniform over the projection of the box along the direction. From inside a box there is
// no aiming. Every direction enters a box through one face, so its density is that of one point.
#ifndef LUCERNA_LIB_AIM
#define LUCERNA_LIB_AIM

struct Box { vec3 lo, hi; };

// The three faces that may be visible from p, by axis: their position and share.
void aim_faces(Box box, vec3 p, out vec3 plane, out vec3 share, out bool outside) {
  vec3 size = box.hi - box.lo, middle = 0.5 * (box.lo + box.hi);
  bvec3 below = lessThan(p, box.lo), above = greaterThan(p, box.hi);
  plane = mix(box.hi, box.lo, below);
  vec3 height = abs(plane - p) * vec3(ivec3(below) | ivec3(above));
  vec3 area = size.yzx * size.zxy;
  vec3 x = vec3(plane.x, middle.yz) - p, y = vec3(middle.x, plane.y, middle.z) - p, z = vec3(middle.xy, plane.z) - p;
  vec3 far2 = max(vec3(dot(x, x), dot(y, y), dot(z, z)), vec3(1e-30));
  vec3 weight = area * height / (far2 * sqrt(far2));
  float sum = weight.x + weight.y + weight.z;
  outside = sum > 0.0;
  share = outside ? weight / sum : vec3(0.0);
}

// Selects a face by u.x; the remainder of u.x is reused for the place on it.
uint aim_choose(vec3 share, inout float u) {
  uint axis = u < share.x ? 0u : u < share.x + share.y ? 1u : 2u;
  axis = axis == 2u && share.z <= 0.0 ? (share.y > 0.0 ? 1u : 0u) : axis;
  float before = axis == 0u ? 0.0 : axis == 1u ? share.x : share.x + share.y;
  u = clamp((u - before) / share[axis], 0.0, 1.0);
  return axis;
}

vec3 aim_on_face(Box box, vec3 plane, uint axis, vec2 u) {
  vec3 v = axis == 0u ? vec3(0.0, u.x, u.y) : axis == 1u ? vec3(u.y, 0.0, u.x) : vec3(u.x, u.y, 0.0);
  vec3 at = mix(box.lo, box.hi, v);
  return axis == 0u ? vec3(plane.x, at.yz) : axis == 1u ? vec3(at.x, plane.y, at.z) : vec3(at.xy, plane.z);
}

// Unit direction from p into the box; false if p is inside.
bool aim_sample(Box box, vec3 p, vec2 u, inout vec3 direction) {
  vec3 plane, share;
  bool outside;
  aim_faces(box, p, plane, share, outside);
  if (!outside) return false;
  uint axis = aim_choose(share, u.x);
  direction = normalize(aim_on_face(box, plane, axis, u) - p);
  return true;
}

// Where a line enters and leaves the box, and through which axis.
void aim_slabs(Box box, vec3 p, vec3 d, out float enter, out float leave, out uint axis) {
  vec3 inverse = 1.0 / mix(d, vec3(1e-25), lessThan(abs(d), vec3(1e-25)));
  vec3 a = (box.lo - p) * inverse, b = (box.hi - p) * inverse;
  vec3 first = min(a, b), last = max(a, b);
  enter = max(first.x, max(first.y, first.z));
  leave = min(last.x, min(last.y, last.z));
  axis = first.x >= enter ? 0u : first.y >= enter ? 1u : 2u;
}

// Density of that direction per solid angle; `own`: from p, if inside the box. `drawn`: the direction was sampled for this
// box, so it hits despite rounding.
float aim_pdf(Box box, vec3 p, vec3 direction, float own, bool drawn) {
  vec3 plane, share;
  bool outside;
  aim_faces(box, p, plane, share, outside);
  if (!outside) return own;
  float enter, leave;
  uint axis;
  aim_slabs(box, p, direction, enter, leave, axis);
  vec3 size = box.hi - box.lo, area = size.yzx * size.zxy;
  bool meets = drawn || (enter > 0.0 && enter <= leave);
  return meets ? share[axis] * enter * enter / max(area[axis] * abs(direction[axis]), 1e-37) : 0.0;
}

// A point on the faces of the box turned against `direction`, uniform in the projection along it.
vec3 aim_sample_afar(Box box, vec3 direction, vec2 u) {
  vec3 size = box.hi - box.lo, seen = size.yzx * size.zxy * abs(direction);
  vec3 share = seen / max(seen.x + seen.y + seen.z, 1e-37);
  uint axis = aim_choose(share, u.x);
  return aim_on_face(box, mix(box.hi, box.lo, greaterThan(direction, vec3(0.0))), axis, u);
}

// Density per area across the direction, of the line through p.
float aim_pdf_afar(Box box, vec3 p, vec3 direction, bool drawn) {
  vec3 size = box.hi - box.lo, seen = size.yzx * size.zxy * abs(direction);
  float enter, leave;
  uint axis;
  aim_slabs(box, p, direction, enter, leave, axis);
  return drawn || enter <= leave ? 1.0 / max(seen.x + seen.y + seen.z, 1e-37) : 0.0;
}
#endif
