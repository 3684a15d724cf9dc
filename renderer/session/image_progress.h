#pragma once
// Time, cost and error of an image as its samples arrive, and the reference picture that it is compared with.
#include <array>
#include <filesystem>
#include <optional>
#include <string>

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

  /// The clock counts the wall time of the image from resume() to rest().
  void resume() { clock_.go(); }
  void rest() { clock_.stop(); }
  double seconds() const { return clock_.seconds(); }
  void add_render_seconds(double seconds) { render_s_ += seconds; }
  double render_seconds() const { return render_s_; }
  /// Everything so far was preparation before the first sample.
  void note_prepared();
  double prepared_seconds() const { return prepared_s_; }
  const transport::TransportStats& prepared() const { return prepared_; }

  /// Estimates the error from all pixels of the region that gets samples; a pass over the film.
  film::ImageError estimate_error() const;
  /// Adds an entry to the ledger if it is time for one, or at once.
  void note(bool at_once);
  const stats::Ledger& ledger() const { return ledger_; }
  /// Device time per sample a pixel, by component, without preparation; 0 before the first sample.
  std::array<double, shared::k_component_count> component_ms_a_sample() const;

  /// Renderer::set_reference
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
  double render_s_ = 0;    ///< part of the clock's time in Renderer::step()
  double prepared_s_ = 0;  ///< part of the clock's time before the first sample
  transport::TransportStats prepared_;
};

}  // namespace lucerna::session
