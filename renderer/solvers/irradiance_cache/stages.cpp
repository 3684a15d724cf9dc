#include "solvers/irradiance_cache/stages.h"

#include <fmt/format.h>

namespace lucerna::irradiance_cache {

std::string stage_words(const StageDone& done) {
  const char* name = k_build_stages[size_t(done.stage)];
  if (done.stage == BuildStage::evaluate)
    return fmt::format("{} level {}, pass {}", name, done.level, done.pass + 1);
  return fmt::format("{}, pass {}", name, done.pass + 1);
}

}  // namespace lucerna::irradiance_cache
