#pragma once
// What the window shows of accuracy: the ledger of the image in progress, its tiles, its passes. Kept on the
// session's thread, published as a whole.
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

class Renderer;

struct TileStatus {
  float error = -1;                      ///< relative, of the paths; negative: not known
  float records = 0, interpolation = 0;  ///< ... and of what they look up
  float sum() const { return error < 0 ? error : error_sum(error, records, interpolation); }
  uint32_t samples = 0;
  uint32_t pixels = 0;
  /// The same with a half to a quarter of the samples, in adaptive sampling; 0: not known.
  float earlier_error = 0;
  uint32_t earlier_samples = 0;
  uint32_t state = shared::k_tile_waiting;  ///< shared::k_tile_*
  bool heavy_tailed = false;
};

/// One pass over the picture, or over the tiles at work.
struct PassStatus {
  std::vector<float> stage_ms;  ///< of Accuracy::stages, in their order; later stages may be missing
  uint64_t paths = 0;
  uint32_t samples = 0;  ///< a pixel of those that took part; the most
};

struct Accuracy {
  uint64_t run = 0;  ///< grows with every image that is begun
  uint64_t scene_id = 0;
  std::map<std::string, std::string> settings;  ///< all, as they are
  bool adaptive = false, finished = false;
  double target = 0.05;                     ///< sampling.target_error
  double min_samples = 0, max_samples = 0;  ///< a pixel
  uint32_t tile = 16, across = 0;           ///< side of a tile in pixels, tiles in a row
  double paths = 0, rays = 0, pixels = 1;   ///< so far; of the picture
  stats::Ledger ledger;
  /// For each line of the ledger the error of the hardest tile that was not given up; 0: not known.
  std::vector<double> hardest;
  /// Raster order; none in uniform sampling while they are not shown. Flags only while they are.
  std::vector<TileStatus> tiles;
  /// seconds_to(target), in adaptive sampling.
  std::optional<stats::Band> forecast;
  std::vector<std::string> stages;
  std::deque<PassStatus> passes;  ///< the newest last
  std::string reference;          ///< file name of the picture taken for the truth; "" for none
  bool reference_applies = false;
  /// Relative, of each component's mean; none: the solver cannot tell, or the component is off. The ledger's
  /// errors are of the noise alone.
  std::array<std::optional<double>, stats::k_layers - 1> bias;

  /// The sum's and the components' errors by the last line; all 0 before the first.
  std::array<double, stats::k_layers> error() const;
  /// Tiles in that state.
  uint32_t count(uint32_t state) const;
};

/// Seconds of rendering, from the image's start, until it has that error: in uniform sampling the sum's
/// (stats::seconds_to); in adaptive sampling every tile's, as the rays that the tiles still need times what
/// a ray has taken lately. Nothing before there is enough to tell by.
std::optional<stats::Band> seconds_to(const Accuracy& accuracy, double target);

/// Tiles that in adaptive sampling are not expected to come under the target with the most samples that a
/// pixel is given (Accuracy::max_samples).
uint32_t tiles_out_of_reach(const Accuracy& accuracy, double target);

/// Seconds of rendering, from the image's start, at which uniform sampling has all its samples (`samples`).
/// Nothing in adaptive sampling, nor before the first line of the ledger.
std::optional<double> seconds_to_end(const Accuracy& accuracy);

/// The tiles of the image in progress; errors are those of the last estimate. `flags`: heavy tails are
/// marked, which takes a look at the whole film.
std::vector<TileStatus> tile_status(const Renderer& renderer, bool flags);

/// Follows a renderer; one thread.
class AccuracyKeeper {
 public:
  /// Call after every step and command: notes passes and lines of the ledger. Cheap when there is nothing
  /// new.
  void follow(const Renderer& renderer, uint64_t scene_id);
  /// What there is, anew where something has changed since (`tiles`: tiles and settings too).
  std::shared_ptr<const Accuracy> publish(const Renderer& renderer, bool tiles);

 private:
  void note_pass(const Renderer& renderer);

  Accuracy now_;
  std::shared_ptr<const Accuracy> published_;
  bool changed_ = true;
  uint64_t restarts_ = ~0ull;
  uint32_t passes_ = 0;
  std::vector<double> pass_ms_;  ///< of the stages when the pass began
  uint64_t pass_paths_ = 0;
};

}  // namespace lucerna::session
