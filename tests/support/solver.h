#pragma once
// The irradiance cache that a renderer has at work, for tests that look into it.
#include <memory>

#include "session/renderer.h"
#include "solvers/irradiance_cache/solver.h"

namespace lucerna::test {

/// Null where nothing is cached.
inline irradiance_cache::Cache* cache(session::Renderer& r) {
  solvers::Solver* solver = r.solver("cache");
  return solver ? &dynamic_cast<irradiance_cache::CacheSolver&>(*solver).cache() : nullptr;
}
inline const irradiance_cache::Cache* cache(const session::Renderer& r) {
  const solvers::Solver* solver = r.solver("cache");
  return solver ? &dynamic_cast<const irradiance_cache::CacheSolver&>(*solver).cache() : nullptr;
}

/// What its report is made of; null where nothing is cached.
inline std::shared_ptr<const irradiance_cache::CacheReport> cache_report(session::Renderer& r) {
  std::shared_ptr<const irradiance_cache::CacheReport> report;
  r.visit_solvers(
      [&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        if (auto* cached = dynamic_cast<irradiance_cache::CacheSolver*>(&solver))
          report = std::make_shared<const irradiance_cache::CacheReport>(
              cached->state(canvas, picture, r.samples() > 0));
      });
  return report;
}

}  // namespace lucerna::test
