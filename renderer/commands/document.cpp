#include "commands/document.h"

namespace lucerna::commands {

Document::Material Document::of(const scene::Material& m) {
  return {.color = vec3(m.base_color),
          .roughness = m.roughness,
          .metallic = m.metallic,
          .emission = m.emission,
          .clearcoat = m.clearcoat,
          .clearcoat_roughness = m.clearcoat_roughness,
          .sheen_color = m.sheen_color,
          .sheen_roughness = m.sheen_roughness,
          .anisotropy = m.anisotropy,
          .anisotropy_rotation = m.anisotropy_rotation,
          .dispersion = m.dispersion,
          .iridescence = m.iridescence,
          .iridescence_maximum = m.iridescence_maximum};
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
  m.clearcoat = clearcoat, m.clearcoat_roughness = clearcoat_roughness;
  m.sheen_color = sheen_color, m.sheen_roughness = sheen_roughness;
  m.anisotropy = anisotropy, m.anisotropy_rotation = anisotropy_rotation;
  m.dispersion = dispersion;
  m.iridescence = iridescence, m.iridescence_maximum = iridescence_maximum;
}

}  // namespace lucerna::commands
