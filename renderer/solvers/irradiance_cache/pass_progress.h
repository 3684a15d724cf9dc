#pragma once
// Progress of building: probed part of the picture, and times of the stages. Pure state; no device.
#include <array>
#include <cstdint>
#include <optional>

#include "schedule/uniform.h"
#include "solvers/irradiance_cache/build_log.h"
#include "solvers/irradiance_cache/probed_blocks.h"

namespace lucerna::irradiance_cache {

/// Probing of the picture with paths, in this pass and before.
struct PictureProbing {
  ProbedBlocks blocks;                 ///< blocks that this pass probes
  schedule::UniformSchedule schedule;  ///< of their paths; valid only while `begun`
  /// Paths of this pass that found no record, by shared::k_origin_*, and all paths; extrapolated to the whole
  /// picture.
  std::array<double, 3> uncovered{};
  double paths = 0;
  bool begun = false;         ///< probing has begun in this pass
  bool screen_done = false;   ///< the screen-space stage of this pass is done
  bool camera_moved = false;  ///< since the last pass began
  uint32_t paths_before = 0;  ///< per pixel, in earlier passes; each pass uses new paths
  /// In the first passes of a cache that reads itself, vertices beyond the picture's lookups become
  /// candidates too.
  bool probes_beyond = true;
  /// This is the last pass: few paths find gaps, but these may be adjacent.
  bool filling = false;

  /// Counts passes from 0 again.
  void restart(bool beyond) {
    paths_before = 0;
    probes_beyond = beyond;
    filling = false;
  }
};

/// Refinement: more rays for existing records after building is complete.
struct Refining {
  bool under_way = false;
  uint32_t level = 0;  ///< records with the rays of levels up to this one are tested next
  float noise = 1;     ///< noise bound relative to that of building
};

/// Measures the stages of a pass as differences of the pass's totals.
class StageClock {
 public:
  /// Call when a pass begins.
  void restart() { ms_before_ = 0, rays_before_ = 0; }
  /// Call when a stage ends; returns its figures.
  StageDone end(BuildStage stage, const CachePass& pass) {
    const double ms = pass.total_ms();
    const StageDone done{
        .stage = stage, .pass = pass.number, .ms = ms - ms_before_, .rays = pass.rays - rays_before_};
    ms_before_ = ms, rays_before_ = pass.rays;
    return done;
  }

 private:
  double ms_before_ = 0;  // totals of this pass at the end of the latest stage
  uint64_t rays_before_ = 0;
};

}  // namespace lucerna::irradiance_cache
