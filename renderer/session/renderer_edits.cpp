// Edits of a renderer's scene: lights, environment, materials.
#include <utility>

#include "scene/io/environment_file.h"
#include "scene/light_factor.h"
#include "scene/range.h"
#include "session/found_portals.h"
#include "session/renderer.h"

namespace lucerna::session {

void Renderer::set_light(uint32_t index, const scene::Light& light) {
  if (!world_.scene || index >= world_.scene->lights.size())
    throw_error("light", "there is no light {}", index);
  scene::check_range(light);
  auto edited = std::make_shared<scene::Scene>(*world_.scene);
  edited->lights[index] = light;
  edit(edited, scene::Change::lamp, false);
}

void Renderer::set_environment(float scale, float rotation_degrees) {
  if (!world_.scene) return;
  auto edited = std::make_shared<scene::Scene>(*world_.scene);
  edited->environment.scale = scale;
  edited->environment.rotation = rotation_degrees;
  scene::check_range(edited->environment);
  edit(edited, scene::Change::environment, false);
}

void Renderer::set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                                    std::optional<float> rotation_degrees) {
  if (!world_.scene || !loaded_) throw_error(file.string(), "there is no scene to be lit");
  auto edited = std::make_shared<scene::Scene>(*world_.scene);
  // The images as loaded; those of earlier files are dropped.
  edited->images = loaded_->images;
  scene::Environment environment = loaded_->environment;
  if (!file.empty()) {
    scene::Image image = scene::load_environment(file, options_.scenes.most_bytes);
    environment.image = scene::Id(edited->images.size());
    environment.file = file.string();
    environment.given = true;
    edited->images.push_back(std::move(image));
  }
  environment.scale = scale.value_or(world_.scene->environment.scale);
  environment.rotation = rotation_degrees.value_or(world_.scene->environment.rotation);
  scene::check_range(environment);
  edited->environment = environment;
  std::shared_ptr<const scene::Scene> lit = edited;
  // The first sky of this scene.
  if (lit->portals.empty() && loaded_->portals.empty())
    lit = with_portals(lit, {}, settings_.text("lights.portals"));
  edit(lit, scene::Change::environment, false);
}

void Renderer::set_material(uint32_t index, const scene::Material& material) {
  if (!world_.scene || index >= world_.scene->materials.size())
    throw_error("material", "there is no material {}", index);
  scene::check_range(material);
  auto edited = std::make_shared<scene::Scene>(*world_.scene);
  scene::Material& m = edited->materials[index];
  const scene::Material before = std::exchange(m, material);
  bool same = m.alpha_mode == before.alpha_mode && (m.transmission > 0) == (before.transmission > 0) &&
              (m.thickness > 0) == (before.thickness > 0);
  for (const auto use :
       {&scene::Material::base_color_texture, &scene::Material::metallic_roughness_texture,
        &scene::Material::normal_texture, &scene::Material::emission_texture,
        &scene::Material::specular_texture, &scene::Material::specular_color_texture,
        &scene::Material::transmission_texture, &scene::Material::diffuse_transmission_texture,
        &scene::Material::diffuse_transmission_color_texture})
    same &= m.*use == before.*use;
  if (!same)
    throw_error("material", "'{}': its textures, alpha mode, transmission and thickness cannot be changed",
                before.name);
  // A diffuse colour remains, and no other lobe appears: lookups stay at the same places.
  const auto diffuse = [](const scene::Material& x) {
    return luminance(vec3(x.base_color)) > 0 && x.metallic < 1;
  };
  const bool colour = diffuse(before) && diffuse(material) && before.metallic == material.metallic &&
                      before.unlit == material.unlit &&
                      before.diffuse_transmission == material.diffuse_transmission &&
                      before.transmission == material.transmission;
  edit(edited, colour ? scene::Change::colour : scene::Change::material, true);
}

void Renderer::set_lights(const LightsEdit& e) {
  if (!world_.scene) throw Error("light", "there is no scene");
  auto edited = std::make_shared<scene::Scene>(*world_.scene);
  for (const auto& [index, light] : e.lights) {
    if (index >= edited->lights.size()) throw_error("light", "there is no light {}", index);
    scene::check_range(light);
    edited->lights[index] = light;
  }
  for (const auto& [index, material] : e.materials) {
    if (index >= edited->materials.size()) throw_error("material", "there is no material {}", index);
    scene::check_range(material);
    edited->materials[index].emission = material.emission;
  }
  if (e.environment_scale) edited->environment.scale = *e.environment_scale;
  scene::check_range(edited->environment);
  if (write_mix(relight_, edited, *world_.lit, settings_, e.mix)) {
    world_.scene = edited;
    settings_.set("relight.mix", e.mix);
    applied_["relight.mix"] = settings_.text("relight.mix");
    return;
  }
  const std::string before = settings_.text("relight.mix");
  settings_.set("relight.mix", e.mix);
  try {
    scene::Changes changes;
    changes.edits = {scene::Change::lamp, scene::Change::environment, scene::Change::colour};
    edit(edited, changes, true);
  } catch (...) {
    settings_.set("relight.mix", before);
    throw;
  }
}

void Renderer::edit(std::shared_ptr<const scene::Scene> edited, const scene::Changes& changes, bool factors) {
  Relight relight = make_relight(engine_->plan(), settings_, edited, width_, height_);
  const bool by_group = relight.separate && relight_.separate && *relight.groups == *relight_.groups;
  const std::optional<std::vector<vec3>> light =
      scene::light_factors(*world_.lit, *relight.lit, by_group ? relight.groups.get() : nullptr);
  // Only the emission of materials has changed.
  const scene::Changes what = light && factors ? scene::Changes(scene::Change::lamp) : changes;
  WorldEdit trial(*device_, world_, std::move(edited), relight.lit,
                  wanted_separation(engine_->plan(), settings_, relight),
                  factors || relight.baked != relight_.baked);
  const bool rebuild = !engine_->serves(engine_->plan(), settings_, world_);
  Films films =
      keeps(*film_, world_.flat.effects) ? Films{} : make_films(width_, height_, world_.flat.effects);
  if (rebuild) use(make_engine(world_, engine_->plan(), settings_, what), what);
  trial.keep();
  if (films.picture) use(std::move(films));
  take(std::move(relight));
  if (rebuild)
    notify_settings_changed();
  else
    engine_->wavefront().rebind(*world_.device);
  restart(what, light);
}

}  // namespace lucerna::session
