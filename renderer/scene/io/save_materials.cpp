#include <algorithm>
#include <utility>

#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

constexpr const char* k_emissive = "KHR_materials_emissive_strength";

void write_emission(EditedJson& root, EditedJson& m, const vec3& emission) {
  const bool strong = std::max({emission.x, emission.y, emission.z}) > 1;
  const auto [color, strength] = strong ? split_strength(emission) : std::pair{emission, 1.0f};
  m["emissiveFactor"] = vector_json(color);
  if (strong)
    extension_at(root, m, k_emissive)["emissiveStrength"] = number_json(strength);
  else
    remove_extension(m, k_emissive);
  if (!strong) drop_unused_extension(root, k_emissive);
}

void write_material(EditedJson& root, EditedJson& m, const Material& before, const Material& after) {
  const auto pbr = [&m]() -> EditedJson& { return object_at(m, "pbrMetallicRoughness"); };
  if (before.base_color != after.base_color) {
    EditedJson color = vector_json(vec3(after.base_color));
    color.push_back(number_json(after.base_color.w));
    pbr()["baseColorFactor"] = std::move(color);
  }
  if (before.roughness != after.roughness) pbr()["roughnessFactor"] = number_json(after.roughness);
  if (before.metallic != after.metallic) pbr()["metallicFactor"] = number_json(after.metallic);
  if (before.emission != after.emission) write_emission(root, m, after.emission);
  if (before.off_emission == after.off_emission) return;
  if (after.off_emission == vec3(0))
    remove_own(m, "off_emission");
  else
    set_own(m, "off_emission", vector_json(after.off_emission));
}

/// Coat, sheen, brushing and thin film.
void write_layers(EditedJson& root, EditedJson& m, const Material& before, const Material& after) {
  const auto differs = [&](auto... members) { return ((before.*members != after.*members) || ...); };
  if (differs(&Material::clearcoat, &Material::clearcoat_roughness)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_clearcoat");
    e["clearcoatFactor"] = number_json(after.clearcoat);
    e["clearcoatRoughnessFactor"] = number_json(after.clearcoat_roughness);
  }
  if (differs(&Material::sheen_color, &Material::sheen_roughness)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_sheen");
    e["sheenColorFactor"] = vector_json(after.sheen_color);
    e["sheenRoughnessFactor"] = number_json(after.sheen_roughness);
  }
  if (differs(&Material::anisotropy, &Material::anisotropy_rotation)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_anisotropy");
    e["anisotropyStrength"] = number_json(after.anisotropy);
    e["anisotropyRotation"] = number_json(after.anisotropy_rotation);
  }
  if (differs(&Material::dispersion))
    extension_at(root, m, "KHR_materials_dispersion")["dispersion"] = number_json(after.dispersion);
  if (differs(&Material::iridescence, &Material::iridescence_maximum)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_iridescence");
    e["iridescenceFactor"] = number_json(after.iridescence);
    e["iridescenceThicknessMaximum"] = number_json(after.iridescence_maximum);
  }
}

/// A material in place of glTF's default one, on all primitives without a material.
size_t add_default_material(EditedJson& root, const std::string& name) {
  EditedJson& list = root["materials"];
  if (!list.is_array()) list = EditedJson::array();
  list.push_back({{"name", name}});
  for (EditedJson& mesh : root["meshes"])
    for (EditedJson& primitive : mesh["primitives"])
      if (!primitive.contains("material")) primitive["material"] = list.size() - 1;
  return list.size() - 1;
}

}  // namespace

void write_materials(EditedJson& root, const Scene& loaded, const Scene& edited) {
  for (size_t i = 0; i < std::min(loaded.materials.size(), edited.materials.size()); ++i) {
    const Material &before = loaded.materials[i], &after = edited.materials[i];
    if (before == after || i >= loaded.material_indices.size()) continue;
    const Id index = loaded.material_indices[i];
    const size_t at = index == k_none ? add_default_material(root, before.name) : size_t{index};
    write_material(root, root["materials"][at], before, after);
    write_layers(root, root["materials"][at], before, after);
  }
}

}  // namespace lucerna::scene
