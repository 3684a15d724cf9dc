#include "plan/solvers.h"

namespace lucerna::plan {

const std::vector<SolverInfo>& solvers() {
  static const std::vector<SolverInfo> list{
      {"path",
       "Path tracing: unbiased, needs no preparation, noisy where light is hard to find.",
       {true, true, true, true},
       true,
       false},
      {"cache",
       "Irradiance cache: light is gathered at few points and interpolated between them; smooth and quick on "
       "large "
       "surfaces, with an error that more samples do not take away.",
       {false, true, true, false},
       false,
       true},
  };
  return list;
}

}  // namespace lucerna::plan
