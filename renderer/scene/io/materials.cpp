// Materials, samplers and texture uses with their extensions.
#include <cmath>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

using tinygltf::Value;

double number(const Value& v, const char* key, double fallback) {
  if (!v.IsObject() || !v.Has(key)) return fallback;
  const Value& x = v.Get(key);
  const double n = x.IsNumber() ? x.GetNumberAsDouble() : fallback;
  return std::isfinite(n) ? n : fallback;
}

vec3 color(const Value& v, const char* key, vec3 fallback) {
  if (!v.IsObject() || !v.Has(key)) return fallback;
  const Value& x = v.Get(key);
  if (!x.IsArray() || x.ArrayLen() < 3) return fallback;
  for (int k = 0; k < 3; ++k) {
    const Value& e = x.Get(k);
    if (e.IsNumber() && std::isfinite(e.GetNumberAsDouble())) fallback[k] = float(e.GetNumberAsDouble());
  }
  return fallback;
}

const Value* extension(const tinygltf::ExtensionMap& map, const char* name) {
  const auto at = map.find(name);
  return at == map.end() ? nullptr : &at->second;
}

class Uses {
 public:
  Uses(Document& d, Scene& scene) : d_(d), scene_(scene) {}

  /// A texture use; the same image as colour and as data makes two textures.
  TextureUse make(int index, int uv_set, const Value* transform, bool srgb, const std::string& element) {
    TextureUse use;
    if (index < 0) return use;
    if (size_t(index) >= d_.model.textures.size()) d_.fail(element, fmt::format("texture {} does not exist", index));
    const auto key = std::pair(index, srgb);
    auto at = made_.find(key);
    if (at == made_.end()) {
      at = made_.emplace(key, Id(scene_.textures.size())).first;
      scene_.textures.push_back(make_texture(d_.model.textures[index], srgb, fmt::format("textures[{}]", index)));
    }
    use.texture = at->second;
    if (transform) {
      // Translation * rotation * scale, as KHR_texture_transform gives it.
      const auto pair = [&](const char* name, double a, double b) {
        std::pair<double, double> p{a, b};
        if (transform->Has(name) && transform->Get(name).IsArray() && transform->Get(name).ArrayLen() >= 2) {
          p.first = transform->Get(name).Get(0).GetNumberAsDouble();
          p.second = transform->Get(name).Get(1).GetNumberAsDouble();
        }
        return p;
      };
      const auto [ox, oy] = pair("offset", 0, 0);
      const auto [sx, sy] = pair("scale", 1, 1);
      const double r = number(*transform, "rotation", 0), c = std::cos(r), s = std::sin(r);
      use.m = {float(c * sx), float(s * sy), float(ox), float(-s * sx), float(c * sy), float(oy)};
      uv_set = int(number(*transform, "texCoord", uv_set));
    }
    if (uv_set > 1 || uv_set < 0) {
      d_.count("{} texture uses ask for a UV set beyond the second and get the first");
      uv_set = 0;
    }
    use.uv_set = uint32_t(uv_set);
    return use;
  }

  TextureUse make(const tinygltf::TextureInfo& info, bool srgb, const std::string& element) {
    return make(info.index, info.texCoord, extension(info.extensions, "KHR_texture_transform"), srgb, element);
  }
  TextureUse make(const tinygltf::NormalTextureInfo& info, const std::string& element) {
    return make(info.index, info.texCoord, extension(info.extensions, "KHR_texture_transform"), false, element);
  }
  /// A texture of an extension, which arrives as plain JSON values.
  TextureUse make(const Value& owner, const char* key, bool srgb, const std::string& element) {
    if (!owner.IsObject() || !owner.Has(key) || !owner.Get(key).IsObject()) return {};
    const Value& info = owner.Get(key);
    const Value* transform = nullptr;
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
      transform = &info.Get("extensions").Get("KHR_texture_transform");
    return make(int(number(info, "index", -1)), int(number(info, "texCoord", 0)), transform, srgb, element + "." + key);
  }

