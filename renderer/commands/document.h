#pragma once
// The undoable state of an open scene, as plain values. Commands change it; differences are sent to the
// session (open_scene.h).
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/object_place.h"
#include "scene/scene.h"
#include "scene/texture_source.h"
#include "session/session.h"

namespace lucerna::commands {

/// Places of objects by their number from 0; the others are where their file has them.
using Objects = std::map<uint32_t, scene::ObjectPlace>;

struct Document {
  struct Material : scene::MaterialFactors {
    scene::TextureSources textures;
    bool emits = true;  ///< false: its emission is stored, but switched off
    Material() = default;
    explicit Material(const scene::MaterialFactors& factors) : MaterialFactors(factors) {}
    /// The values that the scene has.
    Material in_scene() const;
    bool operator==(const Material&) const = default;
  };
  std::map<std::string, std::string> settings;  ///< by key
  std::vector<scene::Light> lights;             ///< as commands number them
  std::vector<Material> materials;              ///< likewise
  /// Only objects that are not where their file has them.
  Objects objects;
  float environment_scale = 1;
  float environment_rotation = 0;      ///< degrees
  std::string environment_file;        ///< image that replaces the scene's own environment; "": none
  std::optional<scene::SkyModel> sky;  ///< replaces the scene's own environment
  int solo = -1;                       ///< component shown alone, or -1
  ByComponent<bool> shown_before{};    ///< restored after solo
  bool operator==(const Document&) const = default;
};

}  // namespace lucerna::commands
