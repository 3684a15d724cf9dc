#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/base64.h"
#include "base/file.h"
#include "scene/io/document.h"
#include "scene/io/images.h"

#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

constexpr const char* k_emissive = "KHR_materials_emissive_strength";
constexpr const char* k_diffuse_roughness = "EXT_materials_diffuse_roughness";
/// Its name in older files.
constexpr const char* k_former_diffuse_roughness = "KHR_materials_diffuse_roughness";
constexpr const char* k_alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};

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
  if (before.alpha_mode != after.alpha_mode) m["alphaMode"] = k_alpha_modes[size_t(after.alpha_mode)];
  if (before.alpha_cutoff != after.alpha_cutoff) m["alphaCutoff"] = number_json(after.alpha_cutoff);
  if (before.double_sided != after.double_sided) m["doubleSided"] = after.double_sided;
  if (before.normal_scale != after.normal_scale && m.contains("normalTexture"))
    m["normalTexture"]["scale"] = number_json(after.normal_scale);
  if (before.emission != after.emission) write_emission(root, m, after.emission);
  if (before.off_emission == after.off_emission) return;
  if (after.off_emission == vec3(0))
    remove_own(m, "off_emission");
  else
    set_own(m, "off_emission", vector_json(after.off_emission));
}

/// What glass, liquids and leaves add: index of refraction, specular strength, transmission, volume.
void write_dielectric(EditedJson& root, EditedJson& m, const Material& before, const Material& after) {
  const auto differs = [&](auto... members) { return ((before.*members != after.*members) || ...); };
  if (differs(&Material::ior)) extension_at(root, m, "KHR_materials_ior")["ior"] = number_json(after.ior);
  if (differs(&Material::specular, &Material::specular_color)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_specular");
    e["specularFactor"] = number_json(after.specular);
    e["specularColorFactor"] = vector_json(after.specular_color);
  }
  if (differs(&Material::transmission))
    extension_at(root, m, "KHR_materials_transmission")["transmissionFactor"] =
        number_json(after.transmission);
  if (differs(&Material::thickness, &Material::attenuation_color, &Material::attenuation_distance)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_volume");
    e["thicknessFactor"] = number_json(after.thickness);
    e["attenuationColor"] = vector_json(after.attenuation_color);
    if (std::isfinite(after.attenuation_distance))
      e["attenuationDistance"] = number_json(after.attenuation_distance);
    else
      e.erase("attenuationDistance");
  }
  if (differs(&Material::diffuse_transmission, &Material::diffuse_transmission_color)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_diffuse_transmission");
    e["diffuseTransmissionFactor"] = number_json(after.diffuse_transmission);
    e["diffuseTransmissionColorFactor"] = vector_json(after.diffuse_transmission_color);
  }
}

