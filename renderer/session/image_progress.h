#pragma once
// Time, cost and error of an image as its samples arrive, and the reference picture that it is compared with.
// Errors are of the film: GroupMix::settle() first.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/timer.h"
#include "film/error.h"
#include "film/io/reference.h"
#include "session/sampling.h"
#include "session/setup.h"
#include "stats/ledger.h"

namespace lucerna::session {

class ImageProgress {
 public:
  /// Both must outlive it.
  ImageProgress(const Setup& setup, const Sampling& sampling) : setup_(setup), sampling_(sampling) {}

  /// Another image begins.
  void restart();
  /// Errors so far belong to another picture of these samples.
  void forget_errors() { ledger_.clear(); }

  /// The clock counts the wall time of the image [s] from resume() to rest().
  void resume() { clock_.go(); }
  void rest() { clock_.stop(); }
  double seconds() const { return clock_.seconds(); }
  void add_render_seconds(double seconds) { render_s_ += seconds; }
  /// Part of seconds() that Renderer::step() has spent tracing this image (stats::Entry::render_s).
  double render_seconds() const { return render_s_; }
  /// Everything so far was preparation before the first sample.
  void note_prepared();
  /// Part of seconds() until solvers had prepared the data of the first sample.
  double prepared_seconds() const { return prepared_s_; }
  /// Part of the wavefront's statistics from then.
  const transport::TransportStats& prepared() const { return prepared_; }

  /// Estimates the error from all pixels of the region that gets samples; a pass over the film.
  film::ImageError estimate_error() const;
  /// Squared error as seen of every block, in raster order: mean over its pixels; 0 without samples. A pass
  /// over the film.
  std::vector<float> block_squares() const;
  /// Estimated error of every tile of sampling.tile, in raster order, with heavy tails marked; as of the last
  /// estimate.
  std::vector<film::TileError> tile_errors() const;
  /// True once the lookup-error estimate is complete (film::LookupsError).
  bool lookup_errors_known() const;
  /// False if some solver's lookups have a bias that none of these errors contains.
  bool lookup_bias_estimated() const;
  /// Error not contained in these, which only estimate noise: plan::Plan::bias of the current settings;
  /// nullopt before the first scene.
  std::optional<double> bias(size_t component) const;
  /// Adds an entry to the ledger if it is time for one, or at once.
  void note(bool at_once);
  /// Cost and error of the image over time.
  const stats::Ledger& ledger() const { return ledger_; }
  /// Device time per sample a pixel, by component, without preparation; 0 before the first sample.
  ByComponent<double> component_ms_a_sample() const;

  /// Compares further samples with this reference picture: ledger entries then contain the true error. Throws
  /// Error like film::read_reference, or without a scene; the former reference then stays. Entries have no
  /// true error while the picture has another size, camera or scene than the reference.
  void set_reference(const std::filesystem::path& file);
  void clear_reference() { reference_.reset(); }
  /// Null if there is none.
  const film::Reference* reference() const { return reference_ ? &*reference_ : nullptr; }
  /// True if the reference shows the present picture.
  bool reference_applies() const;

 private:
  const transport::TransportStats& stats() const { return setup_.engine->wavefront().stats(); }
  std::optional<stats::Band> total_rays() const;  ///< at the end of adaptive sampling

  const Setup& setup_;
  const Sampling& sampling_;
  stats::Ledger ledger_;
  std::optional<film::Reference> reference_;
  Stopwatch clock_;
  double render_s_ = 0, prepared_s_ = 0;
  transport::TransportStats prepared_;
};

}  // namespace lucerna::session
