#pragma once
// Stages of building and where it pauses. Pure state; no device.
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

/// Stages of a pass in order. Evaluation is one stage for each ray level; `octree` follows the first.
enum class BuildStage {
  probe,     ///< finds places without records: candidates
  choose,    ///< cuts them into clusters and selects the ones to try
  measure,   ///< measures distances around them, and so the radii of their records
  thin,      ///< selects the ones to keep
  evaluate,  ///< traces one level of rays
  octree     ///< sets radii and builds the octree
};
/// Name and description of a step.
struct StepText {
  const char *name, *help;
};
template <size_t N>
constexpr std::array<const char*, N> names_of(const StepText (&texts)[N]) {
  std::array<const char*, N> names{};
  for (size_t i = 0; i < N; ++i) names[i] = texts[i].name;
  return names;
}

inline constexpr StepText k_stage_texts[] = {
    {"probe", "Camera paths find places without records: candidates."},
    {"choose",
     "Candidates are sorted in Morton order and cut into clusters; from each, places are drawn until all are "
     "covered."},
    {"measure", "A few rays from each tried place: the radius of its record."},
    {"thin", "Places that a wider record covers are rejected, the rest is chosen."},
    {"evaluate", "Rays over the hemispheres of the records, in levels of four times as many."},
    {"octree", "Radii of the records, and the octree for lookups."},
};
static_assert(std::size(k_stage_texts) == size_t(BuildStage::octree) + 1);
inline constexpr auto k_build_stages = names_of(k_stage_texts);

/// A stage that has ended.
struct StageDone {
  BuildStage stage = BuildStage::probe;
  uint32_t level = 0;  ///< of evaluate: from 1
  uint32_t pass = 0;   ///< as CachePass::number
  double ms = 0;       ///< duration, as CachePass::ms
  uint64_t rays = 0;   ///< rays of records in this stage
};

/// "probe, pass 1", "evaluate 256 rays" and the like.
std::string stage_words(const StageDone& done);

/// Where building pauses: the values of the setting cache.pause, in its order.
enum class PauseAfter { off, pass, stage };

/// Decides when building pauses. It never pauses once complete.
class Pauses {
 public:
  /// Takes effect at the next end of a stage; `off` also ends a pause.
  void set(PauseAfter after) {
    if (after_ != after && after == PauseAfter::off) waits_ = false;
    after_ = after;
  }
  PauseAfter after() const { return after_; }
  /// Continues to the end of the next stage and pauses there, whatever is set.
  void step() { waits_ = running_ = false, single_ = true; }
  /// Continues until building is complete, whatever is set.
  void run() { waits_ = single_ = false, running_ = true; }

  /// Call when a stage has ended; `last`: of its pass.
  void ended(bool last) {
    const bool requested = !running_ && (after_ == PauseAfter::stage || (after_ == PauseAfter::pass && last));
    waits_ = single_ || requested;
    single_ = false;
  }
  /// Call when the state of the pause is dropped: there is work again.
  void dropped() { waits_ = false; }
  /// Call when building is complete: single-step requests end, the setting stays.
  void complete() { waits_ = single_ = running_ = false; }
  bool waits() const { return waits_; }

 private:
  PauseAfter after_ = PauseAfter::off;
  bool waits_ = false, single_ = false, running_ = false;
};

/// Places of the current or last pass, as far as known; a list is empty before its stage has ended. Valid
/// until the cache changes.
struct PlacementShown {
  std::span<const Place> candidates;
  std::span<const uint32_t> cluster;  ///< cluster of each candidate
  std::span<const Place> tried;       ///< some of the candidates
  std::span<const float> radii;       ///< radii of the tried places [m]
  std::span<const uint32_t> kept;     ///< chosen ones: rising indices into `tried`
  uint64_t version = 0;               ///< changes with any of them
};

/// The values of the setting overlay.placement, in its order.
enum class PlacementShow {
  off,
  stage,       ///< everything known so far
  candidates,  ///< candidates by origin
  clusters,    ///< candidates by cluster, and the tried ones
  chosen       ///< tried ones, kept or dropped, with their radii
};

/// What to draw: never `stage`; `off` if there are no candidates.
PlacementShow placement_drawn(PlacementShow show, const PlacementShown& placement);

}  // namespace lucerna::irradiance_cache
