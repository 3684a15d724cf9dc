#pragma once
// The irradiance cache in use by a renderer, for tests that inspect it.
#include <memory>

#include "session/renderer.h"
#include "solvers/irradiance_cache/solver.h"

namespace lucerna::test {

/// Null if no cache is in use.
inline irradiance_cache::Cache* cache(session::Renderer& r) {
  solvers::Solver* solver = r.solver("cache");
  return solver ? &dynamic_cast<irradiance_cache::CacheSolver&>(*solver).cache() : nullptr;
}
inline const irradiance_cache::Cache* cache(const session::Renderer& r) {
  const solvers::Solver* solver = r.solver("cache");
  return solver ? &dynamic_cast<const irradiance_cache::CacheSolver&>(*solver).cache() : nullptr;
}

/// The data of its report; null if no cache is in use.
inline std::shared_ptr<const irradiance_cache::CacheReport> cache_report(session::Renderer& r) {
  std::shared_ptr<const irradiance_cache::CacheReport> report;
  r.overlays().visit_solvers(
      [&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        if (auto* cached = dynamic_cast<irradiance_cache::CacheSolver*>(&solver))
          report = std::make_shared<const irradiance_cache::CacheReport>(
              cached->state(canvas, picture, r.samples() > 0));
      });
  return report;
}

}  // namespace lucerna::test
