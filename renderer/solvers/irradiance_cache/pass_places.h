#pragma once
// Places of a pass for display: candidates, tried ones and chosen ones. Kept until the next pass begins.
#include <cstdint>
#include <vector>

#include "solvers/irradiance_cache/placement.h"
#include "solvers/irradiance_cache/stages.h"

namespace lucerna::irradiance_cache {

/// `radii`: of the tried places; `chosen`: indices into them. Each is empty until its stage has ended.
class PassPlaces {
 public:
  Placement candidates;
  std::vector<Place> tried;
  std::vector<float> radii;
  std::vector<uint32_t> chosen;

  PassPlaces(gpu::Device& device, gpu::ShaderCompiler& compiler) : candidates(device, compiler) {}
  void forget() {
    candidates.clear();
    tried.clear(), chosen.clear(), radii.clear();
    changed();
  }
  /// Call after any change, so that the display is updated.
  void changed() { ++version_; }
  /// Reads the candidates from the device if they have changed.
  PlacementShown shown() {
    if (shown_version_ != version_) shown_ = candidates.choice(), shown_version_ = version_;
    return {shown_.candidates, shown_.cluster, tried, radii, chosen, version_};
  }

 private:
  uint64_t version_ = 0;
  Choice shown_;  // candidates of the last read
  uint64_t shown_version_ = ~0ull;
};

}  // namespace lucerna::irradiance_cache
