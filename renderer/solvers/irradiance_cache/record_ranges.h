#pragma once
// What is known of the records, and of how many of them. No device: pure state.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace lucerna::irradiance_cache {

/// Records lie pass by pass, so that what is known holds for a beginning of them:
///
///   building:   0 ... complete() ... evaluated() == placed() ... pass_end()
///   relighting: 0 ... evaluated() ... pass_end() ... placed() == complete()
///
/// Those from evaluated() to pass_end() are of the pass in progress and have no light yet; while records are
/// relit pass_end() goes through the ends of the passes there were.
class RecordRanges {
 public:
  /// Up to here they have light and radius, and are in the octree.
  uint32_t evaluated() const { return evaluated_; }
  /// ... place and radius: more than are evaluated only while they are relit.
  uint32_t placed() const { return placed_; }
  /// Where those of the pass in progress end.
  uint32_t pass_end() const { return pass_end_; }
  /// Records of the pass in progress that are not yet evaluated.
  uint32_t waiting() const { return pass_end_ - evaluated_; }
  /// Whether some of the pass in progress are new, not relit.
  bool has_new() const { return pass_end_ > placed_; }
  /// Records of complete passes.
  uint32_t complete() const { return ends_.empty() ? 0 : ends_.back(); }
  /// Where the records of each complete pass end, rising.
  const std::vector<uint32_t>& complete_ends() const { return ends_; }
  /// Where the pass ends whose records are to be relit next; only where evaluated() < complete().
  uint32_t next_end() const { return *std::upper_bound(ends_.begin(), ends_.end(), evaluated_); }

  /// There are these records and no others, all complete; `ends` as complete_ends().
  void restore(std::vector<uint32_t> ends) {
    ends_ = std::move(ends);
    evaluated_ = placed_ = pass_end_ = complete();
  }
  void clear() { restore({}); }
  void set_pass_end(uint32_t end) { pass_end_ = end; }
  /// Those of the pass in progress have got light and radius.
  void evaluate_pass() {
    evaluated_ = pass_end_;
    placed_ = std::max(placed_, evaluated_);
  }
  /// What is evaluated is of complete passes. False when it was before.
  bool complete_pass() {
    if (evaluated_ <= complete()) return false;
    ends_.push_back(evaluated_);
    return true;
  }
  /// To be relit: only those of complete passes keep their places.
  void keep_complete() { placed_ = complete(); }
  /// ... and none has light any more.
  void lose_light() { evaluated_ = 0; }

 private:
  uint32_t evaluated_ = 0, placed_ = 0, pass_end_ = 0;
  std::vector<uint32_t> ends_;
};

/// Which light records hold.
struct RecordLight {
  uint32_t parts = 0;      ///< in bits; the others are 0
  bool recursive = false;  ///< tertiary light was looked up in other records, not path traced
  bool elsewhere = false;  ///< ... or another solver looked it up
};

}  // namespace lucerna::irradiance_cache
