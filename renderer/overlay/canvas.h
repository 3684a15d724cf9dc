#pragma once
// Target of overlays: a sheet over the picture, with the visible surfaces of its pixels.
#include <functional>

#include "film/film.h"
#include "overlay/sheet.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// The wavefront's frame must be the picture's; its stream is run. Surfaces are those traced for the sheet,
/// or before these are known, those of the film's samples, and of the coarse film (shared::k_coarse_step) in
/// pixels without samples.
struct Canvas {
  transport::Wavefront& wavefront;
  const film::Film& film;
  const film::Film& coarse;
  const Sheet& sheet;
  /// Called during long operations; true: the picture is outdated, and drawing may be omitted.
  std::function<bool()> cancel = {};

  /// True: pixels are those of the film, for values computed once per pixel of the picture.
  bool of_film = false;
  Canvas at_film() const { return {wavefront, film, coarse, sheet, cancel, true}; }

  uint32_t scale() const { return of_film ? 1 : sheet.scale(); }  ///< pixels per pixel of the film
  uint32_t width() const { return scale() * film.width(); }
  uint32_t height() const { return scale() * film.height(); }
  uint64_t pixels() const { return uint64_t{width()} * height(); }
  const gpu::Buffer& picture() const { return of_film ? film.picture() : sheet.picture(film); }
  gpu::Stream& stream() const { return wavefront.stream(); }
  /// Binds the resources of shaders/overlay/seen.glsl, and the picture, replacing all earlier bindings.
  void bind(gpu::Resources& resources) const;
  /// Runs the recorded commands; not part of the picture's cost.
  void finish() const;
};

}  // namespace lucerna::overlay
