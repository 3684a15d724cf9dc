#pragma once
// What overlays are drawn on: a sheet over the picture, with the surfaces that its pixels show.
#include <functional>

#include "film/film.h"
#include "overlay/sheet.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// The wavefront's frame must be the picture's; its stream is run. Surfaces are those traced for the sheet;
/// before these are known, those of the film's samples, and of the coarse film (shared::k_coarse_step) where
/// there are none.
struct Canvas {
  transport::Wavefront& wavefront;
  const film::Film& film;
  const film::Film& coarse;
  const Sheet& sheet;
  /// Asked by what takes long: true when the picture is out of date already. What is drawn may then be left
  /// out.
  std::function<bool()> cancel = {};

  /// True: pixels are the film's, for what is computed once per pixel of the picture.
  bool of_film = false;
  Canvas at_film() const { return {wavefront, film, coarse, sheet, cancel, true}; }

  uint32_t scale() const { return of_film ? 1 : sheet.scale(); }  ///< pixels per pixel of the film
  uint32_t width() const { return scale() * film.width(); }
  uint32_t height() const { return scale() * film.height(); }
  uint64_t pixels() const { return uint64_t{width()} * height(); }
  const gpu::Buffer& picture() const { return of_film ? film.picture() : sheet.picture(film); }
  gpu::Stream& stream() const { return wavefront.stream(); }
  /// Sets what shaders/overlay/seen.glsl reads, and the picture, in place of what was in the table.
  void bind(gpu::Resources& resources) const;
  /// Runs the recorded commands; not part of the picture's cost.
  void finish() const;
};

}  // namespace lucerna::overlay
