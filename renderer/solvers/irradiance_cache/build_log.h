#pragma once
// What the passes of a cache's building brought and took.
#include <array>
#include <cstdint>

#include "solvers/irradiance_cache/stages.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

enum class BuildStep {
  probe,     ///< paths from the camera, to find where records are missing
  screen,    ///< where geometry or irradiance changes in the picture
  choose,    ///< which of the places asked for get one
  measure,   ///< a few rays from each, to see how wide its record would be and whether it is needed
  evaluate,  ///< rays over the records' hemispheres
  radius,    ///< how far each of them serves
  octree     ///< how they are found
};
inline constexpr StepText k_step_texts[] = {
    {"probe", "Paths from the camera, to find where records are missing."},
    {"screen", "Where geometry or irradiance changes in the picture: there more places ask for records."},
    {"choose", "Which of the places asked for get a record. On the host."},
    {"measure",
     "A few rays from each of these, to see how wide its record would be and whether it is needed."},
    {"evaluate", "Rays over the records' hemispheres, and their sums."},
    {"radius", "How far each new record serves."},
    {"octree", "The octree by which records are found."},
};
static_assert(std::size(k_step_texts) == size_t(BuildStep::octree) + 1);
inline constexpr auto k_build_steps = names_of(k_step_texts);

struct CachePass {
  uint32_t number = 0;  ///< since the building was begun or extended; that of its records
  bool complete = false;
  bool relit = false;  ///< its records were placed before; their light was gathered anew
  /// Paths that asked for a record, paths: of the whole picture, of which part may have been looked at
  /// (ProbedBlocks).
  uint64_t uncovered = 0, paths = 0;
  uint64_t uncovered_world = 0;  ///< of those that asked: not at a surface that the camera sees straight
  uint64_t screen = 0;           ///< candidates by dithering the picture
  uint64_t candidates = 0;       ///< in all
  uint32_t clusters = 0;         ///< that they were cut into
  uint32_t tried = 0;            ///< chosen of them, and measured
  uint32_t records = 0;          ///< placed, or relit
  uint64_t rays = 0;             ///< from them
  /// By BuildStep: device time of the stages that it ran, wall time of what the host did (its tracer too).
  std::array<double, k_build_steps.size()> ms{};
  double total_ms() const {
    double sum = 0;
    for (const double m : ms) sum += m;
    return sum;
  }
};

/// Time of the wavefront's stages since its making: of the device, and of the host's tracer.
class StageTimer {
 public:
  explicit StageTimer(transport::Wavefront& wavefront)
      : wavefront_(wavefront), before_((wavefront.account_stages(), total())) {}
  double milliseconds() {
    wavefront_.account_stages();
    return total() - before_;
  }

 private:
  double total() const {
    double sum = 0;
    for (const transport::StageSum& s : wavefront_.stats().stages) sum += s.ms;
    return sum;
  }
  transport::Wavefront& wavefront_;
  double before_;
};

}  // namespace lucerna::irradiance_cache
