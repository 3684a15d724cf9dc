#include "session/kept_solvers.h"

#include "solvers/registry.h"

namespace lucerna::session {
namespace {

bool invalidates_all(const solvers::SolverInfo& info, const std::set<scene::Change>& edits) {
  if (edits.contains(scene::Change::place)) return true;  // where is not noted
  scene::Changes changes;
  changes.edits = edits;
  return solvers::invalidated_by(info, changes).places;
}

}  // namespace

void KeptSolvers::replace(const Engine& before, const Engine& after, const std::set<scene::Change>& edits) {
  std::erase_if(kept_, [&](const Kept& k) { return after.took_up(*k.solver); });
  for (const std::shared_ptr<solvers::Solver>& solver : before.solvers()) {
    const solvers::SolverInfo& info = solver->info();
    if (after.took_up(*solver) || invalidates_all(info, edits)) continue;
    std::erase_if(kept_, [&](const Kept& k) { return &k.solver->info() == &info; });
    kept_.push_back({solver, before.made_for(), before.begun_settings(), {}});
  }
}

void KeptSolvers::note(const std::set<scene::Change>& edits) {
  for (Kept& k : kept_) k.edits.insert(edits.begin(), edits.end());
  std::erase_if(kept_, [](const Kept& k) { return invalidates_all(k.solver->info(), k.edits); });
}

std::vector<Predecessor> KeptSolvers::predecessors(const plan::Settings& settings,
                                                   const std::set<scene::Change>& edits) const {
  std::vector<Predecessor> all;
  if (edits.contains(scene::Change::place)) return all;
  for (const Kept& k : kept_) {
    Predecessor p{.solver = k.solver, .made_for = k.made_for, .since = {}, .kept = true};
    p.since.edits = k.edits;
    p.since.edits.insert(edits.begin(), edits.end());
    for (const auto& [key, value] : settings.all())
      if (const auto then = k.settings.find(key); then == k.settings.end() || then->second != value)
        p.since.settings.insert(key);
    all.push_back(std::move(p));
  }
  return all;
}

}  // namespace lucerna::session
