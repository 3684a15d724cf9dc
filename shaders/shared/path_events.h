// Recorded paths: the events of eye paths, for inspection. Read by C++ and GLSL.
//
// Events of a path are numbered from 0 on in the order of their writing; each names the event before it on its way, so that
// branches of one path are a tree. Only kernels of the variant LUCERNA_PATH_EVENTS write them.
#ifndef LUCERNA_SHARED_PATH_EVENTS_H
#define LUCERNA_SHARED_PATH_EVENTS_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// Kinds of events.
LUCERNA_CONST uint k_path_camera = 0u;      ///< start at the camera; normal: direction
LUCERNA_CONST uint k_path_surface = 1u;     ///< a surface; pdf: of the direction that led here
LUCERNA_CONST uint k_path_passed = 2u;      ///< a surface passed without an event: alpha, a thin pane
LUCERNA_CONST uint k_path_emission = 3u;    ///< emission of the surface before it
LUCERNA_CONST uint k_path_light = 4u;       ///< a light sample whose shadow ray arrived; position: on the light
LUCERNA_CONST uint k_path_blocked = 5u;     ///< ... was blocked; contribution: that if it had arrived
LUCERNA_CONST uint k_path_background = 6u;  ///< light of a ray that left the scene
LUCERNA_CONST uint k_path_records = 7u;     ///< light read from records of the irradiance cache
LUCERNA_CONST uint k_path_photons = 8u;     ///< light read from photons, or from a map of their irradiance
LUCERNA_CONST uint k_path_splat = 9u;       ///< light that light tracing has brought to the pixel
LUCERNA_CONST uint k_path_looked_up = 10u;  ///< light read by another solver
LUCERNA_CONST uint k_path_end = 11u;        ///< end of the path
LUCERNA_CONST uint k_path_kinds = 12u;

// Reasons of an end.
LUCERNA_CONST uint k_end_absorbed = 0u;     ///< the sampled direction carries no light
LUCERNA_CONST uint k_end_roulette = 1u;
LUCERNA_CONST uint k_end_depth = 2u;        ///< maximum depth
LUCERNA_CONST uint k_end_complete = 3u;     ///< no component that is computed can follow
LUCERNA_CONST uint k_end_looked_up = 4u;    ///< a lookup has provided the rest
LUCERNA_CONST uint k_end_left = 5u;         ///< left the scene
LUCERNA_CONST uint k_end_unlit = 6u;        ///< an unlit surface
LUCERNA_CONST uint k_end_reasons = 7u;

LUCERNA_CONST uint k_path_no_event = 0xffffffffu;
// Fields of PathEvent::bits.
LUCERNA_CONST uint k_path_by_shift = 8u;          ///< 4 bits: lobe by which the path left the event before: k_event_*
LUCERNA_CONST uint k_path_by_none = 15u;          ///< ... without scattering
LUCERNA_CONST uint k_path_reason_shift = 12u;     ///< 4 bits: k_end_*
LUCERNA_CONST uint k_path_component_shift = 16u;  ///< 4 bits: of the contribution; 15: none
LUCERNA_CONST uint k_path_group_shift = 20u;      ///< 8 bits: its light group; 255: unknown, or groups are not separate

struct PathEvent {
  vec3 position;      ///< world space [m]
  float pdf;          ///< of the direction to it, per solid angle; of a light sample with its selection; 0: delta or none
  vec3 normal;        ///< shading normal on the path's side, unit; 0: none
  uint parent;        ///< number of the event before it; k_path_no_event: none
  vec3 throughput;    ///< on arrival
  uint bits;          ///< 0-7 k_path_* kind, then the fields above
  vec3 contribution;  ///< radiance added to the sample of the pixel; 0 of events without light
  uint served;        ///< records or photons that were read
  uint primitive;     ///< triangle; k_no_hit: none
  uint material;      ///< of a surface; k_path_no_event: none
  uint light;         ///< entry of the light table; k_path_no_event: none, or the sky
  uint record;        ///< drawn record; k_path_no_event: none
};

/// Of one path in flight.
struct PathEventState {
  uint count;   ///< events written
  uint last;    ///< event that the next ones follow
  uint branch;  ///< event whose further branches begin later
  uint by;      ///< lobe by which the path has left `last`: k_event_* or k_path_by_none
  uint lost;    ///< events for which there was no room
};

struct PathEventFrame {
  uint most;  ///< events per path
  float far;  ///< distance at which rays that leave the scene are drawn [m]
};

/// A recorded path: which sample of which pixel.
struct PathChoice {
  uint pixel;  ///< y * width + x
  uint sample_index;
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::PathEvent) == 80);
#endif
#endif
