// The frame's constants, the automaton, and the path state buffers.
#ifndef LUCERNA_LIB_FRAME
#define LUCERNA_LIB_FRAME
#include "lib/variants.glsl"
#include "shaders/shared/scene.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/transport.h"
#include "lib/math.glsl"

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
#endif

// Offset of a point of the picture [pixels] from the camera's axis, and the direction of the ray through it.
vec3 camera_shift(vec2 xy) {
  vec2 ndc = xy / vec2(frame.width, frame.height) * 2.0 - 1.0;
  return ndc.x * frame.camera_right - ndc.y * frame.camera_up;
}
vec3 camera_direction(vec3 shift) { return normalize(frame.camera_forward + (frame.orthographic != 0u ? vec3(0.0) : shift)); }

// Distance along a camera ray to the plane that cuts the view, if the ray starts before it, else 0; infinite if it never passes
// the plane: then it sees nothing.
float section_distance(vec3 origin, vec3 direction) {
  float before = frame.section_offset - dot(origin, frame.section_normal);
  float speed = dot(direction, frame.section_normal);
  if (before <= 0.0) return 0.0;
  return speed > 0.0 ? before / speed : k_infinity;
}

uint path_automaton(PathState p) { return p.bits & k_path_state_mask; }
uint path_depth(PathState p) { return (p.bits & ~k_path_branched) >> k_path_events_shift; }

#endif
