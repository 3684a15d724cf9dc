#pragma once
// What overlays are drawn on: a picture, with what its film knows of the surfaces that it shows.
#include <functional>

#include "film/film.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// The wavefront must have the picture's frame; its stream has been submitted. Where the film has no samples,
/// the coarse film provides the visible surfaces (shared::k_coarse_step).
struct Canvas {
  transport::Wavefront& wavefront;
  const film::Film& film;
  const film::Film& coarse;
  /// Called by long operations; true: the picture is out of date already, and drawing may stop.
  std::function<bool()> cancel = {};

  uint32_t width() const { return film.width(); }
  uint32_t height() const { return film.height(); }
  uint64_t pixels() const { return uint64_t{film.width()} * film.height(); }
  gpu::Stream& stream() const { return wavefront.stream(); }
  /// What shaders/overlay/seen.glsl reads, and the picture, in place of what was in the table.
  void bind(gpu::Resources& resources) const;
  /// Runs the recorded commands; not part of the picture's cost.
  void finish() const;
};

}  // namespace lucerna::overlay
