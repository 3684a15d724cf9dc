// State of the paths in flight, and parameters of the wavefront's kernels. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_TRANSPORT_H
#define LUCERNA_SHARED_TRANSPORT_H
#include "shaders/shared/lanes.h"
LUCERNA_SHARED_BEGIN

// States of eye paths: those of the automaton, once for each phase of lookups, and all of that again for paths in pixels
// where a solver delegates light to eye paths (solvers::SolverType::delegable_components).
LUCERNA_CONST uint k_phase_states = 8u;  ///< room for the automaton's states in a phase
LUCERNA_CONST uint k_phase_start = 0u;   ///< no lookup has been passed
/// The path has intentionally passed a lookup whose light is too fine to interpolate. It looks up tertiary light at the next
/// diffuse vertex that is not passed too, if it is looked up at all.
LUCERNA_CONST uint k_phase_gather = 1u;
LUCERNA_CONST uint k_phase_fallback = 2u;  ///< behind a lookup without data: the path computes everything
/// Behind a lookup with data: the path may only meet the light that the vertex behind it has sampled.
LUCERNA_CONST uint k_phase_known = 3u;
LUCERNA_CONST uint k_phases = 4u;
LUCERNA_CONST uint k_delegated_states = k_phases * k_phase_states;  ///< first of the states in such pixels
LUCERNA_CONST uint k_automaton_states = 2u * k_delegated_states;
/// No light can follow. Uses a state that eye paths never reach in phase known.
LUCERNA_CONST uint k_dead_state = k_phase_known * k_phase_states;

LUCERNA_INLINE uint phase_of(uint state) { return state / k_phase_states % k_phases; }
/// The same state of the automaton in a phase.
LUCERNA_INLINE uint in_phase(uint state, uint phase) {
  return state - state % k_delegated_states + phase * k_phase_states + state % k_phase_states;
}
/// The state of the automaton, 0 to k_phase_states - 1.
LUCERNA_INLINE uint without_phase(uint state) { return state % k_phase_states; }
/// The state with its phase in pixels where nothing is delegated, 0 to k_delegated_states - 1.
LUCERNA_INLINE uint without_delegation(uint state) { return state % k_delegated_states; }
/// True behind a lookup that was not passed to gather.
LUCERNA_INLINE bool is_behind_lookup(uint state) { return phase_of(state) >= k_phase_fallback; }

// State of a path since its last scattering event, for records with sky light (LUCERNA_SEPARATE_SKY):
LUCERNA_CONST uint k_path_sky_only = 1u << 6;     ///< a record's first ray: the sky is the only light it may hit
LUCERNA_CONST uint k_path_sky_not_sampled = 1u << 7;  ///< light samples at the last vertex excluded the sky
LUCERNA_CONST uint k_path_sky_known = 1u << 8;    ///< the sky's light along the ray has been looked up
LUCERNA_CONST uint k_path_branched = 1u << 31;    ///< one of its vertices has several branches; no other vertex may branch
LUCERNA_CONST uint k_path_state_mask = 0x3fu;
LUCERNA_CONST uint k_path_events_shift = 9u, k_path_events_mask = 0x1ffu;
LUCERNA_CONST uint k_path_wavelength_shift = 18u;  ///< 12 bits (lib/dispersion.glsl)

LUCERNA_CONST uint k_layer_state_shift = 24u, k_nulls_mask = 0xffffffu;  ///< of PathState::nulls

/// With a maximum depth below this, stored light is read only if it was stored for paths of that many events; otherwise
/// paths compute it. From here on the few additional events of stored light are neglected.
LUCERNA_CONST uint k_deep_paths = 16u;

/// One path: `throughput` already divided by all probabilities.
struct PathState {
  vec3 throughput;
  float pdf;           ///< of the last scattered direction, mixture of all lobes, per solid angle; 0: delta or camera.
                       ///< Light paths: flux over the radiance of an eye path along the same way,
                       ///< by luminance; 0: no eye path finds it
  uint pixel;          ///< index into the film (y * width + x)
  uint sample_index;   ///< sample of the pixel
  uint bits;           ///< 0-5 automaton state, 6-8 and 31 k_path_*, 9-17 scattering events so far,
                       ///< 18-29 wavelength; 0: all
  uint media;          ///< media around the ray, a stack (lib/media.glsl); 0: none
  float travelled;     ///< metres since the last scattering event, over null events
  float eta_scale;     ///< product of (eta_i/eta_t)^2 in the throughput from refraction. Light paths: density
                       ///< of light samples at the path's origin (transport/emit.comp)
  uint nulls;          ///< null events since the last scattering event; with layers (lib/layers.glsl) bits 24-31 are
                       ///< the state of their automaton
  uint light_group;    ///< light paths: group of the light, if groups are separate;
                       ///< else the lowest bits of its number. Eye paths: row of learned lights
                       ///< (shared/learned_lights.h) of its last vertex
};

/// Contribution of a shadow ray if it arrives: the shares of the diffuse and the glossy lobe go to separate lanes.
struct ShadowState {
  vec3 diffuse;
  uint lanes;          ///< 0-7 lane of the diffuse share, 8-15 of the glossy one; 16-23 and 24-31 their layer states
  vec3 glossy;
  uint tag;            ///< if light samples are recorded (LUCERNA_LEARNED): number of its record, from 1; light
                       ///< tracing: the stratum
};

// Counters, uint each.
LUCERNA_CONST uint k_counter_next = 0u;        ///< length of the next queue
LUCERNA_CONST uint k_counter_shadow = 1u;      ///< length of the shadow queue
LUCERNA_CONST uint k_counter_shadow_next = 2u; ///< shadow rays that continue behind a transparent surface
LUCERNA_CONST uint k_counter_dropped = 3u;     ///< contributions refused because they were not finite
LUCERNA_CONST uint k_counter_rays = 4u;        ///< [4]: rays of the next queue by the component they are accounted to
LUCERNA_CONST uint k_counter_shadow_rays = 8u; ///< [4]: shadow rays likewise
LUCERNA_CONST uint k_counter_roulette = 12u;   ///< paths ended by roulette
LUCERNA_CONST uint k_counter_depth = 13u;      ///< paths ended by the maximum depth
LUCERNA_CONST uint k_counter_branching = 14u;   ///< vertices with another branch
LUCERNA_CONST uint k_counter_branching_rays = 16u;  ///< [4]: those by the component of the branch
LUCERNA_CONST uint k_counter_kinds = 20u;       ///< [k_hit_kinds]: hits of each kind
LUCERNA_CONST uint k_counter_classes = 52u;     ///< [k_hit_classes]: of each class
LUCERNA_CONST uint k_counter_slots = 60u;

/// Classes of hits with separate kernels; the first one takes all.
LUCERNA_CONST uint k_hit_classes = 8u;
LUCERNA_CONST uint k_class_bits = 4u;

/// transport/classes.comp.
struct ClassesPush {
  uint count, use_queue;  ///< as in TransportPush
  uint slots;             ///< entries of a class's part of the queue
  uint classes[4];        ///< by kind, k_class_bits each
  uint diffuse, all;      ///< bits by kind (transport::DarkKinds): hits of these that add no light are left out
};

struct TransportPush {
  uint count;          ///< entries of the queue, or slots
  uint use_queue;      ///< 0: slot = index
  uint pixel_count;    ///< camera source: slots a sample, 64 for each block of the item; shading: entries of the queue
                       ///< before the first of these
  uint round;          ///< shadow light: 0 for the rays just traced, 1 for rays that passed a surface;
                       ///< shading: number of the branch; 0: the first or only one
};

LUCERNA_SHARED_END
#endif
