#pragma once
// State of the records, as ranges. Pure state; no device.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace lucerna::irradiance_cache {

/// Records are stored pass by pass, so each state holds for a prefix of them:
///
///   building:   0 ... complete() ... evaluated() == placed() ... pass_end()
///   relighting: 0 ... evaluated() ... pass_end() ... placed() == complete()
///
/// Records from evaluated() to pass_end() belong to the current pass and have no light yet. During relighting
/// pass_end() steps through the ends of the former passes.
class RecordRanges {
 public:
  /// End of the records with light and radius, which are in the octree.
  uint32_t evaluated() const { return evaluated_; }
  /// End of the records with place and radius; beyond evaluated() only during relighting.
  uint32_t placed() const { return placed_; }
  /// End of the records of the current pass.
  uint32_t pass_end() const { return pass_end_; }
  /// Number of records of the current pass that are not evaluated.
  uint32_t waiting() const { return pass_end_ - evaluated_; }
  /// True if some records of the current pass are new, not relit.
  bool has_new() const { return pass_end_ > placed_; }
  /// End of the records of complete passes.
  uint32_t complete() const { return ends_.empty() ? 0 : ends_.back(); }
  /// End of the records of each complete pass, rising.
  const std::vector<uint32_t>& complete_ends() const { return ends_; }
  /// End of the pass whose records are relit next; requires evaluated() < complete().
  uint32_t next_end() const { return *std::upper_bound(ends_.begin(), ends_.end(), evaluated_); }

  /// Sets the state to exactly these records, all complete; `ends` as complete_ends().
  void restore(std::vector<uint32_t> ends) {
    ends_ = std::move(ends);
    evaluated_ = placed_ = pass_end_ = complete();
  }
  void clear() { restore({}); }
  void set_pass_end(uint32_t end) { pass_end_ = end; }
  /// Marks the records of the current pass as evaluated.
  void evaluate_pass() {
    evaluated_ = pass_end_;
    placed_ = std::max(placed_, evaluated_);
  }
  /// Marks all evaluated records as complete passes. False if they already were.
  bool complete_pass() {
    if (evaluated_ <= complete()) return false;
    ends_.push_back(evaluated_);
    return true;
  }
  /// Starts relighting: only records of complete passes stay.
  void keep_complete() { placed_ = complete(); }
  /// ... and none has light.
  void lose_light() { evaluated_ = 0; }

 private:
  uint32_t evaluated_ = 0, placed_ = 0, pass_end_ = 0;
  std::vector<uint32_t> ends_;
};

/// Kinds of light in records.
struct RecordLight {
  uint32_t parts = 0;      ///< stored parts, as bits; the others are 0
  bool recursive = false;  ///< tertiary light was looked up in other records, not path traced
  bool elsewhere = false;  ///< ... or provided by another solver
};

}  // namespace lucerna::irradiance_cache
