#pragma once
// The pilot of a picture: a few path-traced samples in a small picture of the same view, from which the
// solvers of components with the setting auto are chosen (plan/choose.h).
#include <functional>
#include <memory>

#include "base/timer.h"
#include "film/film.h"
#include "schedule/uniform.h"
#include "session/engine.h"
#include "solvers/prospect.h"

namespace lucerna::session {

class Pilot {
 public:
  /// Samples of each of its pixels, and its pixels per pixel of the picture (at most k_most_pixels): together
  /// about half a sample of a small picture, less of a large one.
  static constexpr uint32_t k_samples = 4;
  static constexpr double k_share = 1.0 / 8, k_most_pixels = 256 * 144;

  /// For a picture of that size. Throws Error: memory.
  Pilot(gpu::Device& device, const Engine& engine, uint32_t width, uint32_t height);
  /// Traces one work item. False if cancelled: it will be repeated. The engine's frame is the picture's
  /// again.
  bool step(Engine& engine, const PictureView& picture, const std::function<bool()>& cancel);
  bool done() const { return schedule_.done(); }
  /// Requires done(). Depends on scene, view, settings and seed only, except its duration. `learns`: the
  /// picture's paths will learn which lights arrive (lights.sampling), the pilot's do not.
  solvers::Findings findings(bool learns) const;

 private:
  uint32_t width_, height_;  ///< of the picture
  film::Film film_;
  schedule::UniformSchedule schedule_;
  bool begun_ = false;
  double pixel_seconds_ = 0;  ///< of a sample of a pixel
};

}  // namespace lucerna::session
