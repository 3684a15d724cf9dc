// Edits of a renderer's scene: lights, environment, materials, objects.
#include <algorithm>
#include <utility>

#include "scene/io/environment_file.h"
#include "scene/light_factor.h"
#include "scene/range.h"
#include "scene/sky_image.h"
#include "session/found_portals.h"
#include "session/renderer.h"
#include "session/scene_edit.h"

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

/// True if the environment is another one, and not only brighter or turned.
bool other_sky(const scene::Environment& a, const scene::Environment& b) {
  return a.image != b.image || a.radiance != b.radiance || a.file != b.file || a.sky != b.sky;
}

}  // namespace

void Renderer::set_light_list(const std::vector<scene::Light>& lights) {
  const EditedScene edited = with_light_list(setup_.world.scene, lights);
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
  edit(with_light(setup_.world.scene, index, light), scene::Change::lamp, false);
}

void Renderer::set_environment(float scale, float rotation_degrees) {
  if (!setup_.world.scene) return;
  edit(with_environment(setup_.world.scene, scale, rotation_degrees), scene::Change::environment, false);
}

void Renderer::set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                                    std::optional<float> rotation_degrees) {
  if (!setup_.world.scene || !loaded_) throw_error(file.string(), "there is no scene to be lit");
  auto edited = std::make_shared<scene::Scene>(*setup_.world.scene);
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
  scene::drop_unused_textures(*edited, *loaded_);
  std::shared_ptr<const scene::Scene> lit = std::move(edited);
  // The first sky of this scene.
  if (lit->portals.empty() && loaded_->portals.empty())
    lit = with_portals(lit, {}, setup_.settings.text("lights.portals"));
  edit(lit, scene::Change::environment, false);
}

void Renderer::set_material(uint32_t index, const scene::Material& material,
                            const std::optional<scene::TextureSources>& textures, const Progress& progress) {
  const ScenePtr scene = setup_.world.scene;
  const EditedScene edited = textures && loaded_ ? with_material(scene, *loaded_, index, material, *textures,
                                                                 options_.scenes.most_bytes)
                                                 : with_material(scene, index, material);
  if (needs_flattening(*scene, *edited, index)) {
    Transaction::Target target(setup_);
    // A pane in a window may have become a wall.
    target.scene = with_portals(edited, loaded_->portals, setup_.settings.text("lights.portals"), progress);
    install(std::move(target), progress, scene::Change::shape);
    return;
  }
  const scene::Material& before = scene->materials[index];
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
  const EditedScene edited = with_strengths(setup_.world.scene, e);
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
  const EditedScene edited = with_objects(setup_.world.scene, edits);
  const auto same_place = [](const scene::Instance& x, const scene::Instance& y) {
    return x.to_world == y.to_world && x.hidden == y.hidden;
  };
  const std::vector<scene::Instance>& before = setup_.world.scene->instances;
  scene::Changes changes = scene::Change::place;
  for (size_t i = 0; i < before.size(); ++i)
    if (!same_place(before[i], edited->instances[i]))
      for (const Box& box : {bounds(*setup_.world.scene, before[i]), bounds(*edited, edited->instances[i])})
        changes.moved.push_back(box);
  if (changes.moved.empty()) return;
  Transaction::Target target(setup_);
  // What stood in a window may be gone.
  target.scene = with_portals(edited, loaded_->portals, setup_.settings.text("lights.portals"), progress);
  install(std::move(target), progress, changes);
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
  const bool sky = other_sky(setup_.world.lit->environment, after.lit->environment);
  // Only the emission of materials has changed.
  const scene::Changes what = light && factors ? scene::Changes(scene::Change::lamp) : changes;
  transaction.edit_world(factors);
  transaction.build(what);
  const bool rebuilt = transaction.has_engine();
  commit(transaction);
  if (rebuilt) notify_settings_changed();
  restart(what, light, sky);
}

}  // namespace lucerna::session
