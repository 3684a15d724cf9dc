#pragma once
// Writes an edited scene as glTF: the JSON of the source with the edits in it, so that everything that is not
// known here is kept. Buffers and images are not decoded, and stay where they are.
//
// What is written, beyond the values of glTF and KHR_lights_punctual:
// - extras.light_group of a light's node; extras.lucerna of the node: whether it is off, and the date and
//   place of a sun (own_extras.h);
// - matrices of nodes with a mesh, and KHR_node_visibility; extras.lucerna where a node's matrix gives other
//   last digits (own_extras.h);
// - extras.lucerna of the default scene: settings, and an environment that was edited;
// - extras.lucerna of cameras: lens, shift, section plane.
// - textures by file: a reference if the file lies in the saved scene's folder, else its bytes as a data URI.
// Values that were not edited are not touched. Reading the file gives exactly the edited values (but for
// positions in nodes whose parents are far from the origin).
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/texture_source.h"

namespace lucerna::scene {

struct SaveRequest {
  std::shared_ptr<const Scene> loaded;  ///< as load() gave it
  std::shared_ptr<const Scene> edited;  ///< the same with edited lights, materials, instances and environment
  /// Where textures of materials come from, by material, instead of from the file.
  std::map<uint32_t, TextureSources> textures = {};
  /// Cameras to add; one with the name of a camera of the file replaces it. In the scene's coordinates.
  std::vector<Camera> cameras = {};
  /// All settings that reading the file must give, whatever settings.json is beside it.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::filesystem::path file;  ///< ends in .gltf or .glb
  /// Replaces a file that is neither the scene's own, as it was loaded, nor `written`.
  bool replace = false;
  /// The JSON that this program wrote last to `file`; null: none.
  std::shared_ptr<const std::string> written = nullptr;
  /// Buffers and images outside the source's folder may be put into a .glb.
  bool outside = false;
};

struct SavedScene {
  std::shared_ptr<const std::string> written;  ///< the JSON
  std::vector<std::string> notes;              ///< what the user should know, one line each
};

/// Writes request.file, completely or not at all.
/// - .gltf from .gltf: the JSON alone. References are kept right if the folder differs.
/// - .glb from .glb: the binary chunk is copied.
/// - .glb from .gltf: buffers, and PNG and JPEG images, are put into the binary chunk; an environment's image
/// becomes
///   data in the JSON.
/// - .gltf from .glb: the binary chunk becomes NAME.bin beside it, written first.
/// Throws Error located at the file: its folder is missing or cannot be written, the file exists and is
/// neither the scene's own nor `written`, or it has changed on disk meanwhile (without `replace`); the scene
/// was not read from a file; a .glb's binary chunk is no longer there. The old file then stays.
SavedScene save(const SaveRequest& request);

}  // namespace lucerna::scene
