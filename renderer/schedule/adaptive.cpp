#include "schedule/adaptive.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lucerna::schedule {

namespace {
constexpr uint32_t k_first_mark = 4;  // samples a pixel from which an error predicts the next ones
constexpr uint32_t k_few = 8;         // samples a pixel when all of the device's path state is in use
/// A tile stays while a neighbour is over this many times the target.
constexpr float k_neighbours = 2;
/// Error assumed for a tile without an estimate; the maximum (film::TileError).
constexpr float k_unknown_error = 1.26f;
/// Share of the errors that samples cannot reduce; path errors below it are not reduced further.
constexpr float k_small_share = 1.0f / 3;
}  // namespace

float paths_goal(float target, float records, float interpolation) {
  if (records <= 0 && interpolation <= 0) return target;
  const float rest = target - interpolation;
  const float reach = rest > records ? std::sqrt(rest * rest - records * records) : 0;
  return std::max(reach, k_small_share * (records + interpolation));
}

AdaptiveSchedule::AdaptiveSchedule(uint32_t blocks_across, uint32_t blocks_down,
                                   const AdaptiveOptions& options)
    : options_(options), blocks_across_(blocks_across), blocks_down_(blocks_down) {
  const uint32_t side = options.tile / shared::k_block;
  assert(side == 1 || side == 2);
  set_limits(options);
  across_ = (blocks_across + side - 1) / side;
  down_ = (blocks_down + side - 1) / side;
  tiles_.resize(size_t{across_} * down_);
  for (uint32_t t = 0; t < tiles_.size(); ++t) {
    const std::vector<uint32_t> blocks = blocks_of(t);
    const bool sampled = std::any_of(blocks.begin(), blocks.end(), [&](uint32_t b) {
      return options.region.contains(b % blocks_across, b / blocks_across);
    });
    if (!sampled) tiles_[t].state = TileState::resting;
    open_ += sampled;
  }
  start_round();
}

AdaptiveSchedule::AdaptiveSchedule(uint32_t blocks_across, uint32_t blocks_down,
                                   const AdaptiveOptions& options, std::span<const uint32_t> have,
                                   std::span<const TileErrors> errors)
    : AdaptiveSchedule(blocks_across, blocks_down, options) {
  assert(have.size() == size_t{blocks_across} * blocks_down && errors.size() == tiles_.size());
  for (uint32_t t = 0; t < tiles_.size(); ++t) {
    Tile& tile = tiles_[t];
    uint32_t least = ~0u, most = 0;
    for (const uint32_t b : blocks_of(t)) least = std::min(least, have[b]), most = std::max(most, have[b]);
    tile.samples = (most + 1) / 2 * 2;  // both halves of the film agree
    for (const uint32_t b : blocks_of(t))
      if (have[b] < tile.samples)
        (rests(t) ? left_behind_ : behind_).push_back({b, have[b], tile.samples - have[b]});
    // One sample gives no error estimate.
    tile.error = least >= 2 ? errors[t].paths : k_unknown_error;
    tile.records = errors[t].records, tile.interpolation = errors[t].interpolation;
    if (!rests(t)) tile.state = tile.samples < options_.min_samples ? TileState::waiting : TileState::active;
  }
  std::stable_sort(behind_.begin(), behind_.end(), [&](const Behind& a, const Behind& b) {
    return options_.one_sample ? a.have > b.have : a.lacks < b.lacks;
  });
  update_states();
  start_round();
}

void AdaptiveSchedule::set_limits(const AdaptiveOptions& options) {
  options_.target_error = options.target_error;
  options_.max_samples = std::max(2u, options.max_samples / 2 * 2);
  options_.min_samples = std::clamp((options.min_samples + 1) / 2 * 2, 2u, options_.max_samples);
}

void AdaptiveSchedule::retarget(const AdaptiveOptions& options) {
  set_limits(options);
  for (Tile& tile : tiles_)
    if (tile.state != TileState::resting)
      tile.state = tile.samples < options_.min_samples ? TileState::waiting : TileState::active;
  update_states();
  start_round();
}

