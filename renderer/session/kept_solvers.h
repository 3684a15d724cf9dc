#pragma once
// Unused solvers with their prepared data: the plan has no task for them any more, or changed settings have
// invalidated all of it. When a solver of the same type is used again, by undo or by the user, it continues
// with this data instead of from scratch.
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/change.h"
#include "session/engine.h"

namespace lucerna::session {

class KeptSolvers {
 public:
  /// Keeps the solvers of `before` whose data `after` does not use, at most one of a type, and drops those
  /// whose data it uses. `edits`: edits of the scene between the two engines.
  void replace(const Engine& before, const Engine& after, const std::set<scene::Change>& edits);
  /// Notes edits of the scene; drops solvers without any valid data left.
  void note(const std::set<scene::Change>& edits);
  /// Predecessors for an engine with these settings. `edits`: further edits, not noted yet.
  std::vector<Predecessor> predecessors(const plan::Settings& settings,
                                        const std::set<scene::Change>& edits) const;
  bool empty() const { return kept_.empty(); }
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    std::shared_ptr<solvers::Solver> solver;
    MadeFor made_for;
    // Settings of its last picture, so that settings changed back count as unchanged; and edits since.
    std::map<std::string, std::string> settings;
    std::set<scene::Change> edits;
  };
  std::vector<Kept> kept_;
};

}  // namespace lucerna::session
