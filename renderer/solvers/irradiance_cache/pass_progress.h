#pragma once
// How far building has come: what of the picture has been asked, and how long stages have taken. No device:
// pure state.
#include <array>
#include <cstdint>
#include <optional>

#include "schedule/uniform.h"
#include "solvers/irradiance_cache/build_log.h"
#include "solvers/irradiance_cache/probed_blocks.h"

namespace lucerna::irradiance_cache {

/// How the picture is looked at, in this pass and in those before.
struct PictureProbing {
  ProbedBlocks blocks;                 ///< of the picture, that this pass looks along
  schedule::UniformSchedule schedule;  ///< of paths along these; it holds only while `begun`
  /// Paths of this pass that asked for a record, by shared::k_origin_*, and paths: of the whole picture.
  std::array<double, 3> uncovered{};
  double paths = 0;
  bool begun = false;         ///< probing, in this pass
  bool screen_done = false;   ///< the screen-space stage, in this pass
  bool camera_moved = false;  ///< since the last pass began
  uint32_t paths_before = 0;  ///< a pixel, of the passes before: each looks along paths of its own
  /// Paths ask beyond the picture's lookups too in the first passes, where the cache reads itself.
  bool probes_beyond = true;
  /// This pass is the last: few ask, but these may stand side by side.
  bool filling = false;

  /// Passes are counted from the beginning.
  void restart(bool beyond) {
    paths_before = 0;
    probes_beyond = beyond;
    filling = false;
  }
};

/// Further light for records that have some, once building is complete.
struct Refining {
  bool under_way = false;
  uint32_t level = 0;  ///< records that have had the rays of levels up to this one are looked at next
  float noise = 1;     ///< what records may have, over that of building
};

/// Times the stages of a pass by what the pass has taken so far.
class StageClock {
 public:
  /// A pass begins.
  void restart() { ms_before_ = 0, rays_before_ = 0; }
  /// A stage of it has ended.
  StageDone end(BuildStage stage, const CachePass& pass) {
    const double ms = pass.total_ms();
    const StageDone done{
        .stage = stage, .pass = pass.number, .ms = ms - ms_before_, .rays = pass.rays - rays_before_};
    ms_before_ = ms, rays_before_ = pass.rays;
    return done;
  }

 private:
  double ms_before_ = 0;  // of this pass, at the end of the stage that ended last
  uint64_t rays_before_ = 0;
};

}  // namespace lucerna::irradiance_cache
