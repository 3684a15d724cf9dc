#include "session/kept_solvers.h"

#include <utility>

#include "solvers/registry.h"

namespace lucerna::session {

void KeptSolvers::replace(Engine& before, const Engine& after, const scene::Changes& changes) {
  std::erase_if(kept_, [&](const Kept& k) { return after.find(k.solver->info().name) != nullptr; });
  for (std::unique_ptr<solvers::Solver>& solver : before.release_solvers()) {
    const solvers::SolverInfo& info = solver->info();
    if (!info.file || after.find(info.name) || solvers::invalidated_by(info, changes).places) continue;
    std::erase_if(kept_, [&](const Kept& k) { return &k.solver->info() == &info; });
    kept_.push_back({std::move(solver), {}});
  }
}

void KeptSolvers::note(const scene::Changes& changes) {
  for (Kept& k : kept_) k.since |= changes;
  std::erase_if(kept_,
                [](const Kept& k) { return solvers::invalidated_by(k.solver->info(), k.since).places; });
}

void KeptSolvers::hand_to(Engine& engine, const scene::Changes& changes) const {
  for (const Kept& k : kept_) {
    scene::Changes since = k.since;
    since |= changes;
    engine.adopt(*k.solver, since);
  }
}

}  // namespace lucerna::session
