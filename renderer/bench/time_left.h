#pragma once
// Remaining time of a bench, from finished units.
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "bench/matrix.h"

namespace lucerna::bench {

class TimeLeft {
 public:
  static constexpr size_t k_reference = ~size_t{0};
  /// A render: of a cell, or of a scene's reference (setting k_reference).
  struct Unit {
    size_t scene = 0, setting = 0, budget = 0;
    auto operator<=>(const Unit&) const = default;
  };

  explicit TimeLeft(const Matrix& matrix) : matrix_(matrix) {}
  void add(const Unit& unit) { ++todo_[unit], ++units_; }
  size_t units() const { return units_; }
  void finished(const Unit& unit, double seconds);
  /// Remaining seconds of `current`, of which `fraction` is done after `elapsed` seconds, and of all others.
  /// A repeated unit takes as long as before; others by their number of paths (an adaptive render as the
  /// scene's largest uniform one), at the pace of their scene, or of all. nullopt until there is a pace.
  std::optional<double> seconds(const Unit& current, double fraction, double elapsed) const;

 private:
  struct Known {
    double seconds = 0, paths = 0;
    int count = 0;
  };
  double paths(const Unit& unit) const;
  std::optional<double> expected(const Unit& unit, const Known& extra) const;

  const Matrix& matrix_;
  std::map<Unit, int> todo_;
  std::map<Unit, Known> known_;
  size_t units_ = 0;
};

}  // namespace lucerna::bench
