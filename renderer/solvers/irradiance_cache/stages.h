#pragma once
// The stages that building goes through, and where it waits for somebody who watches. No device: pure state.
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

/// Of a pass, in their order. Evaluation is a stage for each level of rays; `octree` comes behind the first.
enum class BuildStage {
  probe,     ///< the places where records are missing are known: candidates
  choose,    ///< they are cut into clusters, and it is known which of them are tried
  measure,   ///< how far things are around these, and so how wide their records would be
  thin,      ///< which of them are chosen
  evaluate,  ///< a level of their rays is gathered
  octree     ///< they have radii, and are found
};
/// What a step is called, and what it does.
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
    {"probe", "Paths from the camera ask where they find no record: candidates."},
    {"choose",
     "Candidates in Morton order are cut into clusters; of each, points are tried until all are covered."},
    {"measure", "A few rays from what is tried: how wide would its records be?"},
    {"thin", "What a wider one makes superfluous is rejected, the rest chosen."},
    {"evaluate", "Rays over the hemispheres of the records, a level of four times as many after the other."},
    {"octree", "Records have got their radii, and an octree in which they are found."},
};
static_assert(std::size(k_stage_texts) == size_t(BuildStage::octree) + 1);
inline constexpr auto k_build_stages = names_of(k_stage_texts);

/// A stage that has ended.
struct StageDone {
  BuildStage stage = BuildStage::probe;
  uint32_t level = 0;  ///< of evaluate: from 1
  uint32_t pass = 0;   ///< as CachePass::number
  double ms = 0;       ///< that it took, as CachePass::ms
  uint64_t rays = 0;   ///< from records, in it
};

/// "probe, pass 1", "evaluate 256 rays" and the like.
std::string stage_words(const StageDone& done);

/// Where building waits: the values of the setting cache.pause, in its order.
enum class PauseAfter { off, pass, stage };

/// Decides when building waits. It never waits once it is complete.
class Pauses {
 public:
  /// Holds from the next end of a stage on; to change it to `off` also ends a pause.
  void set(PauseAfter after) {
    if (after_ != after && after == PauseAfter::off) waits_ = false;
    after_ = after;
  }
  PauseAfter after() const { return after_; }
  /// Goes on to the end of the next stage and waits there, whatever is set.
  void step() { waits_ = running_ = false, single_ = true; }
  /// Goes on until building is complete, whatever is set.
  void run() { waits_ = single_ = false, running_ = true; }

  /// A stage has ended; `last`: of its pass.
  void ended(bool last) {
    const bool requested = !running_ && (after_ == PauseAfter::stage || (after_ == PauseAfter::pass && last));
    waits_ = single_ || requested;
    single_ = false;
  }
  /// What it waited behind is dropped: there is something to do again.
  void dropped() { waits_ = false; }
  /// Building is complete: what was asked for is over, what is set stays for the next.
  void complete() { waits_ = single_ = running_ = false; }
  bool waits() const { return waits_; }

 private:
  PauseAfter after_ = PauseAfter::off;
  bool waits_ = false, single_ = false, running_ = false;
};

/// What the pass that is being built, or else the last one, has done with the places that were asked for, as
/// far as it has come. Each list is empty before it is known. Valid until the cache is changed.
struct PlacementShown {
  std::span<const Place> candidates;
  std::span<const uint32_t> cluster;  ///< of each candidate
  std::span<const Place> tried;       ///< some of the candidates
  std::span<const float> radii;       ///< of what is tried [m]
  std::span<const uint32_t> kept;     ///< what is chosen: indices of what is tried, in rising order
  uint64_t version = 0;               ///< another number where any of them has changed
};

/// The values of the setting overlay.placement, in its order.
enum class PlacementShow {
  off,
  stage,       ///< as much as is known
  candidates,  ///< places asked for, by what asked
  clusters,    ///< the same by their clusters, and what of them is tried
  chosen       ///< what was tried, chosen or not, with the radii
};

/// What of it there is to be drawn: never `stage`, and `off` where nothing has been asked for.
PlacementShow placement_drawn(PlacementShow show, const PlacementShown& placement);

}  // namespace lucerna::irradiance_cache
