#include "session/former_light.h"

#include <algorithm>
#include <cassert>

#include "plan/settings.h"

namespace lucerna::session {
namespace {

/// A drag passes many states; undo returns to one of the last steps, of which film::Preview has two pictures.
constexpr size_t k_most = 64;

/// By their names, which say where they come from, as another edit may have read or made them again.
bool same_images(const SharedVector<scene::Image>& a, const SharedVector<scene::Image>& b) {
  return a.shares_with(b) ||
         std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
           return x.name == y.name && x.width == y.width && x.height == y.height;
         });
}

bool same_textures(const SharedVector<scene::Texture>& a, const SharedVector<scene::Texture>& b) {
  return a.shares_with(b) ||
         std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
           return x.image == y.image && x.wrap_u == y.wrap_u && x.wrap_v == y.wrap_v &&
                  x.nearest == y.nearest && x.srgb == y.srgb;
         });
}

bool same_environment(const scene::Environment& a, const scene::Environment& b) {
  return a.image == b.image && a.radiance == b.radiance && a.scale == b.scale && a.rotation == b.rotation &&
         a.file == b.file && a.sky == b.sky;
}

bool same_scene(const scene::Scene& a, const scene::Scene& b) {
  // Copies share what no edit has touched.
  return a.meshes.shares_with(b.meshes) && a.instances.shares_with(b.instances) && a.lights == b.lights &&
         a.materials == b.materials && same_environment(a.environment, b.environment) &&
         same_images(a.images, b.images) && same_textures(a.textures, b.textures);
}

}  // namespace

bool keeps_light(const std::string& key, const std::string& before, const std::string& after) {
  if (key.rfind("components.", 0) == 0) return before != "off" && after != "off";
  const OptionInfo* option = plan::find_option(key);
  return option && (option->same_light || !option->restarts);
}

bool same_light(const LightState& a, const LightState& b) {
  if (!a.scene || !b.scene || a.lens != b.lens || a.weights != b.weights || !same_scene(*a.scene, *b.scene))
    return false;
  if (a.settings.size() != b.settings.size()) return false;
  return std::all_of(a.settings.begin(), a.settings.end(), [&](const auto& setting) {
    const auto other = b.settings.find(setting.first);
    return other != b.settings.end() &&
           (other->second == setting.second || keeps_light(setting.first, setting.second, other->second));
  });
}

uint64_t FormerLight::begin(LightState state) {
  assert(state.scene);
  const auto found = std::find_if(states_.begin(), states_.end(),
                                  [&](const Numbered& n) { return same_light(n.state, state); });
  const uint64_t number = found == states_.end() ? ++last_ : found->number;
  if (found != states_.end()) states_.erase(found);
  states_.push_front({number, std::move(state)});
  // Another scene's are of no use, and would keep it in memory.
  std::erase_if(states_, [&](const Numbered& n) {
    return !n.state.scene || !n.state.scene->meshes.shares_with(states_.front().state.scene->meshes);
  });
  if (states_.size() > k_most) states_.pop_back();
  return number;
}

}  // namespace lucerna::session