std::vector<uint32_t> AdaptiveSchedule::blocks_of(uint32_t tile) const {
  const uint32_t side = options_.tile / shared::k_block;
  std::vector<uint32_t> blocks;
  for (uint32_t y = tile / across_ * side; y < (tile / across_ + 1) * side; ++y)
    for (uint32_t x = tile % across_ * side; x < (tile % across_ + 1) * side; ++x)
      if (x < blocks_across_ && y < blocks_down_) blocks.push_back(y * blocks_across_ + x);
  return blocks;
}

void AdaptiveSchedule::start_round() {
  round_.clear();
  at_ = 0;
  const uint32_t pixels = options_.tile * options_.tile, most = std::max(1u, options_.slots / pixels);
  for (uint32_t t = 0; t < tiles_.size(); ++t)
    if (tiles_[t].state == TileState::waiting) round_.push_back(t);
  if (!round_.empty()) {
    // All pixels alike up to the minimum: single samples first, so that something is seen at once, then
    // doubling.
    uint32_t have = ~0u;  // the least of them; a new minimum may find tiles that have more
    for (const uint32_t t : round_) have = std::min(have, tiles_[t].samples);
    const uint32_t fitting =
        std::max(k_few, options_.slots / std::max<uint32_t>(1, pixels * uint32_t(round_.size())));
    pass_ = std::min({std::max(1u, have), fitting, most, options_.min_samples - have});
    order_round();
    return;
  }
  for (uint32_t t = 0; t < tiles_.size(); ++t)
    if (tiles_[t].state == TileState::active) round_.push_back(t);
  pass_ = std::min(k_few, most);
  while (!round_.empty() && uint64_t{2} * pass_ * pixels * round_.size() <= options_.slots) pass_ *= 2;
  if (pass_ > 1) pass_ = pass_ / 2 * 2;
  order_round();
}

void AdaptiveSchedule::order_round() {
  if (!options_.one_sample) return;
  pass_ = 1;
  std::stable_sort(round_.begin(), round_.end(),
                   [&](uint32_t a, uint32_t b) { return tiles_[a].samples < tiles_[b].samples; });
}

WorkItem AdaptiveSchedule::next() {
  item_tiles_.clear();
  item_behind_ = 0;
  if (done()) return {};
  if (!behind_.empty()) {
    // Tiles that lack as many as the last, while there is room.
    const bool one = options_.one_sample;
    WorkItem item{{}, one ? 1 : std::min(behind_.back().lacks, std::max(1u, options_.slots / 64))};
    const size_t most = std::max(1u, options_.slots / (64 * item.sample_count));
    const Behind& last = behind_.back();
    for (auto b = behind_.rbegin();
         b != behind_.rend() && (one ? b->have == last.have : b->lacks == last.lacks) &&
         item.blocks.size() < most;
         ++b)
      item.blocks.push_back({b->block, b->have});
    item_behind_ = item.blocks.size();
    item_samples_ = item.sample_count;
    return item;
  }
  item_first_ = at_;
  const uint32_t pixels = options_.tile * options_.tile;
  const uint32_t at_once = std::max(1u, options_.slots / (pixels * pass_));
  size_t end = std::min(round_.size(), at_ + at_once);
  if (options_.one_sample)
    while (tiles_[round_[end - 1]].samples != tiles_[round_[at_]].samples) --end;
  // No tile exceeds the cap. Those near it share an item with others, which then get less this time.
  WorkItem item{{}, pass_};
  for (size_t i = at_; i < end; ++i)
    item.sample_count = std::min(item.sample_count, options_.max_samples - tiles_[round_[i]].samples);
  for (; at_ < end; ++at_) {
    const uint32_t tile = round_[at_];
    for (const uint32_t block : blocks_of(tile)) item.blocks.push_back({block, tiles_[tile].samples});
    item_tiles_.push_back(tile);
  }
  item_samples_ = item.sample_count;
  return item;
}

