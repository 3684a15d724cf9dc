#pragma once
// What overlays are drawn on: a picture, with what its film knows of the surfaces that it shows.
#include <functional>

#include "film/film.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// The wavefront's frame must be the picture's; its stream is run. Where the film has no samples the coarse
/// film tells what is seen (shared::k_coarse_step).
struct Canvas {
  transport::Wavefront& wavefront;
  const film::Film& film;
  const film::Film& coarse;
  /// Asked by what takes long: true when the picture is out of date already. What is drawn may then be left
  /// out.
  std::function<bool()> cancel = {};

  uint32_t width() const { return film.width(); }
  uint32_t height() const { return film.height(); }
  uint64_t pixels() const { return uint64_t{film.width()} * film.height(); }
  gpu::Stream& stream() const { return wavefront.stream(); }
  /// What shaders/overlay/seen.glsl reads, and the picture, in place of what was in the table.
  void bind(gpu::Resources& resources) const;
  /// Runs what is recorded: it is no part of the picture's cost.
  void finish() const;
};

}  // namespace lucerna::overlay
