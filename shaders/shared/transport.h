// State of the paths in flight, and what the wavefront's kernels are told. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_TRANSPORT_H
#define LUCERNA_SHARED_TRANSPORT_H
#include "shaders/shared/lanes.h"
LUCERNA_SHARED_BEGIN

/// States of the automaton from here on are those of paths that have passed a lookup on purpose, where what is looked up
/// is too fine to be interpolated: they look up tertiary light at the next diffuse vertex that is not passed too, if it is
/// looked up at all ...
LUCERNA_CONST uint k_gather_state = 8u;
/// ... and from here on of paths that a lookup left alone: nothing is cut off for them.
LUCERNA_CONST uint k_fallback_state = 16u;
/// ... and from here on of those that have then looked up: they may still meet the light that the vertex behind them has
/// sampled, and all that comes after has been looked up.
LUCERNA_CONST uint k_known_state = 24u;
/// In which nothing can be brought any more: in place of the eye's own among those, which no path is in that has looked up.
LUCERNA_CONST uint k_dead_state = 24u;
/// From here on the same once more, of paths in pixels where light that a solver brings elsewhere is left to paths from the
/// eye (solvers::SolverType::delegable_components).
LUCERNA_CONST uint k_delegated_states = 32u;
LUCERNA_CONST uint k_automaton_states = 64u;

// Of a path since its last scattering event, where records hold the sky's light (LUCERNA_SEPARATE_SKY):
LUCERNA_CONST uint k_path_sky_only = 1u << 6;     ///< a record's first ray: of all lights it sees the sky alone
LUCERNA_CONST uint k_path_sky_not_sampled = 1u << 7;  ///< light samples at the last vertex were of other lights only
LUCERNA_CONST uint k_path_sky_known = 1u << 8;    ///< what the ray would bring of the sky has been looked up
LUCERNA_CONST uint k_path_branched = 1u << 31;    ///< a vertex of it is followed by several branches; no other will be
LUCERNA_CONST uint k_path_state_mask = 0x3fu;
LUCERNA_CONST uint k_path_events_shift = 9u;

/// With a maximum depth below this, light that is stored for all lookups alike is read only where it has been stored for paths of
/// that many events; paths bring it elsewhere. From here on the few events more that such light may have are neglected.
LUCERNA_CONST uint k_deep_paths = 16u;

/// One path: `throughput` already divided by all probabilities.
struct PathState {
  vec3 throughput;
  float pdf;           ///< of the last scattered direction, mixture of all lobes, per solid angle; 0: delta or camera.
                       ///< Of a path from a light: flux over the radiance that a path from the eye would bring which went
                       ///< the same way, by luminance; 0: none would find it
  uint pixel;          ///< index into the film (y * width + x)
  uint sample_index;   ///< of the pixel
  uint bits;           ///< 0-5 automaton state, 6-8 and 31 k_path_*, 9-30 scattering events so far
  uint media;          ///< that the ray is in, a stack (lib/media.glsl); 0: none
  float travelled;     ///< metres since the last scattering event, over null events
  float eta_scale;     ///< product of (eta_i/eta_t)^2 that refraction has put into the throughput. Of a path from a light:
                       ///< how dense light samples are that meet where it begins (transport/emit.comp)
  uint nulls;          ///< null events since the last scattering event
  uint light_group;    ///< of a path from a light: the group that this is of, where groups are kept apart;
                       ///< else the lowest bits of its number. Of a path from the eye: the row of learned lights
                       ///< (shared/learned_lights.h) of its last vertex
};

/// What a shadow ray brings if it arrives: the diffuse and the glossy lobe's shares go to lanes of their own.
struct ShadowState {
  vec3 diffuse;
  uint lanes;          ///< 0-7 lane of the diffuse share, 8-15 of the glossy one
  vec3 glossy;
  uint tag;            ///< where light samples are recorded (LUCERNA_LEARNED): number of its record, from 1; of light
                       ///< tracing: the stratum
};

// Counters, uint each.
LUCERNA_CONST uint k_counter_next = 0u;        ///< length of the next queue
LUCERNA_CONST uint k_counter_shadow = 1u;      ///< length of the shadow queue
LUCERNA_CONST uint k_counter_shadow_next = 2u; ///< shadow rays that go on behind a transparent surface
LUCERNA_CONST uint k_counter_dropped = 3u;     ///< contributions refused because they were not finite
LUCERNA_CONST uint k_counter_rays = 4u;        ///< [4]: rays of the next queue by the component they are accounted to
LUCERNA_CONST uint k_counter_shadow_rays = 8u; ///< [4]: shadow rays likewise
LUCERNA_CONST uint k_counter_roulette = 12u;   ///< paths ended by roulette
LUCERNA_CONST uint k_counter_depth = 13u;      ///< paths ended by the maximum depth
LUCERNA_CONST uint k_counter_branching = 14u;   ///< vertices that another branch is to leave
LUCERNA_CONST uint k_counter_branching_rays = 16u;  ///< [4]: those by the component that the branch is accounted to
LUCERNA_CONST uint k_counter_kinds = 20u;       ///< [k_hit_kinds]: hits of each kind
LUCERNA_CONST uint k_counter_classes = 52u;     ///< [k_hit_classes]: of each class
LUCERNA_CONST uint k_counter_slots = 60u;

/// Classes of hits that are shaded by kernels of their own; the first takes all.
LUCERNA_CONST uint k_hit_classes = 8u;
LUCERNA_CONST uint k_class_bits = 4u;

/// transport/classes.comp.
struct ClassesPush {
  uint count, use_queue;  ///< as of TransportPush
  uint slots;             ///< entries of a class's part of the queue
  uint classes[4];        ///< by kind, k_class_bits each
};

struct TransportPush {
  uint count;          ///< entries of the queue, or slots
  uint use_queue;      ///< 0: slot = index
  uint pixel_count;    ///< camera source: slots a sample, 64 for each block of the item; shading: entries of the queue
                       ///< before the first of these
  uint round;          ///< shadow light: 0 for the rays just traced, 1 for those on their way behind a surface;
                       ///< shading: number of the branch that is to leave the vertices, 0: the first, or the only one
};

LUCERNA_SHARED_END
#endif