void AdaptiveSchedule::give_back() {
  if (item_behind_ > 0) {
    item_behind_ = 0;
    return;
  }
  at_ = item_first_;
  item_tiles_.clear();
}

void AdaptiveSchedule::report(const std::vector<TileErrors>& errors) {
  assert(errors.size() == item_tiles_.size());
  if (item_behind_ > 0) {
    for (auto b = behind_.end() - static_cast<std::ptrdiff_t>(item_behind_); b != behind_.end(); ++b)
      b->have += item_samples_, b->lacks -= item_samples_;
    std::erase_if(behind_, [](const Behind& b) { return b.lacks == 0; });
    item_behind_ = 0;
    return;
  }
  for (size_t i = 0; i < item_tiles_.size(); ++i) {
    Tile& tile = tiles_[item_tiles_[i]];
    tile.samples += item_samples_;
    ++tile.passes;
    tile.error = errors[i].paths;
    tile.records = errors[i].records, tile.interpolation = errors[i].interpolation;
    if (tile.samples >= k_first_mark && tile.samples >= 2 * tile.last.samples)
      tile.earlier = std::exchange(tile.last, {tile.error, tile.samples});
  }
  item_tiles_.clear();
  if (at_ < round_.size()) return;
  ++rounds_;
  update_states();
  start_round();
}

void AdaptiveSchedule::update_states() {
  // From the errors that the round has left, all tiles at once, so that their order does not matter.
  std::vector<TileState> states(tiles_.size());
  open_ = 0;
  for (uint32_t t = 0; t < tiles_.size(); ++t) {
    const Tile& tile = tiles_[t];
    TileState state = tile.state;
    if (state == TileState::waiting && tile.samples >= options_.min_samples) state = TileState::active;
    if (state == TileState::active) {
      bool calm = true;  // its neighbours, except those beyond reach
      const int x = static_cast<int>(t % across_), y = static_cast<int>(t / across_);
      for (int v = std::max(0, y - 1); v <= std::min(static_cast<int>(down_) - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(static_cast<int>(across_) - 1, x + 1); ++u)
          if (const Tile& n = tiles_[static_cast<size_t>(v) * across_ + u];
              n.state != TileState::capped && n.state != TileState::resting)
            calm = calm && n.error <= k_neighbours * n.goal(options_.target_error);
      const float goal = tile.goal(options_.target_error);
      if ((tile.error <= goal && calm) || tile.samples >= options_.max_samples)
        state = tile.reached(options_.target_error) ? TileState::done : TileState::capped;
    }
    states[t] = state;
    open_ += state == TileState::waiting || state == TileState::active;
  }
  for (uint32_t t = 0; t < tiles_.size(); ++t) tiles_[t].state = states[t];
}

std::vector<uint32_t> AdaptiveSchedule::counts() const {
  std::vector<uint32_t> counts(size_t{blocks_across_} * blocks_down_, 0);
  for (uint32_t t = 0; t < tiles_.size(); ++t)
    for (const uint32_t b : blocks_of(t)) counts[b] = tiles_[t].samples;
  for (const Behind& b : behind_) counts[b.block] = b.have;
  for (const Behind& b : left_behind_) counts[b.block] = b.have;
  return counts;
}

uint32_t AdaptiveSchedule::least_samples() const {
  uint32_t least = tiles_.empty() ? 0 : ~0u;
  for (const Behind& b : behind_) least = std::min(least, b.have);
  for (const Tile& tile : tiles_)
    if (tile.state != TileState::resting) least = std::min(least, tile.samples);
  return least;
}

uint32_t AdaptiveSchedule::most_samples() const {
  uint32_t most = 0;
  for (const Tile& tile : tiles_)
    if (tile.state != TileState::resting) most = std::max(most, tile.samples);
  return most;
}

uint32_t AdaptiveSchedule::count(TileState state) const {
  return static_cast<uint32_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [&](const Tile& tile) { return tile.state == state; }));
}

}  // namespace lucerna::schedule
