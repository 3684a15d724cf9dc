#include "solvers/path_tracing/info.h"

namespace lucerna::path_tracing {

const solvers::SolverInfo& info() {
  static const solvers::SolverInfo all{
      .name = "path",
      .label = "Path",
      .title = "path tracing",
      .help = "Path tracing: unbiased, needs no preparation, noisy where light is hard to find.",
      .serves = {true, true, true, true},
      .unbiased = true,
  };
  return all;
}

}  // namespace lucerna::path_tracing
