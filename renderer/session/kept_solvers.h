#pragma once
// Solvers that the plan has no task for any more, with the work that they have done. When one of their kind
// is called for again, by undo or by hand, it takes up that work instead of starting from nothing.
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/change.h"
#include "session/engine.h"

namespace lucerna::session {

class KeptSolvers {
 public:
  /// Keeps the solvers of `before` that `after` has not and whose work can outlive them (SolverInfo::file),
  /// at most one of a kind; forgets those that `after` has. `changes`: from one to the other.
  void replace(Engine& before, const Engine& after, const scene::Changes& changes);
  /// The scene or settings have changed: forgets the work of which nothing holds any more.
  void note(const scene::Changes& changes);
  /// Has the solvers of an engine take up the work of those kept. `changes`: besides those noted.
  void hand_to(Engine& engine, const scene::Changes& changes) const;
  bool empty() const { return kept_.empty(); }
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    std::unique_ptr<solvers::Solver> solver;
    scene::Changes since;  ///< its last picture
  };
  std::vector<Kept> kept_;
};

}  // namespace lucerna::session
