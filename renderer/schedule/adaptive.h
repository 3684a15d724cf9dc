#pragma once
// Adaptive tiles: samples go to the tiles whose error exceeds the target.
//
// All pixels first get the minimum. Then the active tiles take turns, as many at once as the device's path
// state holds at a few samples a pixel each; when fewer remain, the samples a pixel double, so that the
// device stays full on the hardest tiles. A tile becomes inactive when its error and, with a wider bound,
// those of its neighbours are under the target: light that few samples have met (a caustic's rim) is then
// searched where an adjacent tile is still noisy. If samples read records, a part of the error does not fall:
// sampling continues until the sum is under the target, and where records alone exceed it, until samples
// hardly reduce the sum. Pure functions of counts and errors: equal errors give equal schedules, whatever the
// machine's speed.
#include <cstdint>
#include <span>
#include <vector>

#include "base/error_sum.h"
#include "schedule/region.h"
#include "schedule/work.h"

namespace lucerna::schedule {

enum class TileState : uint8_t {
  waiting,  ///< waits for the minimum of samples
  active,
  done,     ///< below the target
  capped,   ///< above it, with the maximum of samples or of useful samples (Tile::limited)
  resting,  ///< outside the region: gets no samples
};

/// An earlier error of a tile.
struct TileMark {
  float error = 0;
  uint32_t samples = 0;  ///< a pixel; 0: unknown
};

/// Parts of a tile's relative error, as in film::RelativeError; sum: base/error_sum.h.
struct TileErrors {
  float paths = 0, records = 0, interpolation = 0;
};

/// Error of the paths at which a tile stops: where the sum reaches `target`, or, if that requires less than a
/// third of the errors of records and interpolation, at that third: the sum is then within a twentieth of the
/// errors that samples do not reduce, or within a third if these are all interpolation.
float paths_goal(float target, float records, float interpolation);

struct Tile {
  float error = 0;  ///< error of the paths, as last reported; not used while waiting
  /// ... and the errors that samples do not reduce.
  float records = 0, interpolation = 0;
  uint32_t samples = 0;  ///< a pixel
  uint32_t passes = 0;
  TileState state = TileState::waiting;
  TileMark last, earlier;  ///< the newest since samples have doubled, and the one before
  float goal(float target) const { return paths_goal(target, records, interpolation); }
  float sum() const { return error_sum(error, records, interpolation); }
  /// True if the sum is under the target, except for rounding where goal() derives from it.
  bool reached(float target) const {
    return sum() <= (records > 0 || interpolation > 0 ? 1.0001f * target : target);
  }
  /// Capped because of its records: the paths' error has reached its goal.
  bool limited(float target) const { return state == TileState::capped && error <= goal(target); }
};

struct AdaptiveOptions {
  uint32_t tile = 16;  ///< pixels along a side: 8 or 16
  float target_error = 0.05f;
  uint32_t min_samples = 64,
           max_samples = 1024;  ///< a pixel; made even, so that both halves of the film agree
  uint32_t slots = 131072;      ///< maximum number of paths at once, at least those of one sample of a tile
  bool one_sample = false;      ///< items have one sample a pixel, the same for all of their blocks
  Rectangle region = {};        ///< blocks; tiles with none of them get no samples
};

class AdaptiveSchedule {
 public:
  AdaptiveSchedule() = default;
  AdaptiveSchedule(uint32_t blocks_across, uint32_t blocks_down, const AdaptiveOptions& options);
  /// Continues a picture whose blocks, in raster order, have `have` samples a pixel and whose tiles have
  /// `errors`: blocks behind others of their tile catch up first, and no sample is discarded.
  AdaptiveSchedule(uint32_t blocks_across, uint32_t blocks_down, const AdaptiveOptions& options,
                   std::span<const uint32_t> have, std::span<const TileErrors> errors);

  bool done() const { return open_ == 0 && behind_.empty(); }
  /// The next work item; empty when done. report() then needs the errors of the item's tiles.
  WorkItem next();
  /// Tiles of the last item of next(), in order; none while blocks are behind.
  const std::vector<uint32_t>& to_report() const { return item_tiles_; }
  /// Reports that the item is finished; `errors`: one per tile of to_report().
  void report(const std::vector<TileErrors>& errors);
  /// Continues with another target, minimum or maximum (tile, slots and region are unchanged): tiles above
  /// the new target get samples again, those below none, and no sample is discarded. Between report() or
  /// give_back() and next().
  void retarget(const AdaptiveOptions& options);
  /// Returns an item that was not finished: next() gives it again.
  void give_back();

  const std::vector<Tile>& tiles() const { return tiles_; }
  uint32_t tiles_across() const { return across_; }
  uint32_t tiles_down() const { return down_; }
  /// The blocks of a tile, in Morton order.
  std::vector<uint32_t> blocks_of(uint32_t tile) const;
  /// Samples a pixel of every block, in raster order.
  std::vector<uint32_t> counts() const;
  /// Minimum and maximum number of samples over the pixels of the region.
  uint32_t least_samples() const;
  uint32_t most_samples() const;
  uint32_t count(TileState state) const;
  /// Number of tiles of the region.
  uint32_t sampled_tiles() const { return static_cast<uint32_t>(tiles_.size()) - count(TileState::resting); }
  /// Complete rounds: in each, all active tiles get the same samples.
  uint32_t rounds() const { return rounds_; }
  const AdaptiveOptions& options() const { return options_; }

 private:
  void set_limits(const AdaptiveOptions& options);
  void start_round();
  /// For items of one sample: tiles with the same next sample are adjacent.
  void order_round();
  void update_states();
  bool rests(uint32_t tile) const { return tiles_[tile].state == TileState::resting; }

  AdaptiveOptions options_;
  uint32_t blocks_across_ = 0, blocks_down_ = 0, across_ = 0, down_ = 0;
  std::vector<Tile> tiles_;
  std::vector<uint32_t> round_;       // tiles of this round
  std::vector<uint32_t> item_tiles_;  // of the last item
  uint32_t pass_ = 1;                 // samples a pixel in this round
  size_t at_ = 0;                     // in round_
  uint32_t open_ = 0;                 // tiles waiting or active
  uint32_t rounds_ = 0;
  uint32_t item_samples_ = 0;  // of the last item
  size_t item_first_ = 0;
  struct Behind {
    uint32_t block, have, lacks;
  };
  std::vector<Behind> behind_;       // blocks with fewer samples than their tile; served from the end
  size_t item_behind_ = 0;           // number of them in the last item
  std::vector<Behind> left_behind_;  // likewise, of resting tiles
};

}  // namespace lucerna::schedule
