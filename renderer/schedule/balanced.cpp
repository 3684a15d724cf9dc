#include "schedule/balanced.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace lucerna::schedule {

namespace {
/// A block has at least this share of the mean number of samples.
constexpr double k_least_of_mean = 0.5;
/// A round has at least one in so many blocks, those of the largest gain, so that the device stays full.
constexpr size_t k_round_share = 16;
/// Samples of a round over the mean so far: small enough that a block is rarely sampled far beyond its share.
constexpr uint32_t k_pass_of_mean = 8;
}  // namespace

BalancedSchedule::BalancedSchedule(uint32_t blocks_across, const BalancedOptions& options,
                                   std::vector<uint32_t> have)
    : options_(options), across_(blocks_across), counts_(std::move(have)) {
  assert(counts_.size() % blocks_across == 0);
  for (uint32_t b = 0; b < counts_.size(); ++b)
    if (options.region.contains(b % across_, b / across_)) blocks_.push_back(b);
  start_round();
}

void BalancedSchedule::set_samples(uint32_t samples) {
  options_.samples = samples;
  if (at_ == 0) start_round();
}

uint32_t BalancedSchedule::least_samples() const {
  uint32_t least = blocks_.empty() ? 0 : ~0u;
  for (const uint32_t b : blocks_) least = std::min(least, counts_[b]);
  return least;
}

uint32_t BalancedSchedule::most_samples() const {
  uint32_t most = 0;
  for (const uint32_t b : blocks_) most = std::max(most, counts_[b]);
  return most;
}

double BalancedSchedule::mean_samples() const {
  double sum = 0;
  for (const uint32_t b : blocks_) sum += counts_[b];
  return blocks_.empty() ? 0 : sum / double(blocks_.size());
}

std::vector<double> BalancedSchedule::gains(std::span<const float> squares) const {
  const auto down = uint32_t(counts_.size() / across_);
  const auto variance = [&](uint32_t b) { return double(squares[b]) * counts_[b]; };
  std::vector<double> list;
  for (const uint32_t b : blocks_) {
    const uint32_t x = b % across_, y = b / across_;
    double around = 0, weights = 0;
    for (uint32_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, down); ++v)
      for (uint32_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, across_); ++u) {
        if ((u == x && v == y) || !options_.region.contains(u, v)) continue;
        const double weight = u == x || v == y ? 2 : 1;
        around += weight * variance(v * across_ + u), weights += weight;
      }
    list.push_back(weights > 0 ? around / (weights * counts_[b] * counts_[b]) : 0);
  }
  return list;
}

void BalancedSchedule::start_round() {
  round_.clear();
  at_ = 0;
  waits_ = false;
  mean_before_ = mean_samples();
  if (blocks_.empty() || mean_before_ >= options_.samples) return;
  const uint32_t least = least_samples(), first = std::min(options_.first, options_.samples);
  waits_ = least >= first;
  if (waits_) return;
  // The fewest catch up: single samples at first, so that something is seen at once, then doubling.
  uint32_t level = first;
  for (const uint32_t b : blocks_)
    if (counts_[b] == least)
      round_.push_back(b);
    else
      level = std::min(level, counts_[b]);
  pass_ = std::min({std::max(1u, least), level - least, std::max(1u, options_.slots / 64)});
}

void BalancedSchedule::judge(std::span<const float> squares) {
  assert(waits_ && squares.size() == counts_.size());
  waits_ = false;
  const double mean = mean_before_;
  const std::vector<double> gain = gains(squares);
  const double mean_gain = std::accumulate(gain.begin(), gain.end(), 0.0) / double(gain.size());
  std::vector<uint32_t> order(blocks_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return gain[a] > gain[b]; });
  const size_t least_round = (order.size() + k_round_share - 1) / k_round_share;
  for (size_t i = 0; i < order.size(); ++i)
    if (i < least_round || gain[order[i]] >= mean_gain || counts_[blocks_[order[i]]] < k_least_of_mean * mean)
      round_.push_back(blocks_[order[i]]);
  std::sort(round_.begin(), round_.end());
  // Even where they fit, so that both halves of the film agree.
  const uint32_t most = std::max(1u, options_.slots / 64);
  pass_ = std::min(most, std::max(2u, uint32_t(mean) / k_pass_of_mean / 2 * 2));
}

WorkItem BalancedSchedule::next() {
  WorkItem item{{}, pass_};
  const size_t end = std::min(round_.size(), at_ + std::max(1u, options_.slots / (64 * pass_)));
  for (; at_ < end; ++at_) {
    uint32_t& count = counts_[round_[at_]];
    item.blocks.push_back({round_[at_], count});
    count += pass_;
  }
  if (at_ == round_.size() && !round_.empty()) {
    ++rounds_;
    start_round();
  }
  return item;
}

}  // namespace lucerna::schedule
