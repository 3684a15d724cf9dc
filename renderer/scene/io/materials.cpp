#include "scene/io/materials.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "scene/io/images.h"
#include "scene/io/own_extras.h"
#include "scene/range.h"

namespace lucerna::scene {
namespace {

constexpr float k_huge = 1e30f;

// KHR_texture_transform: uv' = T * R * S * uv, the rotation counter-clockwise in the (u right, v down) plane
// of glTF: (1, 0) goes towards (0, -1). The first text of the extension had the opposite sign; its
// conformance model, the Khronos viewer and the importers all turn this way.
std::array<float, 6> transform_matrix(const Item& transform) {
  const auto pair = [&transform](const char* key, double fallback) {
    const auto item = transform.find(key);
    if (!item) return glm::dvec2(fallback);
    if (item->size() != 2) item->fail("expected 2 numbers, found {}", item->size());
    return glm::dvec2(item->at(size_t{0}).number(), item->at(1).number());
  };
  const glm::dvec2 offset = pair("offset", 0), scale = pair("scale", 1);
  const double rotation = transform.number("rotation", 0);
  const double c = std::cos(rotation), s = std::sin(rotation);
  return {static_cast<float>(c * scale.x),  static_cast<float>(s * scale.y), static_cast<float>(offset.x),
          static_cast<float>(-s * scale.x), static_cast<float>(c * scale.y), static_cast<float>(offset.y)};
}

// Index of TEXCOORD_n among a material's two sets of texture coordinates; none if both are others.
std::optional<uint32_t> take_slot(std::array<int, 2>& sets, int n) {
  for (uint32_t slot = 0; slot < 2; ++slot)
    if (sets[slot] == n) return slot;
  const uint32_t own = n == 1 ? 1 : 0;
  for (const uint32_t slot : {own, 1 - own})
    if (sets[slot] < 0) {
      sets[slot] = n;
      return slot;
    }
  return std::nullopt;
}

Wrap wrap_mode(int gl) {
  if (gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  if (gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirror;
  return Wrap::repeat;
}

// An image of the document decoded for its uses; `failure` says why it is not there.
struct Decoded {
  bool only_data = true;  // no use of it is colour
  Image image;
  std::string failure;
  bool outside = false;               // it is a file that may not be read
  std::exception_ptr over = nullptr;  // the scene may not take so much memory
  Id id = k_none;
};

void decode(const Document& document, uint32_t index, Decoded& result) {
  const Item item = document.root().at("images").at(index);
  const auto uri = item.find("uri");
  const auto view = item.find("bufferView");
  std::string name = item.text("name", "");
  try {
    std::vector<uint8_t> bytes;
    std::string hint = item.text("mimeType", "");
    if (view) {
      bytes = view_bytes(document, *view);
    } else if (uri) {
      if (!is_data_uri(uri->text())) hint = name = percent_decode(uri->text());
      bytes = uri_bytes(document, *uri);
    } else {
      item.fail("neither 'uri' nor 'bufferView' is given");
    }
    result.image = decode_image(bytes, hint, item.where(),
                                result.only_data ? Precision::keep : Precision::eight_bit, document.budget);
  } catch (const OverBudget&) {
    result.over = std::current_exception();
  } catch (const OutsideFolder& error) {
    result.failure = error.what(), result.outside = true;
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  result.image.name = name.empty() ? fmt::format("image {}", index) : name;
}

Image constant_image(const char* name, std::array<uint8_t, 4> texel) {
  Image image;
  image.name = name;
  image.width = image.height = 1;
  image.bytes.assign(texel.begin(), texel.end());
  return image;
}

}  // namespace

float MaterialLoader::factor(const Item& parent, const char* key, float fallback, float lo, float hi) {
  const auto item = parent.find(key);
  if (!item) return fallback;
  const auto value = static_cast<float>(item->number());
  if (value < lo || value > hi)
    document_.warnings.add("{} values of materials outside their range: clamped", item->path());
  return std::clamp(value, lo, hi);
}

vec3 MaterialLoader::color(const Item& parent, const char* key, vec3 fallback, float hi) {
  const auto item = parent.find(key);
  if (!item) return fallback;
  const vec3 value = item->rgb(), clamped = glm::clamp(value, vec3(0), vec3(hi));
  if (value != clamped)
    document_.warnings.add("{} values of materials outside their range: clamped", item->path());
  return clamped;
}

TextureUse MaterialLoader::texture_use(const Item& parent, const char* key, Use use, MaterialNeeds& needs) {
  TextureUse result;
  const auto info = parent.find(key);
  if (!info) return result;
  const uint32_t texture = info->at("index").index(document_.model.textures.size(), "textures");
  int64_t set = info->integer("texCoord", 0, 0, 1 << 16);
  if (const auto extensions = info->find("extensions"))
    if (const auto transform = extensions->find("KHR_texture_transform")) {
      result.m = transform_matrix(*transform);
      set = transform->integer("texCoord", set, 0, 1 << 16);
    }
  const auto slot = take_slot(needs.sets, static_cast<int>(set));
  if (!slot) {
    document_.warnings.add("{} textures that use a third set of texture coordinates in a material: left out",
                           info->path());
    return TextureUse();
  }
  result.uv_set = *slot;
  const Wanted wanted{texture, use == Use::colour, use == Use::normal};
  const auto [place, fresh] = wanted_ids_.try_emplace(wanted, static_cast<Id>(wanted_.size()));
  if (fresh) wanted_.push_back(wanted);
  result.texture = place->second;
  return result;
}

Id MaterialLoader::material(int index) {
  const auto [place, fresh] = known_.try_emplace(index, static_cast<Id>(scene_.materials.size()));
  if (!fresh) return place->second;
  Material material;
  MaterialNeeds needs;
  if (index < 0) {
    material.name = "default material";
  } else {
    const Item item = document_.root().at("materials").at(static_cast<size_t>(index));
    material.name = item.text("name", "");
    if (material.name.empty()) material.name = fmt::format("material {}", index);
    material.group = light_group(item);
    read(item, material, needs);
  }
  scene_.materials.push_back(std::move(material));
  scene_.material_indices.push_back(index < 0 ? k_none : static_cast<Id>(index));
  needs_.push_back(needs);
  return place->second;
}

void MaterialLoader::read(const Item& item, Material& m, MaterialNeeds& needs) {
  if (const auto pbr = item.find("pbrMetallicRoughness")) {
    if (const auto base = pbr->find("baseColorFactor")) {
      if (base->size() != 4) base->fail("expected 4 numbers, found {}", base->size());
      vec4 value;
      for (size_t i = 0; i < 4; ++i) value[static_cast<int>(i)] = static_cast<float>(base->at(i).number());
      m.base_color = glm::clamp(value, vec4(0), vec4(1));
      if (value != m.base_color)
        document_.warnings.add("{} values of materials outside their range: clamped", base->path());
    }
    m.metallic = factor(*pbr, "metallicFactor", 1, 0, 1);
    m.roughness = factor(*pbr, "roughnessFactor", 1, 0, 1);
    m.base_color_texture = texture_use(*pbr, "baseColorTexture", Use::colour, needs);
    m.metallic_roughness_texture = texture_use(*pbr, "metallicRoughnessTexture", Use::data, needs);
  }
  m.normal_texture = texture_use(item, "normalTexture", Use::normal, needs);
  if (m.normal_texture) needs.tangents = m.normal_texture;
  if (const auto normal = item.find("normalTexture"))
    m.normal_scale = factor(*normal, "scale", 1, -k_huge, k_huge);
  m.emission = color(item, "emissiveFactor", vec3(0), k_huge);
  m.emission_texture = texture_use(item, "emissiveTexture", Use::colour, needs);
  const std::string mode = item.text("alphaMode", "OPAQUE");
  if (mode == "MASK") {
    m.alpha_mode = AlphaMode::mask;
  } else if (mode == "BLEND") {
    m.alpha_mode = AlphaMode::blend;
  } else if (mode != "OPAQUE") {
    item.at("alphaMode").fail("'{}', expected OPAQUE, MASK or BLEND", mode);
  }
  m.alpha_cutoff = factor(item, "alphaCutoff", 0.5f, 0, k_huge);
  m.double_sided = item.boolean("doubleSided", false);
  if (const auto extensions = item.find("extensions")) read_extensions(*extensions, m, needs);
  read_own_emission(item, m);
  read_own_catcher(item, m);
  if (const auto relief = own_height(item)) {
    m.height_texture = texture_use(*relief, "texture", Use::data, needs);
    m.deep_relief = relief->boolean("deep", false);
    m.height = factor(*relief, "height", 0, m.deep_relief ? 0 : -k_max_height, k_max_height);
  }
  // Black light needs no texture.
  if (m.emission == vec3(0) && m.off_emission == vec3(0)) m.emission_texture = TextureUse();
}

void MaterialLoader::read_extensions(const Item& extensions, Material& m, MaterialNeeds& needs) {
  if (const auto e = extensions.find("KHR_materials_emissive_strength"))
    m.emission = glm::min(m.emission * factor(*e, "emissiveStrength", 1, 0, k_huge), vec3(k_huge));
  if (const auto e = extensions.find("KHR_materials_ior")) {
    m.ior = factor(*e, "ior", 1.5f, 0, k_huge);
    if (m.ior > 0 && m.ior < 1) {
      document_.warnings.add("{} values of materials outside their range: clamped", e->path() + ".ior");
      m.ior = 1;
    }
  }
  if (const auto e = extensions.find("KHR_materials_specular")) {
    m.specular = factor(*e, "specularFactor", 1, 0, 1);
    m.specular_texture = texture_use(*e, "specularTexture", Use::data, needs);
    m.specular_color = color(*e, "specularColorFactor", vec3(1), k_huge);
    m.specular_color_texture = texture_use(*e, "specularColorTexture", Use::colour, needs);
  }
  if (const auto e = extensions.find("KHR_materials_transmission")) {
    m.transmission = factor(*e, "transmissionFactor", 0, 0, 1);
    m.transmission_texture = texture_use(*e, "transmissionTexture", Use::data, needs);
  }
  if (const auto e = extensions.find("KHR_materials_volume")) {
    m.thickness = factor(*e, "thicknessFactor", 0, 0, k_huge);
    m.attenuation_color = color(*e, "attenuationColor", vec3(1), 1);
    if (e->find("attenuationDistance")) {
      const float distance = factor(*e, "attenuationDistance", 1, 0, 3e38f);
      if (distance > 0)
        m.attenuation_distance = distance;
      else
        document_.warnings.add("{} attenuation distances that are not above 0: nothing is absorbed",
                               e->path());
    }
  }
  if (const auto e = extensions.find("KHR_materials_diffuse_transmission")) {
    m.diffuse_transmission = factor(*e, "diffuseTransmissionFactor", 0, 0, 1);
    m.diffuse_transmission_texture = texture_use(*e, "diffuseTransmissionTexture", Use::data, needs);
    m.diffuse_transmission_color = color(*e, "diffuseTransmissionColorFactor", vec3(1), 1);
    m.diffuse_transmission_color_texture =
        texture_use(*e, "diffuseTransmissionColorTexture", Use::colour, needs);
  }
  // The draft of Khronos became an extension of several vendors.
  for (const char* name : {"EXT_materials_diffuse_roughness", "KHR_materials_diffuse_roughness"})
    if (const auto e = extensions.find(name)) {
      m.diffuse_roughness = factor(*e, "diffuseRoughnessFactor", 0, 0, 1);
      m.diffuse_roughness_texture = texture_use(*e, "diffuseRoughnessTexture", Use::data, needs);
      break;
    }
  m.unlit = extensions.find("KHR_materials_unlit").has_value();
  read_layers(extensions, m, needs);
}

void MaterialLoader::read_layers(const Item& extensions, Material& m, MaterialNeeds& needs) {
  if (const auto e = extensions.find("KHR_materials_clearcoat")) {
    m.clearcoat = factor(*e, "clearcoatFactor", 0, 0, 1);
    m.clearcoat_texture = texture_use(*e, "clearcoatTexture", Use::data, needs);
    m.clearcoat_roughness = factor(*e, "clearcoatRoughnessFactor", 0, 0, 1);
    m.clearcoat_roughness_texture = texture_use(*e, "clearcoatRoughnessTexture", Use::data, needs);
    m.clearcoat_normal_texture = texture_use(*e, "clearcoatNormalTexture", Use::normal, needs);
    if (const auto normal = e->find("clearcoatNormalTexture"))
      m.clearcoat_normal_scale = factor(*normal, "scale", 1, -k_huge, k_huge);
    if (m.clearcoat_normal_texture && !needs.tangents) needs.tangents = m.clearcoat_normal_texture;
  }
  if (const auto e = extensions.find("KHR_materials_sheen")) {
    m.sheen_color = color(*e, "sheenColorFactor", vec3(0), 1);
    m.sheen_color_texture = texture_use(*e, "sheenColorTexture", Use::colour, needs);
    m.sheen_roughness = factor(*e, "sheenRoughnessFactor", 0, 0, 1);
    m.sheen_roughness_texture = texture_use(*e, "sheenRoughnessTexture", Use::data, needs);
  }
  if (const auto e = extensions.find("KHR_materials_anisotropy")) {
    m.anisotropy = factor(*e, "anisotropyStrength", 0, 0, 1);
    m.anisotropy_rotation = factor(*e, "anisotropyRotation", 0, -k_huge, k_huge);
    m.anisotropy_texture = texture_use(*e, "anisotropyTexture", Use::data, needs);
    if (!needs.tangents) needs.tangents = m.anisotropy_texture;
    // Without any texture the tangents follow the first set of coordinates.
    if (!m.anisotropy_texture && !m.normal_texture)
      needs.tangents->uv_set = take_slot(needs.sets, 0).value_or(0);
  }
  if (const auto e = extensions.find("KHR_materials_dispersion"))
    m.dispersion = factor(*e, "dispersion", 0, 0, k_max_dispersion);
  if (const auto e = extensions.find("KHR_materials_iridescence")) {
    m.iridescence = factor(*e, "iridescenceFactor", 0, 0, 1);
    m.iridescence_texture = texture_use(*e, "iridescenceTexture", Use::data, needs);
    m.iridescence_ior = factor(*e, "iridescenceIor", 1.3f, 1, k_huge);
    m.iridescence_minimum = factor(*e, "iridescenceThicknessMinimum", 100, 0, k_huge);
    m.iridescence_maximum = factor(*e, "iridescenceThicknessMaximum", 400, 0, k_huge);
    m.iridescence_thickness_texture = texture_use(*e, "iridescenceThicknessTexture", Use::data, needs);
  }
}

void MaterialLoader::load_images(bool decode_them) {
  // Images, and whether any use of them is colour.
  std::map<uint32_t, Decoded> images;
  for (const Wanted& wanted : wanted_) {
    const int source = document_.model.textures[wanted.texture].source;
    if (source < 0 || !decode_them) continue;
    Decoded& decoded = images[static_cast<uint32_t>(source)];
    decoded.only_data = decoded.only_data && !wanted.srgb;
  }

  // Every image has its own place, so the order in which threads finish does not matter.
  std::vector<std::pair<uint32_t, Decoded*>> jobs;
  for (auto& [index, decoded] : images) jobs.emplace_back(index, &decoded);
  std::atomic<size_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  const auto work = [&] {
    for (size_t i = next++; i < jobs.size() && !stop; i = next++, ++done)
      decode(document_, jobs[i].first, *jobs[i].second);
  };
  std::vector<std::jthread> helpers;
  const size_t threads = std::min<size_t>(jobs.size(), std::max(1u, std::thread::hardware_concurrency()));
  for (size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
  try {
    for (size_t i = next++; i < jobs.size(); i = next++, ++done) {
      document_.progress(0.5f + 0.45f * static_cast<float>(done) / static_cast<float>(jobs.size()),
                         "textures");
      decode(document_, jobs[i].first, *jobs[i].second);
    }
  } catch (...) {
    stop = true;
    throw;
  }
  helpers.clear();

  for (auto& [index, decoded] : images) {
    if (decoded.over) std::rethrow_exception(decoded.over);
    if (!decoded.failure.empty()) {
      document_.warnings.add(
          decoded.outside
              ? "{} images lie outside the scene's folder; neutral ones (white, flat for normal maps) "
                "replace "
                "them"
              : "{} images cannot be used; neutral ones (white, flat for normal maps) replace them",
          decoded.failure);
      continue;
    }
    if (const size_t mended = mend_texels(decoded.image))
      document_.warnings.add("{} texel values that are negative or not finite: replaced", decoded.image.name,
                             mended);
    decoded.id = static_cast<Id>(scene_.images.size());
    scene_.images.push_back(std::move(decoded.image));
  }

  // Textures; equal ones are one.
  Id white = k_none, flat = k_none;
  std::map<std::tuple<Id, Wrap, Wrap, bool, bool>, Id> unique;
  std::vector<Id> final_ids;
  for (const Wanted& wanted : wanted_) {
    const tinygltf::Texture& source = document_.model.textures[wanted.texture];
    Texture texture;
    texture.srgb = wanted.srgb;
    if (source.sampler >= 0) {
      const tinygltf::Sampler& sampler = document_.model.samplers[static_cast<size_t>(source.sampler)];
      texture.wrap_u = wrap_mode(sampler.wrapS);
      texture.wrap_v = wrap_mode(sampler.wrapT);
      texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    if (source.source >= 0 && decode_them)
      texture.image = images.at(static_cast<uint32_t>(source.source)).id;
    else if (decode_them)
      document_.warnings.add("{} textures have no image that can be read; neutral ones replace them",
                             fmt::format("textures[{}]", wanted.texture));
    if (texture.image == k_none) {
      Id& neutral = wanted.normal ? flat : white;
      if (neutral == k_none) {
        neutral = static_cast<Id>(scene_.images.size());
        scene_.images.push_back(wanted.normal ? constant_image("neutral normal map", {128, 128, 255, 255})
                                              : constant_image("neutral white", {255, 255, 255, 255}));
      }
      texture.image = neutral;
    }
    const auto key =
        std::make_tuple(texture.image, texture.wrap_u, texture.wrap_v, texture.nearest, texture.srgb);
    const auto [place, fresh] = unique.try_emplace(key, static_cast<Id>(scene_.textures.size()));
    if (fresh) scene_.textures.push_back(texture);
    final_ids.push_back(place->second);
  }
  for (Material& m : scene_.materials)
    for (const TextureSlot& slot : k_texture_slots)
      if (TextureUse& use = m.*slot.use) use.texture = final_ids[use.texture];
}

}  // namespace lucerna::scene
