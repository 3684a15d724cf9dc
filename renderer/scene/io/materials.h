#pragma once
// Materials and textures of a glTF document.
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "scene/io/document.h"

namespace lucerna::scene {

/// Data of a material needed for geometry.
struct MaterialNeeds {
  /// n of the TEXCOORD_n that its textures read as TextureUse::uv_set 0 and 1; -1: none. 0 and 1 are
  /// themselves unless a set beyond them came first.
  std::array<int, 2> sets{-1, -1};
  /// The use whose texture coordinates give the tangents, if it needs them; it may be without a texture.
  std::optional<TextureUse> tangents;
};

/// Reads materials on demand, and their images at the end.
class MaterialLoader {
 public:
  MaterialLoader(Document& document, Scene& scene) : document_(document), scene_(scene) {}

  /// The scene's id of glTF material `index` (-1: glTF's default material); read on the first call.
  Id material(int index);
  /// Number of the scene's variants.
  size_t variants() const { return scene_.variants.size(); }
  const MaterialNeeds& needs(Id material) const { return needs_[material]; }

  /// Decodes every used image and fills Scene::images and Scene::textures. `decode` false: neutral images
  /// instead.
  void load_images(bool decode);

 private:
  struct Wanted {          // a texture as a material needs it
    uint32_t texture = 0;  // glTF index
    bool srgb = false;
    bool normal = false;
    bool operator<(const Wanted& o) const {
      return std::tie(texture, srgb, normal) < std::tie(o.texture, o.srgb, o.normal);
    }
  };
  enum class Use { colour, data, normal };

  TextureUse texture_use(const Item& parent, const char* key, Use use, MaterialNeeds& needs);
  void read(const Item& item, Material& material, MaterialNeeds& needs);
  void read_extensions(const Item& extensions, Material& material, MaterialNeeds& needs);
  /// Coat, sheen, anisotropy and thin film.
  void read_layers(const Item& extensions, Material& material, MaterialNeeds& needs);
  float factor(const Item& parent, const char* key, float fallback, float lo, float hi);
  vec3 color(const Item& parent, const char* key, vec3 fallback, float hi);

  Document& document_;
  Scene& scene_;
  std::map<int, Id> known_;
  std::vector<MaterialNeeds> needs_;
  std::vector<Wanted> wanted_;  // TextureUse::texture indexes this until load_images
  std::map<Wanted, Id> wanted_ids_;
};

}  // namespace lucerna::scene
