#include "session/scene_edit.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.h"
#include "scene/io/texture_file.h"
#include "scene/object_place.h"
#include "scene/range.h"
#include "scene/tangents.h"

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

bool has_material(const scene::Primitive& p, uint32_t material) {
  return p.material == material ||
         std::find(p.variants.begin(), p.variants.end(), material) != p.variants.end();
}

/// Tangents for the surfaces of a material that needs them, where the file had no reason to give any.
void add_tangents(scene::Scene& scene, uint32_t index) {
  const scene::Material& m = scene.materials[index];
  if (!scene::needs_tangents(m)) return;
  const auto lacks = [index](const scene::Primitive& p) {
    return has_material(p, index) && p.tangents.empty();
  };
  const scene::TextureUse& map = m.normal_texture             ? m.normal_texture
                                 : m.clearcoat_normal_texture ? m.clearcoat_normal_texture
                                                              : m.anisotropy_texture;
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    for (size_t k = 0; k < std::as_const(scene.meshes)[i].primitives.size(); ++k)
      if (lacks(std::as_const(scene.meshes)[i].primitives[k]))
        scene::make_tangents(scene.meshes[i].primitives[k], map);
}

/// Throws Error if a surface of the material cannot show a texture, which glTF does not allow either.
void check_coordinates(const scene::Scene& scene, uint32_t material, uint32_t uv_set) {
  for (const scene::Mesh& mesh : scene.meshes)
    for (const scene::Primitive& p : mesh.primitives)
      if (has_material(p, material) && (uv_set == 0 ? p.uv0 : p.uv1).empty())
        throw_error(fmt::format("material '{}'", scene.materials[material].name),
                    "mesh '{}' has it and no texture coordinates, so it cannot show a texture", mesh.name);
}

/// The texture of the edited scene that shows the file, read if there is none; wrapped as the own one.
scene::Id texture_of_file(scene::Scene& edited, const scene::Scene& loaded, const std::string& file,
                          const scene::TextureSlot& slot, const scene::TextureUse& own, uint64_t most_bytes) {
  scene::Texture wanted;
  if (own) wanted = loaded.textures[own.texture];
  wanted.srgb = scene::is_colour(slot);
  const std::vector<scene::Texture>& textures = std::as_const(edited.textures);
  const std::vector<scene::Image>& images = std::as_const(edited.images);
  std::optional<scene::Id> image;
  for (size_t t = loaded.textures.size(); t < textures.size(); ++t) {
    const scene::Texture& x = textures[t];
    if (images[x.image].name != file || x.srgb != wanted.srgb) continue;
    image = x.image;
    if (x.wrap_u == wanted.wrap_u && x.wrap_v == wanted.wrap_v && x.nearest == wanted.nearest)
      return static_cast<scene::Id>(t);
  }
  if (!image) {
    scene::Image read = scene::load_texture(file, wanted.srgb, most_bytes);
    image = static_cast<scene::Id>(images.size());
    edited.images.push_back(std::move(read));
  }
  wanted.image = *image;
  edited.textures.push_back(wanted);
  return static_cast<scene::Id>(edited.textures.size() - 1);
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
  for (const auto& slot : scene::k_texture_slots) m.*slot.use = before.*slot.use;
  add_tangents(*edited, index);
  return edited;
}

EditedScene with_material(const ScenePtr& scene, const scene::Scene& loaded, uint32_t index,
                          const scene::Material& material, const scene::TextureSources& textures,
                          uint64_t most_bytes) {
  EditedScene edited = copy_of(scene, "material");
  scene::Material& m = checked_element(edited->materials, index, "material");
  scene::check_range(material);
  m = material;
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s) {
    const scene::TextureSource& source = scene::source_of(textures, s);
    scene::TextureUse& use = m.*scene::k_texture_slots[s].use;
    use = scene::use_of(loaded, index, s, source);
    if (source.kind == scene::TextureSource::Kind::file ||
        (source.kind == scene::TextureSource::Kind::material && use))
      check_coordinates(*edited, index, use.uv_set);
    if (source.kind == scene::TextureSource::Kind::file)
      use.texture = texture_of_file(*edited, loaded, source.file, scene::k_texture_slots[s], use, most_bytes);
  }
  scene::drop_unused_textures(*edited, loaded);
  add_tangents(*edited, index);
  return edited;
}

bool needs_flattening(const scene::Scene& before, const scene::Scene& after, uint32_t index) {
  const scene::Material &x = before.materials.at(index), &y = after.materials.at(index);
  for (const auto& slot : scene::k_texture_slots)
    if (x.*slot.use != y.*slot.use) return true;
  const bool alpha = y.alpha_mode != scene::AlphaMode::opaque &&
                     (x.base_color.w != y.base_color.w || x.alpha_cutoff != y.alpha_cutoff);
  return alpha || x.alpha_mode != y.alpha_mode || x.shadow_catcher != y.shadow_catcher ||
         (x.transmission > 0) != (y.transmission > 0) || (x.thickness > 0) != (y.thickness > 0) ||
         x.double_sided != y.double_sided || !before.meshes.shares_with(after.meshes);
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
