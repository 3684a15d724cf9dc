// The frame's constants, the automaton, and the path state buffers.
#ifndef LUCERNA_LIB_FRAME
#define LUCERNA_LIB_FRAME
#include "lib/variants.glsl"
#include "shaders/shared/scene.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/transport.h"
#include "lib/math.glsl"
#include "lib/projection.glsl"

layout(scalar) readonly buffer FrameBlock { Frame frame; };

#if LUCERNA_NO_AUTOMATON
// The plain path tracer, an oracle for the partition: everything is component 0 and nothing is cut off; one bit
// remembers a diffuse event, for unlit surfaces.
uint automaton_after(uint state, uint event) { return event == 0u ? 1u : state; }
uint automaton_component(uint state) { return 0u; }
bool automaton_live(uint state) { return true; }
bool automaton_no_diffuse(uint state) { return state == 0u; }
bool automaton_goes_on(uint state) { return true; }
uint automaton_account(uint state) { return 0u; }
bool automaton_ends_on_diffuse(uint state) { return false; }
bool automaton_ends(uint state) { return false; }
#else
// One word a state (paths/automaton.h, pack()).
uint automaton_after(uint state, uint event) { return (frame.automaton[state] >> (8u * event)) & 0xffu; }
uint automaton_component(uint state) { return (frame.automaton[state] >> 24) & 7u; }
bool automaton_live(uint state) { return (frame.automaton[state] & (1u << 27)) != 0u; }
bool automaton_no_diffuse(uint state) { return (frame.automaton[state] & (1u << 28)) != 0u; }
// True if the scene's surfaces can cause a further event with light behind it.
bool automaton_goes_on(uint state) {
  bool on = automaton_live(automaton_after(state, 0u));
#if LUCERNA_SCENE_GLOSSY
  on = on || automaton_live(automaton_after(state, 1u)) || automaton_live(automaton_after(state, 2u));
#endif
  return on;
}
uint automaton_account(uint state) { return (frame.automaton[state] >> 29) & 3u; }
bool automaton_ends_on_diffuse(uint state) { return (frame.automaton[state] & k_ends_on_diffuse) != 0u; }
// Likewise on surfaces with any lobes.
bool automaton_ends(uint state) {
  uint glossy = automaton_after(state, 1u), specular = automaton_after(state, 2u);
  bool bright = is_component(automaton_component(glossy)) || is_component(automaton_component(specular));
  return automaton_ends_on_diffuse(state) && !bright && !automaton_live(glossy) && !automaton_live(specular);
}
#endif

// Offset of a point of the picture (0..1 to the right and down) from the middle, along camera_right and camera_up.
vec3 shift_at(vec2 place) {
  vec2 ndc = place * 2.0 - 1.0;
  return ndc.x * frame.camera_right - ndc.y * frame.camera_up;
}
// Likewise, of a place in pixels.
vec3 camera_shift(vec2 xy) { return shift_at(xy / vec2(frame.width, frame.height)); }
// Angles of a wide picture at that offset.
vec2 camera_angles(vec3 shift) { return vec2(dot(shift, normalize(frame.camera_right)), dot(shift, normalize(frame.camera_up))); }
// Angles of a unit direction in a wide picture.
vec2 angles_towards(vec3 direction) {
  return wide_angles(frame.projection, direction, normalize(frame.camera_right), normalize(frame.camera_up), frame.camera_axis);
}
// Start and direction of the ray through that point. The ray's length counts in camera_depth().
vec3 camera_start(vec3 shift) { return frame.camera_origin + (is_parallel(frame.projection) ? shift : vec3(0.0)); }
vec3 camera_view(vec3 shift) {
  if (is_wide(frame.projection))
    return wide_direction(frame.projection, camera_angles(shift), normalize(frame.camera_right), normalize(frame.camera_up), frame.camera_axis);
  return frame.camera_forward + (is_parallel(frame.projection) ? vec3(0.0) : shift);
}
vec3 camera_direction(vec3 shift) { return normalize(camera_view(shift)); }
// False outside a fisheye's circle.
bool camera_covers(vec3 shift) { return !is_wide(frame.projection) || wide_covers(frame.projection, camera_angles(shift)); }
// Depth of a point, from its offset from the eye: along the axis, in wide pictures the distance.
float camera_depth(vec3 away) { return is_wide(frame.projection) ? length(away) : dot(away, frame.camera_axis); }
// Direction from the camera to a point.
vec3 camera_towards(vec3 position) {
  return is_parallel(frame.projection) ? frame.camera_forward : normalize(position - frame.camera_origin);
}

// Distance along a camera ray to the plane that cuts the view, if the ray starts before it, else 0; infinite if it never passes
// the plane: then it sees nothing.
float section_distance(vec3 origin, vec3 direction) {
  float before = frame.section_offset - dot(origin, frame.section_normal);
  float speed = dot(direction, frame.section_normal);
  if (before <= 0.0) return 0.0;
  return speed > 0.0 ? before / speed : k_infinity;
}

uint path_automaton(PathState p) { return p.bits & k_path_state_mask; }
uint path_depth(PathState p) { return p.bits >> k_path_events_shift & k_path_events_mask; }

#endif
