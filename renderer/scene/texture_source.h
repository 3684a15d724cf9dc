#pragma once
// Where the textures of an edited material come from.
#include <map>
#include <string>

#include "scene/scene.h"

namespace lucerna::scene {

struct TextureSource {
  enum class Kind : uint32_t {
    own,   ///< as the material's file has it, or none
    none,  ///< removed
    file,  ///< an image file, read by the own texture's coordinates if there is one, else by the first set
    material,  ///< the slot of another material, as the file has that
  };
  Kind kind = Kind::own;
  std::string file;
  Id material = k_none;
  bool operator==(const TextureSource&) const = default;
};

/// By slot, an index into k_texture_slots; the others are own.
using TextureSources = std::map<uint32_t, TextureSource>;
/// That of a slot.
const TextureSource& source_of(const TextureSources& sources, uint32_t slot);

/// The use that a material has by a source; of a file that of the own texture, to read another one by. Throws
/// Error: there is no such material.
TextureUse use_of(const Scene& loaded, uint32_t material, uint32_t slot, const TextureSource& source);

/// True if texels of the slot are colour (sRGB in 8-bit files).
bool is_colour(const TextureSlot& slot);
/// True if its texels are normals: neutral is a flat one.
bool is_normal_map(const TextureSlot& slot);
/// Index of the slot of that name; size of k_texture_slots: none.
uint32_t texture_slot(const std::string& name);

/// The sources that give `edited` its textures. `loaded`: the same scene as its file has it. Throws nothing;
/// a texture that neither has is own.
TextureSources texture_sources(const Scene& loaded, const Scene& edited, uint32_t material);

/// Removes images and textures that neither the loaded scene has nor anything of `edited` uses.
void drop_unused_textures(Scene& edited, const Scene& loaded);

}  // namespace lucerna::scene