 private:
  Texture make_texture(const tinygltf::Texture& in, bool srgb, const std::string& element) {
    Texture t;
    t.srgb = srgb;
    if (in.source < 0 || size_t(in.source) >= d_.model.images.size()) {
      d_.count("{} textures have no image that can be read and are white");
      t.image = Id(d_.model.images.size());  // the white one, kept last
    } else {
      t.image = Id(in.source);
    }
    if (in.sampler >= 0) {
      if (size_t(in.sampler) >= d_.model.samplers.size()) d_.fail(element, fmt::format("sampler {} does not exist", in.sampler));
      const tinygltf::Sampler& s = d_.model.samplers[in.sampler];
      const auto wrap = [](int w) {
        return w == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ? Wrap::clamp : w == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
      };
      t.wrap_u = wrap(s.wrapS);
      t.wrap_v = wrap(s.wrapT);
      t.nearest = s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    return t;
  }

  Document& d_;
  Scene& scene_;
  std::map<std::pair<int, bool>, Id> made_;
};

float unit(double x) { return float(std::clamp(std::isfinite(x) ? x : 0.0, 0.0, 1.0)); }

}  // namespace

void load_materials(Document& d, Scene& scene) {
  Uses uses(d, scene);
  for (size_t i = 0; i < d.model.materials.size(); ++i) {
    const tinygltf::Material& in = d.model.materials[i];
    const std::string element = fmt::format("materials[{}]", i);
    Material m;
    m.name = in.name.empty() ? fmt::format("material {}", i) : in.name;
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    for (size_t k = 0; k < 4 && k < pbr.baseColorFactor.size(); ++k) m.base_color[k] = unit(pbr.baseColorFactor[k]);
    m.base_color_texture = uses.make(pbr.baseColorTexture, true, element + ".baseColorTexture");
    m.metallic = unit(pbr.metallicFactor);
    m.roughness = unit(pbr.roughnessFactor);
    m.metallic_roughness_texture = uses.make(pbr.metallicRoughnessTexture, false, element + ".metallicRoughnessTexture");
    m.normal_texture = uses.make(in.normalTexture, element + ".normalTexture");
    m.normal_scale = float(in.normalTexture.scale);
    double strength = 1;
    if (const Value* e = extension(in.extensions, "KHR_materials_emissive_strength")) strength = std::max(0.0, number(*e, "emissiveStrength", 1));
    for (size_t k = 0; k < 3 && k < in.emissiveFactor.size(); ++k) m.emission[k] = float(std::max(0.0, in.emissiveFactor[k]) * strength);
    m.emission_texture = uses.make(in.emissiveTexture, true, element + ".emissiveTexture");
    m.alpha_mode = in.alphaMode == "MASK" ? AlphaMode::mask : in.alphaMode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
    m.alpha_cutoff = float(in.alphaCutoff);
    m.double_sided = in.doubleSided;
    m.unlit = extension(in.extensions, "KHR_materials_unlit") != nullptr;
    if (const Value* e = extension(in.extensions, "KHR_materials_ior")) m.ior = float(number(*e, "ior", 1.5));
    if (m.ior != 0 && m.ior < 1) d.count("{} materials have an index of refraction below 1, which becomes 1"), m.ior = 1;
    if (const Value* e = extension(in.extensions, "KHR_materials_specular")) {
      m.specular = unit(number(*e, "specularFactor", 1));
      m.specular_texture = uses.make(*e, "specularTexture", false, element);
      m.specular_color = glm::max(vec3(0), color(*e, "specularColorFactor", vec3(1)));
      m.specular_color_texture = uses.make(*e, "specularColorTexture", true, element);
    }
    if (const Value* e = extension(in.extensions, "KHR_materials_transmission")) {
      m.transmission = unit(number(*e, "transmissionFactor", 0));
      m.transmission_texture = uses.make(*e, "transmissionTexture", false, element);
    }
    if (const Value* e = extension(in.extensions, "KHR_materials_volume")) {
      m.thickness = float(std::max(0.0, number(*e, "thicknessFactor", 0)));
      const double distance = number(*e, "attenuationDistance", INFINITY);
      m.attenuation_distance = distance > 0 ? float(distance) : k_infinity;
      m.attenuation_color = glm::clamp(color(*e, "attenuationColor", vec3(1)), vec3(0), vec3(1));
    }
    if (const Value* e = extension(in.extensions, "KHR_materials_diffuse_transmission")) {
      m.diffuse_transmission = unit(number(*e, "diffuseTransmissionFactor", 0));
      m.diffuse_transmission_texture = uses.make(*e, "diffuseTransmissionTexture", false, element);
      m.diffuse_transmission_color = glm::clamp(color(*e, "diffuseTransmissionColorFactor", vec3(1)), vec3(0), vec3(1));
      m.diffuse_transmission_color_texture = uses.make(*e, "diffuseTransmissionColorTexture", true, element);
    }
    scene.materials.push_back(std::move(m));
  }
  Material fallback;
  fallback.name = "default";
  scene.materials.push_back(fallback);
}

}  // namespace lucerna::scene::io