/// Coat, sheen, brushing and thin film.
void write_layers(EditedJson& root, EditedJson& m, const Material& before, const Material& after) {
  const auto differs = [&](auto... members) { return ((before.*members != after.*members) || ...); };
  if (differs(&Material::clearcoat, &Material::clearcoat_roughness, &Material::clearcoat_normal_scale)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_clearcoat");
    if (e.contains("clearcoatNormalTexture"))
      e["clearcoatNormalTexture"]["scale"] = number_json(after.clearcoat_normal_scale);
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
  if (differs(&Material::diffuse_roughness))
    extension_at(root, m, k_diffuse_roughness)["diffuseRoughnessFactor"] =
        number_json(after.diffuse_roughness);
  if (differs(&Material::shadow_catcher)) {
    if (after.shadow_catcher)
      set_own(m, "shadow_catcher", true);
    else
      remove_own(m, "shadow_catcher");
  }
  if (differs(&Material::height, &Material::deep_relief)) {
    EditedJson& relief = own_at(m, "height");
    relief["height"] = number_json(after.height);
    relief["deep"] = after.deep_relief;
  }
  if (differs(&Material::dispersion))
    extension_at(root, m, "KHR_materials_dispersion")["dispersion"] = number_json(after.dispersion);
  if (differs(&Material::iridescence, &Material::iridescence_ior, &Material::iridescence_minimum,
              &Material::iridescence_maximum)) {
    EditedJson& e = extension_at(root, m, "KHR_materials_iridescence");
    e["iridescenceFactor"] = number_json(after.iridescence);
    e["iridescenceIor"] = number_json(after.iridescence_ior);
    e["iridescenceThicknessMinimum"] = number_json(after.iridescence_minimum);
    e["iridescenceThicknessMaximum"] = number_json(after.iridescence_maximum);
  }
}

/// Writes it by its present name.
void rename_diffuse_roughness(EditedJson& root) {
  if (!root.contains("materials")) return;
  const EditedJson::json_pointer former(std::string("/extensions/") + k_former_diffuse_roughness);
  for (EditedJson& m : root["materials"]) {
    if (!m.contains(former)) continue;
    EditedJson values = m[former];
    remove_extension(m, k_former_diffuse_roughness);
    EditedJson& present = extension_at(root, m, k_diffuse_roughness);
    if (present.empty()) present = std::move(values);
  }
  drop_unused_extension(root, k_former_diffuse_roughness);
}

/// A material in place of glTF's default one, on all primitives without a material.
size_t add_default_material(EditedJson& root, const std::string& name) {
  EditedJson& list = array_at(root, "materials");
  list.push_back({{"name", name}});
  for (EditedJson& mesh : root["meshes"])
    for (EditedJson& primitive : mesh["primitives"])
      if (!primitive.contains("material")) primitive["material"] = list.size() - 1;
  return list.size() - 1;
}

/// Where a material's texture is in the file: in the material itself, an object of it, an extension, or
/// extras.lucerna.
struct TextureKey {
  enum Place { material, object, extension, own } place;
  const char* holder;
  const char* key;
};
constexpr TextureKey k_texture_keys[] = {
    {TextureKey::object, "pbrMetallicRoughness", "baseColorTexture"},
    {TextureKey::object, "pbrMetallicRoughness", "metallicRoughnessTexture"},
    {TextureKey::material, "", "normalTexture"},
    {TextureKey::material, "", "emissiveTexture"},
    {TextureKey::extension, "KHR_materials_specular", "specularTexture"},
    {TextureKey::extension, "KHR_materials_specular", "specularColorTexture"},
    {TextureKey::extension, "KHR_materials_transmission", "transmissionTexture"},
    {TextureKey::extension, "KHR_materials_diffuse_transmission", "diffuseTransmissionTexture"},
    {TextureKey::extension, "KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture"},
    {TextureKey::extension, "KHR_materials_clearcoat", "clearcoatTexture"},
    {TextureKey::extension, "KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
    {TextureKey::extension, "KHR_materials_clearcoat", "clearcoatNormalTexture"},
    {TextureKey::extension, "KHR_materials_sheen", "sheenColorTexture"},
    {TextureKey::extension, "KHR_materials_sheen", "sheenRoughnessTexture"},
    {TextureKey::extension, "KHR_materials_anisotropy", "anisotropyTexture"},
    {TextureKey::extension, "KHR_materials_iridescence", "iridescenceTexture"},
    {TextureKey::extension, "KHR_materials_iridescence", "iridescenceThicknessTexture"},
    {TextureKey::extension, k_diffuse_roughness, "diffuseRoughnessTexture"},
    {TextureKey::own, "height", "texture"},
};
static_assert(std::size(k_texture_keys) == std::size(k_texture_slots));

class TextureWriter {
 public:
  TextureWriter(EditedJson& root, const SaveRequest& request, const Folders& folders)
      : root_(root), request_(request), folders_(folders) {
    if (!request.textures.empty() && root.contains("materials")) before_ = root["materials"];
  }

  void write(size_t material, const TextureSources& sources) {
    for (const auto& [slot, source] : sources) {
      using Kind = TextureSource::Kind;
      const TextureKey& key = k_texture_keys[slot];
      EditedJson info = found(material, key);
      if (source.kind == Kind::own) continue;
      if (source.kind == Kind::none) info = nullptr;
      if (source.kind == Kind::material) {
        const Id from = request_.loaded->material_indices.at(source.material);
        info = from == k_none ? EditedJson() : found(from, key);
      }
      if (source.kind == Kind::file) {
        EditedJson texture = {{"source", image_of(source.file)}};
        if (!info.is_object()) info = EditedJson::object();
        if (info.contains("index"))
          if (const EditedJson& own = root_["textures"][info["index"].get<size_t>()]; own.contains("sampler"))
            texture["sampler"] = own["sampler"];
        info["index"] = append("textures", std::move(texture));
      }
      put(material, key, std::move(info));
    }
  }

 private:
  /// As the source file has it; null: none.
  EditedJson found(size_t material, const TextureKey& key) const {
    if (material >= before_.size()) return nullptr;
    const EditedJson& m = before_[material];
    static constexpr const char* k_paths[] = {"", "/", "/extensions/", "/extras/lucerna/"};
    const EditedJson::json_pointer pointer(std::string(k_paths[key.place]) + key.holder);
    if (!m.contains(pointer)) return nullptr;
    const EditedJson& holder = m[pointer];
    return holder.contains(key.key) ? holder[key.key] : EditedJson();
  }

  void put(size_t material, const TextureKey& key, EditedJson info) {
    EditedJson& m = root_["materials"][material];
    if (info.is_null() && found(material, key).is_null()) return;
    EditedJson& holder = key.place == TextureKey::material    ? m
                         : key.place == TextureKey::object    ? object_at(m, key.holder)
                         : key.place == TextureKey::extension ? extension_at(root_, m, key.holder)
                                                              : own_at(m, key.holder);
    if (info.is_null())
      holder.erase(key.key);
    else
      holder[key.key] = std::move(info);
  }

  size_t append(const char* list, EditedJson item) {
    EditedJson& all = array_at(root_, list);
    all.push_back(std::move(item));
    return all.size() - 1;
  }

  size_t image_of(const std::string& file) {
    const auto [place, fresh] = images_.try_emplace(file, 0);
    if (!fresh) return place->second;
    const std::filesystem::path path(file);
    const std::string relative = uri_of(path, folders_.to);
    EditedJson image = {{"name", path.stem().string()}};
    if (!relative.starts_with("../") && request_.file.extension() == ".gltf") {
      image["uri"] = uri_of(path, folders_.from);  // moved with the others
    } else {
      const std::string bytes = lucerna::read_file(file);
      image["uri"] = "data:" + mime_type(bytes) + ";base64," + base64(bytes);
    }
    return place->second = append("images", std::move(image));
  }

  EditedJson& root_;
  const SaveRequest& request_;
  const Folders& folders_;
  EditedJson before_ = EditedJson::array();
  std::map<std::string, size_t> images_;
};

}  // namespace

void write_materials(EditedJson& root, const SaveRequest& request, const Folders& folders) {
  const Scene &loaded = *request.loaded, &edited = *request.edited;
  rename_diffuse_roughness(root);
  TextureWriter textures(root, request, folders);
  for (uint32_t i = 0; i < std::min(loaded.materials.size(), edited.materials.size()); ++i) {
    if (i >= loaded.material_indices.size()) continue;
    const auto sources = request.textures.find(i);
    const Material &before = loaded.materials[i], &after = edited.materials[i];
    const bool same =
        static_cast<const MaterialFactors&>(before) == after && before.off_emission == after.off_emission;
    if (same && sources == request.textures.end()) continue;
    const Id index = loaded.material_indices[i];
    const size_t at = index == k_none ? add_default_material(root, before.name) : size_t{index};
    // Textures first: factors of normal maps are in them.
    if (sources != request.textures.end()) textures.write(at, sources->second);
    EditedJson& m = root["materials"][at];
    write_material(root, m, before, after);
    write_dielectric(root, m, before, after);
    write_layers(root, m, before, after);
  }
}

}  // namespace lucerna::scene
