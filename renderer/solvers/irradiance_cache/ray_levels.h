#pragma once
// Ray levels of the records of a pass: a first level for all, then levels of four times as many rays for
// those still too noisy. Pure state; no device.
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "solvers/irradiance_cache/evaluate.h"

namespace lucerna::irradiance_cache {

/// The records that a stage processes, in order, and the number already done.
class RecordQueue {
 public:
  /// Queues records `first` to `end`.
  void set(uint32_t first, uint32_t end) {
    list_.resize(end - first);
    std::iota(list_.begin(), list_.end(), first);
    done_ = 0;
  }
  /// Queues these records.
  void set(std::vector<uint32_t> records) { list_ = std::move(records), done_ = 0; }
  /// Queues the same records again.
  void rewind() { done_ = 0; }
  const std::vector<uint32_t>& all() const { return list_; }
  /// The next ones, at most `most`; call advance() with the number done.
  std::span<const uint32_t> next(size_t most) const {
    const std::span<const uint32_t> left = std::span(list_).subspan(done_);
    return left.first(std::min(left.size(), most));
  }
  void advance(size_t count) { done_ += count; }
  bool done() const { return done_ >= list_.size(); }
  size_t done_count() const { return done_; }

 private:
  std::vector<uint32_t> list_;
  size_t done_ = 0;
};

/// Level k has 4^k times the rays of the first. A level with more rays than fit at once is done in rounds:
/// rays_before() is the number of rays that each queued record has had in all levels and rounds so far.
class RayLevels {
 public:
  /// `rays`: of the first level.
  explicit RayLevels(uint32_t rays) : first_(rays) {}
  uint32_t level() const { return level_; }
  uint32_t rays() const { return first_ << 2 * level_; }  ///< of each record, in this level
  uint32_t round_rays() const {
    uint32_t rays = this->rays();
    while (rays > Evaluator::k_most_rays) rays /= 4;
    return rays;
  }
  uint32_t rays_before() const { return before_; }
  bool in_first_round() const { return level_ == 0 && in_level_ == 0; }

  /// Restarts at the first level, for another pass.
  void restart() { level_ = in_level_ = before_ = 0, further_ = 0; }
  /// Call when all records have had a round; true if it was the last of the level.
  bool end_round() {
    before_ += round_rays();
    in_level_ += round_rays();
    return in_level_ >= rays();
  }
  void end_level() { in_level_ = 0; }
  /// Begins the next level, for that many records.
  void next(size_t records) { ++level_, further_ += uint64_t{rays()} * records; }
  /// Of each record, in the next level.
  uint64_t next_rays() const { return uint64_t{4} * rays(); }
  /// Of all records, in all levels since restart() but the first.
  uint64_t further_rays() const { return further_; }
  /// Sets the level to continue with: records have had the rays of all levels up to `level`.
  void resume(uint32_t level) { level_ = level, in_level_ = 0, before_ = rays_up_to(level); }
  /// Rays of a record after a complete level, including earlier levels.
  uint32_t rays_up_to(uint32_t level) const {
    return uint32_t(first_ * (((uint64_t{1} << 2 * (level + 1)) - 1) / 3));
  }

 private:
  uint32_t first_, level_ = 0, in_level_ = 0, before_ = 0;
  uint64_t further_ = 0;
};

}  // namespace lucerna::irradiance_cache
