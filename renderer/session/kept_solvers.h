#pragma once
// Solvers that are out of use, with their work: the plan has no task for them any more, or settings have
// changed so that none of it holds. When one of their kind is called for again, by undo or by hand, it takes
// up that work instead of starting from nothing.
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
  /// Keeps the solvers of `before` whose work `after` has not taken up, at most one of a kind, and forgets
  /// those whose work it has. `edits`: of the scene, from one to the other.
  void replace(const Engine& before, const Engine& after, const std::set<scene::Change>& edits);
  /// The scene is edited: forgets the work of which nothing holds any more.
  void note(const std::set<scene::Change>& edits);
  /// For an engine with these settings. `edits`: besides those noted.
  std::vector<Predecessor> predecessors(const plan::Settings& settings,
                                        const std::set<scene::Change>& edits) const;
  bool empty() const { return kept_.empty(); }
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    std::shared_ptr<solvers::Solver> solver;
    MadeFor made_for;
    // Of its last picture: settings by value, for what is set back is as it was; and edits since.
    std::map<std::string, std::string> settings;
    std::set<scene::Change> edits;
  };
  std::vector<Kept> kept_;
};

}  // namespace lucerna::session
