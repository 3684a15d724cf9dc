#include "commands/document.h"

namespace lucerna::commands {

Document::Material Document::of(const scene::Material& m) {
  return {vec3(m.base_color), m.roughness, m.metallic, m.emission, true};
}

Document::Material Document::Material::in_scene() const {
  Material m = *this;
  if (!m.emits) m.emission = vec3(0);
  m.emits = true;
  return m;
}

void Document::Material::put(scene::Material& m) const {
  m.base_color = vec4(color, m.base_color.w);
  m.roughness = roughness, m.metallic = metallic, m.emission = emission;
}

}  // namespace lucerna::commands
