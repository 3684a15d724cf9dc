#include "session/scene_edit.h"

#include <utility>

#include "base/error.h"
#include "scene/object_place.h"
#include "scene/range.h"

namespace lucerna::session {
namespace {

/// `thing`: "light".
template <class T>
T& checked_element(std::vector<T>& all, uint32_t index, const char* thing) {
  if (index >= all.size()) throw_error(thing, "there is no {} {}", thing, index);
  return all[index];
}

EditedScene copy_of(const ScenePtr& scene, const char* thing) {
  if (!scene) throw Error(thing, "there is no scene");
  return std::make_shared<scene::Scene>(*scene);
}

}  // namespace

EditedScene with_light(const ScenePtr& scene, uint32_t index, const scene::Light& light) {
  EditedScene edited = copy_of(scene, "light");
  scene::Light& place = checked_element(edited->lights, index, "light");
  scene::check_range(light);
  place = light;
  return edited;
}

EditedScene with_light_list(const ScenePtr& scene, const std::vector<scene::Light>& lights) {
  EditedScene edited = copy_of(scene, "light");
  for (const scene::Light& light : lights) scene::check_range(light);
  edited->lights = lights;
  return edited;
}

EditedScene with_environment(const ScenePtr& scene, float scale, float rotation_degrees) {
  EditedScene edited = copy_of(scene, "environment");
  edited->environment.scale = scale;
  edited->environment.rotation = rotation_degrees;
  scene::check_range(edited->environment);
  return edited;
}

EditedScene with_material(const ScenePtr& scene, uint32_t index, const scene::Material& material) {
  EditedScene edited = copy_of(scene, "material");
  scene::Material& m = checked_element(edited->materials, index, "material");
  scene::check_range(material);
  const scene::Material before = std::exchange(m, material);
  bool same = m.alpha_mode == before.alpha_mode && (m.transmission > 0) == (before.transmission > 0) &&
              (m.thickness > 0) == (before.thickness > 0);
  for (const auto& slot : scene::k_texture_slots) same &= m.*slot.use == before.*slot.use;
  if (!same)
    throw_error("material", "'{}': its textures, alpha mode, transmission and thickness cannot be changed",
                before.name);
  return edited;
}

EditedScene with_strengths(const ScenePtr& scene, const LightsEdit& edit) {
  EditedScene edited = copy_of(scene, "light");
  for (const auto& [index, light] : edit.lights) {
    scene::Light& place = checked_element(edited->lights, index, "light");
    scene::check_range(light);
    place = light;
  }
  for (const auto& [index, material] : edit.materials) {
    scene::Material& place = checked_element(edited->materials, index, "material");
    scene::check_range(material);
    place.emission = material.emission;
  }
  if (edit.environment_scale) edited->environment.scale = *edit.environment_scale;
  scene::check_range(edited->environment);
  return edited;
}

EditedScene with_objects(const ScenePtr& scene, const std::vector<ObjectEdit>& edits) {
  EditedScene edited = copy_of(scene, "object");
  for (const ObjectEdit& e : edits) {
    if (e.index >= edited->instances.size()) throw_error("object", "there is no object {}", e.index + 1);
    scene::Instance& instance = edited->instances[e.index];
    instance.to_world = e.to_world, instance.hidden = e.hidden;
    instance.flipped = glm::determinant(glm::dmat3(e.to_world)) < 0;
    scene::check_range(instance, scene::box_of(std::as_const(edited->meshes).at(instance.mesh)));
  }
  return edited;
}

}  // namespace lucerna::session
