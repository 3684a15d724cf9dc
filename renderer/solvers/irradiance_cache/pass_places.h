#pragma once
// What becomes of the places that a pass asks for: candidates, some of which are tried, some of which are
// chosen. Kept for somebody who watches until the next pass begins.
#include <cstdint>
#include <vector>

#include "solvers/irradiance_cache/placement.h"
#include "solvers/irradiance_cache/stages.h"

namespace lucerna::irradiance_cache {

/// `radii` are of what is tried, `chosen` indices of it; each is empty until its stage has ended.
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
  /// Whoever changes any of it calls this, so that who watches looks anew.
  void changed() { ++version_; }
  /// Reads the candidates from the device when there have been changes.
  PlacementShown shown() {
    if (shown_version_ != version_) shown_ = candidates.choice(), shown_version_ = version_;
    return {shown_.candidates, shown_.cluster, tried, radii, chosen, version_};
  }

 private:
  uint64_t version_ = 0;
  Choice shown_;  // the candidates as they were last asked for
  uint64_t shown_version_ = ~0ull;
};

}  // namespace lucerna::irradiance_cache
