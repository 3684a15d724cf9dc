#include "plan/solvers.h"

namespace lucerna::plan {

const std::vector<SolverInfo>& solvers() {
  static const std::vector<SolverInfo> list{
      {"path",
       "Path tracing: unbiased, needs no preparation, noisy where light is hard to find.",
       {true, true, true, true},
       true},
  };
  return list;
}

}  // namespace lucerna::plan
