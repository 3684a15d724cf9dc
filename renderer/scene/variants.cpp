#include "scene/variants.h"

#include <algorithm>

#include "base/error.h"

namespace lucerna::scene {

std::shared_ptr<const Scene> with_variant(std::shared_ptr<const Scene> scene, const std::string& name,
                                          const std::string& where) {
  if (name.empty()) return scene;
  const auto found = std::find(scene->variants.begin(), scene->variants.end(), name);
  if (found == scene->variants.end())
    throw_error(where, "the scene has no variant '{}'; it has {}", name,
                scene->variants.empty() ? "none" : fmt::format("{}", fmt::join(scene->variants, ", ")));
  const auto variant = static_cast<size_t>(found - scene->variants.begin());
  auto other = std::make_shared<Scene>(*scene);
  for (Mesh& mesh : other->meshes)
    for (Primitive& p : mesh.primitives)
      if (variant < p.variants.size() && p.variants[variant] != k_none) p.material = p.variants[variant];
  return other;
}

std::shared_ptr<const Scene> with_plain_catchers(std::shared_ptr<const Scene> scene) {
  const auto catches = [](const Material& m) { return m.shadow_catcher; };
  if (std::none_of(scene->materials.begin(), scene->materials.end(), catches)) return scene;
  auto other = std::make_shared<Scene>(*scene);
  for (Material& m : other->materials) {
    if (!m.shadow_catcher) continue;
    Material plain;
    plain.name = m.name, plain.group = m.group, plain.shadow_catcher = true;
    plain.metallic = 0, plain.specular = 0;
    m = plain;
  }
  return other;
}

std::shared_ptr<const Scene> in_clay(std::shared_ptr<const Scene> scene) {
  auto other = std::make_shared<Scene>(*scene);
  for (Material& m : other->materials) {
    if (m.unlit || m.shadow_catcher || m.transmission > 0 || m.diffuse_transmission > 0 ||
        m.emission != vec3(0))
      continue;
    Material clay;
    clay.name = m.name, clay.group = m.group;
    clay.base_color = vec4(vec3(k_clay_reflectance), m.base_color.w);
    clay.metallic = 0, clay.specular = 0;
    clay.alpha_mode = m.alpha_mode, clay.alpha_cutoff = m.alpha_cutoff;
    // Its alpha alone is wanted; its colour stays with it.
    if (m.alpha_mode != AlphaMode::opaque) clay.base_color_texture = m.base_color_texture;
    clay.double_sided = m.double_sided;
    m = clay;
  }
  return other;
}

}  // namespace lucerna::scene
