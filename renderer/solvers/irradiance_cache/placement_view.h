#pragma once
// Draws the choice of record places over the picture: candidates, their clusters, tried places and chosen
// ones. Hidden places stay hidden (overlay/painter.h).
#include <memory>
#include <string>

#include "shaders/shared/irradiance_cache/placement_view.h"
#include "solvers/irradiance_cache/inspector.h"
#include "solvers/irradiance_cache/stages.h"

namespace lucerna::irradiance_cache {

/// Points to draw, those with a ring first; `rings` returns their number. At most `most`: candidates are
/// thinned evenly first, then the last tried places are dropped. Pure.
std::vector<shared::PlacedPoint> placement_points(PlacementShow drawn, const PlacementShown& placement,
                                                  size_t most, uint32_t& rings);

class PlacementView {
 public:
  /// Both must outlive it.
  PlacementView(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~PlacementView();
  /// Draws over the film's picture, dimming it if there is anything to draw. The stream has been submitted.
  /// Throws Error if a kernel does not compile.
  void draw(const overlay::Canvas& canvas, const Cache& cache, PlacementShow show);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
