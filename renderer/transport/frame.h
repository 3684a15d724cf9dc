#pragma once
// The frame's constants for kernels, from scene, camera and a few numbers.
#include "paths/automaton.h"
#include "scene/scene.h"
#include "shaders/shared/scene.h"
#include "upload/flatten.h"

namespace lucerna::transport {

/// Radius of the circle around the lens [m]; 0: a pinhole. `half_width`: half the picture's width at
/// distance 1.
float lens_radius(const scene::Camera& camera, float half_width);

struct FrameOptions {
  uint32_t width = 1, height = 1;
  uint32_t seed = 1;
  uint32_t max_depth = 64;      ///< scattering events after which a path ends
  uint32_t roulette_depth = 3;  ///< events before roulette may end one
  uint32_t enabled = 15;        ///< components on (bit i)
  paths::LookupRoutes routes;   ///< additional lookups
  /// Components of paths in shared::k_phase_fallback; 0: there are no such paths.
  uint32_t fallback = 0;
  /// Lookups of these components by gathering paths (shared::k_phase_gather).
  paths::LookupRoutes gather;
};

/// All paths compute everything, as in shared::k_phase_fallback, which the frame must have.
void compute_everything(shared::Frame& frame);

/// Paths that start in shared::k_delegated_states use the automaton of `other`.
void set_delegated_tables(shared::Frame& frame, const shared::Frame& other);

shared::Frame make_frame(const upload::FlatScene& flat, const scene::Camera& camera,
                         const paths::Automaton& automaton, const FrameOptions& options);

}  // namespace lucerna::transport
