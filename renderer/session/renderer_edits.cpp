// Edits of a renderer's scene: lights, environment, materials, objects.
#include <algorithm>
#include <utility>

#include "scene/io/environment_file.h"
#include "scene/light_factor.h"
#include "scene/object_place.h"
#include "scene/range.h"
#include "scene/sky_image.h"
#include "session/found_portals.h"
#include "session/renderer.h"

namespace lucerna::session {
namespace {

/// True if the lists give the same light; names, groups and ids may differ.
bool same_light(const std::vector<scene::Light>& a, const std::vector<scene::Light>& b) {
  const auto equal = [](const scene::Light& x, scene::Light y) {
    y.name = x.name, y.group = x.group, y.id = x.id, y.sun = x.sun;
    return x == y;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

}  // namespace

void Renderer::set_light_list(const std::vector<scene::Light>& lights) {
  if (!setup_.world.scene) throw Error("light", "there is no scene");
  for (const scene::Light& light : lights) scene::check_range(light);
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  edited->lights = lights;
  Relight& relight = setup_.relight;
  if (same_light(setup_.world.scene->lights, lights) &&
      (!relight.groups ||
       scene::group_lights(*edited, scene::parse_group_rules(setup_.settings.text("relight.groups")),
                           *relight.scene, *relight.groups) == *relight.groups)) {
    if (relight.scene) relight.scene = edited;
    setup_.world.scene = edited;
    return;
  }
  edit(edited, scene::Change::lamp, false);
}

void Renderer::set_light(uint32_t index, const scene::Light& light) {
  if (!setup_.world.scene || index >= setup_.world.scene->lights.size())
    throw_error("light", "there is no light {}", index);
  scene::check_range(light);
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  edited->lights[index] = light;
  edit(edited, scene::Change::lamp, false);
}

void Renderer::set_environment(float scale, float rotation_degrees) {
  if (!setup_.world.scene) return;
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  edited->environment.scale = scale;
  edited->environment.rotation = rotation_degrees;
  scene::check_range(edited->environment);
  edit(edited, scene::Change::environment, false);
}

void Renderer::set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                                    std::optional<float> rotation_degrees) {
  if (!setup_.world.scene || !loaded_) throw_error(file.string(), "there is no scene to be lit");
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  // The images as loaded; those of earlier files are dropped.
  edited->images = loaded_->images;
  scene::Environment environment = loaded_->environment;
  if (!file.empty()) {
    scene::Image image = scene::load_environment(file, options_.scenes.most_bytes);
    environment.image = scene::Id(edited->images.size());
    environment.file = file.string();
    environment.given = true;
    environment.sky.reset();
    edited->images.push_back(std::move(image));
  }
  environment.scale = scale.value_or(setup_.world.scene->environment.scale);
  environment.rotation = rotation_degrees.value_or(setup_.world.scene->environment.rotation);
  light_by(std::move(edited), environment);
}

void Renderer::set_environment_sky(const scene::SkyModel& sky, float scale) {
  if (!setup_.world.scene || !loaded_) throw_error("sky", "there is no scene to be lit");
  scene::check_range(sky);
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  edited->images = loaded_->images;
  scene::Environment environment;
  environment.image = scene::Id(edited->images.size());
  environment.scale = scale;
  environment.given = true;
  environment.sky = sky;
  edited->images.push_back(scene::sky_image(sky));
  light_by(std::move(edited), environment);
}

void Renderer::light_by(std::shared_ptr<scene::Scene> edited, const scene::Environment& environment) {
  scene::check_range(environment);
  edited->environment = environment;
  std::shared_ptr<const scene::Scene> lit = std::move(edited);
  // The first sky of this scene.
  if (lit->portals.empty() && loaded_->portals.empty())
    lit = with_portals(lit, {}, setup_.settings.text("lights.portals"));
  edit(lit, scene::Change::environment, false);
}

void Renderer::set_material(uint32_t index, const scene::Material& material) {
  if (!setup_.world.scene || index >= setup_.world.scene->materials.size())
    throw_error("material", "there is no material {}", index);
  scene::check_range(material);
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  scene::Material& m = edited->materials[index];
  const scene::Material before = std::exchange(m, material);
  bool same = m.alpha_mode == before.alpha_mode && (m.transmission > 0) == (before.transmission > 0) &&
              (m.thickness > 0) == (before.thickness > 0);
  for (const auto& slot : scene::k_texture_slots) same &= m.*slot.use == before.*slot.use;
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
  if (!setup_.world.scene) throw Error("light", "there is no scene");
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
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
  if (write_mix(setup_.relight, edited, *setup_.world.lit, setup_.settings, e.mix)) {
    setup_.world.scene = edited;
    setup_.settings.set("relight.mix", e.mix);
    applied_["relight.mix"] = setup_.settings.text("relight.mix");
    return;
  }
  Transaction::Target target(setup_);
  target.scene = edited;
  target.settings.set("relight.mix", e.mix);
  scene::Changes changes;
  changes.edits = {scene::Change::lamp, scene::Change::environment, scene::Change::colour};
  edit(std::move(target), changes, true);
}

void Renderer::set_instances(const std::vector<ObjectEdit>& edits, const Progress& progress) {
  if (!setup_.world.scene) throw Error("object", "there is no scene");
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
  bool changed = false;
  for (const ObjectEdit& e : edits) {
    if (e.index >= edited->instances.size()) throw_error("object", "there is no object {}", e.index + 1);
    scene::Instance& instance = edited->instances[e.index];
    changed |= instance.to_world != e.to_world || instance.hidden != e.hidden;
    instance.to_world = e.to_world, instance.hidden = e.hidden;
    instance.flipped = glm::determinant(glm::dmat3(e.to_world)) < 0;
    scene::check_range(instance, scene::box_of(std::as_const(edited->meshes).at(instance.mesh)));
  }
  if (!changed) return;
  Transaction::Target target(setup_);
  // What stood in a window may be gone.
  target.scene =
      with_portals(std::move(edited), loaded_->portals, setup_.settings.text("lights.portals"), progress);
  install(std::move(target), progress, scene::Change::shape);
  overlays_.show_paths({});
}

void Renderer::edit(std::shared_ptr<const scene::Scene> edited, const scene::Changes& changes, bool factors) {
  Transaction::Target target(setup_);
  target.scene = std::move(edited);
  edit(std::move(target), changes, factors);
}

void Renderer::edit(Transaction::Target target, const scene::Changes& changes, bool factors) {
  Transaction transaction(context_, setup_, std::move(target), setup_.engine->plan());
  const Relight &before = setup_.relight, &after = transaction.relight();
  const bool by_group = after.separate && before.separate && *after.groups == *before.groups;
  const std::optional<std::vector<vec3>> light =
      scene::light_factors(*setup_.world.lit, *after.lit, by_group ? after.groups.get() : nullptr);
  // Only the emission of materials has changed.
  const scene::Changes what = light && factors ? scene::Changes(scene::Change::lamp) : changes;
  transaction.edit_world(factors);
  transaction.build(what);
  const bool rebuilt = transaction.has_engine();
  commit(transaction);
  if (rebuilt) notify_settings_changed();
  restart(what, light);
}

}  // namespace lucerna::session
