#include "solvers/solver.h"

namespace lucerna::solvers {

shared::Frame path_frame(const FrameSource& source, const Routing& routing, uint32_t enabled) {
  const OptionValues& settings = source.settings;
  return transport::make_frame(source.flat, source.camera, source.automaton,
                               {.width = source.width,
                                .height = source.height,
                                .seed = uint32_t(settings.integer("seed")),
                                .max_depth = uint32_t(settings.integer("path.max_depth")),
                                .roulette_depth = uint32_t(settings.integer("path.roulette_depth")),
                                .enabled = enabled,
                                .routes = routing.lookups,
                                .fallback = routing.fallback,
                                .gather = routing.gather});
}

}  // namespace lucerna::solvers
