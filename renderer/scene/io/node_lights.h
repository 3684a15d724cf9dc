#pragma once
// Lights of a glTF file's nodes: KHR_lights_punctual with shapes of extras.lucerna, and EXT_lights_ies.
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "scene/io/document.h"

namespace lucerna::scene {

class NodeLights {
 public:
  explicit NodeLights(Document& document) : document_(document), root_(document.root()) {}

  struct Place {
    uint32_t node;
    const std::string &name, &group;  ///< of the node; the group may be empty
    const glm::dmat4& world;
    bool hidden = false;  ///< the light is off unless extras.lucerna says otherwise
  };
  /// The light of a node's KHR_lights_punctual. Throws a located Error; a shape that cannot be used is a
  /// warning.
  Light punctual(const Item& reference, const Place& place);
  /// The light of a node's EXT_lights_ies, its intensity the file's largest times multiplier and colour; a
  /// warning and nothing if its file cannot be read.
  std::optional<Light> with_profile(const Item& reference, const Place& place);

 private:
  std::shared_ptr<const LightProfile> profile_of(const Item& reference);
  /// The picture that extras.lucerna of a spot names; a warning and null if it cannot be read.
  std::shared_ptr<const LightPicture> picture_of(const Item& definition, size_t number);

  Document& document_;
  Item root_;
  std::map<size_t, std::shared_ptr<const LightProfile>> profiles_;  // by number; null: cannot be read
  std::map<size_t, std::shared_ptr<const LightPicture>> pictures_;  // likewise
};

}  // namespace lucerna::scene
