// The sink of path events (shared/path_events.h), compiled in by LUCERNA_PATH_EVENTS only. A path has room for a fixed number
// of events of its own, so their order and those that are lost do not depend on timing.
#ifndef LUCERNA_LIB_PATH_EVENTS
#define LUCERNA_LIB_PATH_EVENTS
#include "lib/variants.glsl"
#if LUCERNA_PATH_EVENTS
#include "shaders/shared/path_events.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/lanes.h"

layout(scalar) buffer PathEvents { PathEvent path_events[]; };
layout(scalar) buffer PathEventStates { PathEventState path_event_states[]; };
layout(scalar) readonly buffer PathEventBlock { PathEventFrame path_event_frame; };

PathEventState event_state;  // of this invocation's path
uint event_vertex;           // its present vertex
uint event_end;              // k_end_*, set where the path ends

// Reserves the next event's place; k_path_no_event: there is none.
uint event_place() {
  bool room = event_state.count < path_event_frame.most;
  uint at = room ? event_state.count : k_path_no_event;
  event_state.count += room ? 1u : 0u;
  event_state.lost += room ? 0u : 1u;
  return at;
}
PathEvent new_event(uint kind, uint parent, uint by, vec3 position) {
  PathEvent e;
  e.position = position;
  e.pdf = 0.0;
  e.normal = vec3(0.0);
  e.parent = parent;
  e.throughput = vec3(0.0);
  e.bits = kind | by << k_path_by_shift | 15u << k_path_component_shift | 255u << k_path_group_shift;
  e.contribution = vec3(0.0);
  e.served = 0u;
  e.primitive = k_no_hit;
  e.material = k_path_no_event;
  e.light = k_path_no_event;
  e.record = k_path_no_event;
  return e;
}
void write_event(uint slot, uint at, PathEvent e) {
  if (at != k_path_no_event) path_events[slot * path_event_frame.most + at] = e;
}
// Light of a component (is_component) and a group.
void add_light(inout PathEvent e, vec3 light, uint component, uint group) {
  e.contribution = light;
  e.bits = e.bits & ((1u << k_path_component_shift) - 1u) | component << k_path_component_shift |
           (k_group_count > 1u ? group : 255u) << k_path_group_shift;
}
// True if that light reaches the film.
bool event_counts(vec3 light, uint component) {
  return is_component(component) && any(notEqual(light, vec3(0.0))) && !any(isnan(light)) && !any(isinf(light));
}
#endif
#endif
