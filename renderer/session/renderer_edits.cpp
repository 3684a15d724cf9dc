// Edits of a renderer's scene: lights, environment, materials. What they spoil of the irradiance cache is
// said by irradiance_cache::changes().
#include <utility>

#include "session/renderer.h"

namespace lucerna::session {

void Renderer::set_light(uint32_t index, const scene::Light& light) {
  if (!scene_ || index >= scene_->lights.size()) throw_error("light", "there is no light {}", index);
  auto edited = std::make_shared<scene::Scene>(*scene_);
  edited->lights[index] = light;
  relight(edited, spoiled(scene::Change::lamp));
}

void Renderer::set_environment(float scale, float rotation_degrees) {
  if (!scene_) return;
  auto edited = std::make_shared<scene::Scene>(*scene_);
  edited->environment.scale = scale;
  edited->environment.rotation = rotation_degrees;
  relight(edited, spoiled(scene::Change::environment));
}

void Renderer::set_material(uint32_t index, const scene::Material& material) {
  if (!scene_ || index >= scene_->materials.size()) throw_error("material", "there is no material {}", index);
  auto edited = std::make_shared<scene::Scene>(*scene_);
  scene::Material& m = edited->materials[index];
  const scene::Material before = std::exchange(m, material);
  const auto same_use = [](const scene::TextureUse& a, const scene::TextureUse& b) {
    return a.texture == b.texture && a.uv_set == b.uv_set && a.m == b.m;
  };
  bool same = m.alpha_mode == before.alpha_mode && (m.transmission > 0) == (before.transmission > 0) &&
              (m.thickness > 0) == (before.thickness > 0);
  for (const auto use :
       {&scene::Material::base_color_texture, &scene::Material::metallic_roughness_texture,
        &scene::Material::normal_texture, &scene::Material::emission_texture,
        &scene::Material::specular_texture, &scene::Material::specular_color_texture,
        &scene::Material::transmission_texture, &scene::Material::diffuse_transmission_texture,
        &scene::Material::diffuse_transmission_color_texture})
    same &= same_use(m.*use, before.*use);
  if (!same)
    throw_error("material", "'{}': its textures, alpha mode, transmission and thickness cannot be changed",
                before.name);
  upload::flatten_factors(*edited, flat_);
  device_scene_->update_materials(*device_, flat_);
  // Where there was a diffuse colour there is one still, and no other lobe: the same places ask.
  const auto diffuse = [](const scene::Material& x) {
    return luminance(vec3(x.base_color)) > 0 && x.metallic < 1;
  };
  const bool colour = diffuse(before) && diffuse(material) && before.metallic == material.metallic &&
                      before.unlit == material.unlit &&
                      before.diffuse_transmission == material.diffuse_transmission &&
                      before.transmission == material.transmission;
  relight(edited, spoiled(colour ? scene::Change::colour : scene::Change::material));
}

void Renderer::relight(std::shared_ptr<const scene::Scene> edited, solvers::Spoils spoilt) {
  scene_ = std::move(edited);
  upload::flatten_lights(*scene_, flat_);
  device_scene_->update_lights(*device_, flat_);
  if (device_scene_->defines() != compiled_)
    spoilt |= build_wavefront(*device_scene_, true);
  else
    wavefront_->rebind(*device_scene_);
  restart(spoilt);
}

}  // namespace lucerna::session
