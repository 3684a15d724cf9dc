#include "plan/traced_scene.h"

#include "plan/facts.h"
#include "plan/plan.h"
#include "scene/variants.h"

namespace lucerna::plan {

std::shared_ptr<const scene::Scene> traced_scene(std::shared_ptr<const scene::Scene> scene,
                                                 const Settings& settings) {
  scene = scene::with_variant(std::move(scene), settings.text("scene.variant"), "scene.variant");
  if (settings.boolean("scene.clay")) scene = scene::in_clay(std::move(scene));
  return scene::with_plain_catchers(without_effects(std::move(scene), effects_off(settings)));
}

std::string traced_scene_key(const Settings& settings) {
  std::string key;
  for (const char* name : k_traced_scene_settings) key += settings.text(name) + '\n';
  return key;
}

}  // namespace lucerna::plan
