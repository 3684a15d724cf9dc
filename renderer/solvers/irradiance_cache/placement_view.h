#pragma once
// Draws how the places of records are chosen over the picture: what has been asked for, how that was cut into
// clusters, what of it is tried and what becomes a record. What is hidden stays hidden
// (overlay/painter.h).
#include <memory>
#include <string>

#include "shaders/shared/irradiance_cache/placement_view.h"
#include "solvers/irradiance_cache/inspector.h"
#include "solvers/irradiance_cache/stages.h"

namespace lucerna::irradiance_cache {

/// The points to draw, those with a ring first; their number is returned by `rings`. No more than `most`:
/// candidates are left out evenly, then of what is tried the last. Pure.
std::vector<shared::PlacedPoint> placement_points(PlacementShow drawn, const PlacementShown& placement,
                                                  size_t most, uint32_t& rings);

class PlacementView {
 public:
  /// Both must outlive it.
  PlacementView(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~PlacementView();
  /// Over the film's picture, which is dimmed where there is anything to draw; the stream is run. Throws
  /// Error when a kernel does not compile.
  void draw(const overlay::Canvas& canvas, const Cache& cache, PlacementShow show);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
