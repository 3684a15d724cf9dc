#pragma once
// Recognizes a return to light that a picture has shown before: an edit undone, a lamp moved back. The window
// then goes on from that picture (film::Preview::put_back) instead of from the light of the edit.
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/math.h"
#include "scene/scene.h"

namespace lucerna::session {

/// What determines the light of a picture, apart from how it is computed.
struct LightState {
  std::shared_ptr<const scene::Scene> scene;    ///< as lit (Relight::lit)
  std::map<std::string, std::string> settings;  ///< all of them
  scene::Lens lens;                             ///< another one mixes the light of other surfaces
  std::vector<vec3> weights;                    ///< of separate light groups
};

/// True if pictures of both show the same light from the same place.
bool same_light(const LightState& a, const LightState& b);
/// True if pictures before and after a change of that setting show the same light.
bool keeps_light(const std::string& key, const std::string& before, const std::string& after);

/// Gives the light of pictures numbers, from 1: the same for the same light, as long as it is remembered.
class FormerLight {
 public:
  /// A picture begins in this light, of a scene. Returns its number.
  uint64_t begin(LightState state);
  /// Number of the light of the present picture; 0 before the first.
  uint64_t present() const { return states_.empty() ? 0 : states_.front().number; }

 private:
  struct Numbered {
    uint64_t number;
    LightState state;
  };
  std::deque<Numbered> states_;  ///< the present one first
  uint64_t last_ = 0;
};

}  // namespace lucerna::session
