#include "scene/texture_source.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace lucerna::scene {
namespace {

/// New indices of the elements from `first` on that are used; k_none: dropped. Those before stay.
std::vector<Id> kept_indices(const std::vector<bool>& used, size_t first) {
  std::vector<Id> to(used.size(), k_none);
  Id next = 0;
  for (size_t i = 0; i < used.size(); ++i)
    if (i < first || used[i]) to[i] = next++;
  return to;
}

template <class List>
void keep_only(List& list, const std::vector<Id>& to) {
  if (std::find(to.begin(), to.end(), k_none) == to.end()) return;
  List kept;
  for (size_t i = 0; i < to.size(); ++i)
    if (to[i] != k_none) kept.push_back(std::as_const(list)[i]);
  list = std::move(kept);
}

}  // namespace

const TextureSource& source_of(const TextureSources& sources, uint32_t slot) {
  static const TextureSource own;
  const auto found = sources.find(slot);
  return found == sources.end() ? own : found->second;
}

TextureUse use_of(const Scene& loaded, uint32_t material, uint32_t slot, const TextureSource& source) {
  using Kind = TextureSource::Kind;
  if (source.kind == Kind::none) return {};
  const Id from = source.kind == Kind::material ? source.material : material;
  if (from >= loaded.materials.size()) throw_error("material", "there is no material {}", from);
  return loaded.materials[from].*k_texture_slots[slot].use;
}

bool is_colour(const TextureSlot& slot) {
  for (const auto use :
       {&Material::base_color_texture, &Material::emission_texture, &Material::specular_color_texture,
        &Material::sheen_color_texture, &Material::diffuse_transmission_color_texture})
    if (slot.use == use) return true;
  return false;
}

bool is_normal_map(const TextureSlot& slot) {
  return slot.use == &Material::normal_texture || slot.use == &Material::clearcoat_normal_texture;
}

uint32_t texture_slot(const std::string& name) {
  uint32_t slot = 0;
  while (slot < std::size(k_texture_slots) && name != k_texture_slots[slot].name) ++slot;
  return slot;
}

TextureSources texture_sources(const Scene& loaded, const Scene& edited, uint32_t index) {
  TextureSources sources;
  const Material &before = loaded.materials.at(index), &after = edited.materials.at(index);
  for (uint32_t s = 0; s < std::size(k_texture_slots); ++s) {
    const TextureUse& use = after.*k_texture_slots[s].use;
    if (use == before.*k_texture_slots[s].use) continue;
    if (!use) {
      sources[s].kind = TextureSource::Kind::none;
    } else if (use.texture >= loaded.textures.size()) {
      const Id image = std::as_const(edited.textures)[use.texture].image;
      sources[s] = {TextureSource::Kind::file, std::as_const(edited.images)[image].name};
    } else {
      for (Id m = 0; m < loaded.materials.size(); ++m)
        if (loaded.materials[m].*k_texture_slots[s].use == use) {
          sources[s] = {TextureSource::Kind::material, "", m};
          break;
        }
    }
  }
  return sources;
}

void drop_unused_textures(Scene& edited, const Scene& loaded) {
  std::vector<bool> textures(edited.textures.size()), images(edited.images.size());
  for (const Material& m : edited.materials)
    for (const TextureSlot& slot : k_texture_slots)
      if (m.*slot.use) textures[(m.*slot.use).texture] = true;
  const std::vector<Id> to_texture = kept_indices(textures, loaded.textures.size());
  keep_only(edited.textures, to_texture);
  for (Material& m : edited.materials)
    for (const TextureSlot& slot : k_texture_slots)
      if (m.*slot.use) (m.*slot.use).texture = to_texture[(m.*slot.use).texture];
  for (const Texture& t : std::as_const(edited.textures))
    if (t.image != k_none) images[t.image] = true;
  if (edited.environment.image != k_none) images[edited.environment.image] = true;
  const std::vector<Id> to_image = kept_indices(images, loaded.images.size());
  keep_only(edited.images, to_image);
  for (Texture& t : edited.textures)
    if (t.image != k_none) t.image = to_image[t.image];
  if (edited.environment.image != k_none) edited.environment.image = to_image[edited.environment.image];
}

}  // namespace lucerna::scene
