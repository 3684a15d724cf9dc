#pragma once
// The picture as its paths see it, and the frames of these paths: constants and automaton tables for kernels
// (transport/frame.h).
#include <optional>
#include <vector>

#include "plan/settings.h"
#include "session/world.h"
#include "solvers/solver.h"

namespace lucerna::session {

/// A picture of a world, for solvers; everything it refers to must outlive it.
struct PictureView {
  const paths::Automaton& automaton;
  const plan::Settings& settings;
  const World& world;
  const scene::Camera& camera;
  uint32_t width = 0, height = 0;
  std::vector<vec3> mix = {};  ///< of light groups, if they are separate (film::Film::set_mix)
};

/// Lookups of all solvers together.
struct PathRoutes {
  solvers::Routing here;
  /// With delegable components traced (solvers::SolverType::delegable_components); nullopt: none are.
  std::optional<solvers::Routing> delegated;
};

/// Frame of the picture's paths, in a picture of that size.
shared::Frame frame_of(const PathRoutes& routes, const PictureView& picture, uint32_t width, uint32_t height);

}  // namespace lucerna::session
