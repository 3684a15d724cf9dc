#pragma once
// Results and times of the passes of building.
#include <array>
#include <cstdint>

#include "solvers/irradiance_cache/stages.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

enum class BuildStep {
  probe,     ///< traces camera paths to find where records are missing
  screen,    ///< finds where geometry or irradiance changes in the picture
  choose,    ///< chooses among the candidates
  measure,   ///< traces a few rays from each: its radius, and whether it is needed
  evaluate,  ///< traces rays over the records' hemispheres
  radius,    ///< computes radii of validity
  octree     ///< builds the octree for lookups
};
inline constexpr StepText k_step_texts[] = {
    {"probe", "Traces camera paths to find where records are missing."},
    {"screen", "Finds where geometry or irradiance changes in the picture: more candidates there."},
    {"choose", "Chooses among the candidates. On the host."},
    {"measure", "Traces a few rays from each: the radius of its record, and whether it is needed."},
    {"evaluate", "Traces rays over the records' hemispheres and sums them."},
    {"radius", "Computes the radii of new records."},
    {"octree", "Builds the octree for lookups."},
};
static_assert(std::size(k_step_texts) == size_t(BuildStep::octree) + 1);
inline constexpr auto k_build_steps = names_of(k_step_texts);

struct CachePass {
  uint32_t number = 0;  ///< number since building began or was extended; stored in its records
  bool complete = false;
  bool relit = false;  ///< its records existed before; their light was gathered again
  /// Paths that found no record; all paths. For the whole picture, extrapolated from the probed part
  /// (ProbedBlocks).
  uint64_t uncovered = 0, paths = 0;
  uint64_t uncovered_world = 0;  ///< of these, paths not at a directly visible surface
  uint64_t screen = 0;           ///< candidates from dithering the picture
  uint64_t candidates = 0;       ///< all candidates
  uint32_t clusters = 0;         ///< clusters of the candidates
  uint32_t tried = 0;            ///< places drawn from them and measured
  uint32_t records = 0;          ///< records placed or relit
  uint64_t rays = 0;             ///< rays of the records
  /// By BuildStep: device time of the stages, and wall time of host work (including its tracer).
  std::array<double, k_build_steps.size()> ms{};
  double uncovered_share() const { return double(uncovered) / double(paths); }  ///< requires paths > 0
  double total_ms() const {
    double sum = 0;
    for (const double m : ms) sum += m;
    return sum;
  }
};

/// Time of the wavefront's stages since construction: device, and the host's tracer.
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
