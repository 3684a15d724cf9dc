#include "solvers/solver.h"

namespace lucerna::solvers {

shared::Frame Picture::frame_for(const Routing& routing, uint32_t enabled) const {
  return transport::make_frame(flat, camera, task.automaton,
                               {.width = width,
                                .height = height,
                                .seed = uint32_t(task.settings.integer("seed")),
                                .max_depth = uint32_t(task.settings.integer("path.max_depth")),
                                .roulette_depth = uint32_t(task.settings.integer("path.roulette_depth")),
                                .enabled = enabled,
                                .routes = routing.lookups,
                                .fallback = routing.fallback,
                                .gather = routing.gather});
}

}  // namespace lucerna::solvers
