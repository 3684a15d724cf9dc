#pragma once
// Accuracy data for the window: ledger, tiles and passes of the current image. Maintained on the session's
// thread, published as a whole.
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error_sum.h"
#include "shaders/shared/film.h"
#include "shaders/shared/ramp.h"
#include "stats/forecast.h"
#include "stats/ledger.h"

namespace lucerna::session {

class ImageProgress;
class Renderer;
class Sampling;
struct Setup;

struct TileStatus {
  float error = -1;                      ///< relative error of the paths; negative: unknown
  float records = 0, interpolation = 0;  ///< ... and of lookups
  float sum() const { return error < 0 ? error : error_sum(error, records, interpolation); }
  uint32_t samples = 0;
  uint32_t pixels = 0;
  /// Likewise, at a quarter to half of the samples, in adaptive sampling; 0: unknown.
  float earlier_error = 0;
  uint32_t earlier_samples = 0;
  uint32_t state = shared::k_tile_waiting;  ///< shared::k_tile_*; outside a region: done
  bool heavy_tailed = false;
};

/// One pass over the picture, or over the active tiles.
struct PassStatus {
  std::vector<float> stage_ms;  ///< by Accuracy::stages; later stages may be missing
  uint64_t paths = 0;
  uint32_t samples = 0;  ///< a pixel, maximum over the active ones
};

struct Accuracy {
  uint64_t run = 0;  ///< increases with every image
  uint64_t scene_id = 0;
  std::map<std::string, std::string> settings;  ///< all current settings
  bool adaptive = false, finished = false;
  double target = 0.05;                     ///< sampling.target_error
  double min_samples = 0, max_samples = 0;  ///< a pixel
  uint32_t tile = 16, across = 0;           ///< side of a tile in pixels, tiles in a row
  double paths = 0, rays = 0, pixels = 1;   ///< so far; size of the picture
  stats::Ledger ledger;
  /// For each entry of the ledger, the error of the worst tile that is still within reach; 0: unknown.
  std::vector<double> hardest;
  /// Raster order; empty in uniform sampling unless shown. Flags only if shown.
  std::vector<TileStatus> tiles;
  /// seconds_to(target), in adaptive sampling.
  std::optional<stats::Band> forecast;
  std::vector<std::string> stages;
  std::deque<PassStatus> passes;  ///< newest last
  std::string reference;          ///< file name of the reference picture; "": none
  bool reference_applies = false;
  /// Relative to each component's mean; nullopt: not estimated by the solver, or the component is off. The
  /// ledger's errors contain only noise.
  std::array<std::optional<double>, stats::k_layers - 1> bias;

  /// Errors of the sum and of the components by the last entry; all 0 before the first.
  std::array<double, stats::k_layers> error() const;
  /// Number of tiles in that state.
  uint32_t count(uint32_t state) const;
};

/// Seconds of rendering, from the image's start, until it has that error. Uniform sampling: of the sum
/// (stats::seconds_to). Adaptive sampling: of every tile, from the remaining rays of the tiles and the recent
/// time per ray. nullopt if there is too little data, or only a region of the picture gets samples.
std::optional<stats::Band> seconds_to(const Accuracy& accuracy, double target);

/// Number of tiles that are not expected to reach the target within the maximum samples of adaptive sampling
/// (Accuracy::max_samples).
uint32_t tiles_out_of_reach(const Accuracy& accuracy, double target);

/// Seconds of rendering, from the image's start, until uniform sampling has all its samples (`samples`).
/// nullopt in adaptive sampling, of a region, and before the first entry of the ledger.
std::optional<double> seconds_to_end(const Accuracy& accuracy);

/// Tiles of the current image with the latest error estimates. `flags`: mark heavy tails, which takes a pass
/// over the film.
std::vector<TileStatus> tile_status(const Setup& setup, const Sampling& sampling,
                                    const ImageProgress& progress, bool flags);

/// Follows a renderer; not thread-safe.
class AccuracyKeeper {
 public:
  /// Call after every step and command: records passes and entries of the ledger. Cheap without news.
  void follow(const Renderer& renderer, uint64_t scene_id);
  /// The current state, updated if anything has changed (`tiles`: including tiles and settings).
  std::shared_ptr<const Accuracy> publish(const Renderer& renderer, bool tiles);

 private:
  void note_pass(const Renderer& renderer);

  Accuracy now_;
  std::shared_ptr<const Accuracy> published_;
  bool changed_ = true;
  uint64_t restarts_ = ~0ull;
  uint32_t passes_ = 0;
  std::vector<double> pass_ms_;  ///< stage times at the start of the pass
  uint64_t pass_paths_ = 0;
};

}  // namespace lucerna::session
