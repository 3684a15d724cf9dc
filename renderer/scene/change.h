#pragma once
// Kinds of edits. Code that keeps data computed from a scene decides by these, and by the keys of changed
// settings, which of it is still valid (solvers/info.h).
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/math.h"

namespace lucerna::scene {

enum class Change : uint32_t {
  camera,       ///< place, direction or kind of the camera
  size,         ///< width or height of the picture
  lamp,         ///< a punctual light's strength, colour, place, cone, or whether it is on
  environment,  ///< the environment's strength or rotation
  colour,       ///< diffuse colour, roughness or emission of a surface that is diffuse before and after
  material,     ///< any other factor of a material: a mirror may become diffuse
  place,        ///< objects are moved, turned, sized, hidden or shown
  shape,        ///< geometry, textures, transparency: another scene
  shaders,      ///< the kernels
  restart,      ///< no change: the user restarts the picture
};
inline constexpr Change k_all_changes[] = {
    Change::camera,   Change::size,  Change::lamp,  Change::environment, Change::colour,
    Change::material, Change::place, Change::shape, Change::shaders,     Change::restart};

/// Several changes.
struct Changes {
  std::set<Change> edits;
  std::set<std::string> settings;  ///< keys of changed settings
  std::vector<Box> moved;          ///< with `place`: world-space boxes that objects have left or entered

  Changes() = default;
  Changes(Change edit) : edits{edit} {}  // NOLINT: one edit is a set of edits
  bool empty() const { return edits.empty() && settings.empty(); }
  Changes& operator|=(const Changes& other) {
    edits.insert(other.edits.begin(), other.edits.end());
    settings.insert(other.settings.begin(), other.settings.end());
    moved.insert(moved.end(), other.moved.begin(), other.moved.end());
    return *this;
  }
  /// True if rays meet other surfaces.
  bool other_surfaces() const { return edits.contains(Change::place) || edits.contains(Change::shape); }
};

}  // namespace lucerna::scene
