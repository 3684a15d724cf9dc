#pragma once
// The filtered picture that the window shows between samples: when it is made, and its error as samples are
// added.
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "film/film.h"
#include "session/display.h"
#include "session/filtered.h"

namespace lucerna::session {

class WindowFilter {
 public:
  WindowFilter(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

  /// State of the picture to be filtered.
  struct Progress {
    uint32_t samples = 0;  ///< of every pixel
    uint64_t paths = 0;
    double render_s = 0;  ///< time spent on its samples
    bool done = false;
    bool prepares = false;  ///< more samples wait for lookup data or for learning
  };
  /// True if step() has work: after some samples, again after twice as many, and at the end. Sampling waits
  /// meanwhile.
  bool due(const Progress& at) const;
  /// Runs one work item. `shown`: the window's view. If memory does not suffice, logs a warning and ends
  /// until retry(). A result that is worse than the shown preview is not used.
  void step(Engine& engine, const PictureView& view, Display& display, const FilterJob& job,
            const film::View& shown, const Progress& at, const std::function<bool()>& cancel);
  /// Estimates the error of the result again, if there are enough samples that it has not used.
  void judge(Engine& engine, Display& display, const film::Film& film, uint64_t paths);
  /// The latest result for this picture; null: none.
  const Filtered* result() const { return result_ ? &*result_ : nullptr; }
  /// True if there is a new result since the last call.
  bool news() { return std::exchange(news_, false); }
  /// Call when another picture begins: discards the result and the work.
  void forget();
  /// Call when there may be enough memory again.
  void retry() { fails_ = false; }
  /// Call when kernels must be compiled again.
  void reset_kernels() { filter_.reset(); }

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::unique_ptr<PictureFilter> filter_;  ///< made at the first use
  std::optional<Filtered> result_;
  bool fails_ = false, news_ = false;
  uint64_t filtered_paths_ = 0;        ///< of the latest filtering, used or not; 0: none
  uint64_t judged_paths_ = 0;          ///< at the latest error estimate
  double filter_s_ = 0, piece_s_ = 0;  ///< filtering time: of the latest result, and of the current one
  double filtered_at_s_ = 0;           ///< Progress::render_s then
};

}  // namespace lucerna::session
