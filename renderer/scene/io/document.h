#pragma once
// Shared by the parts of the loader: the parsed file, checked access to its accessors, and the warnings.
#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/io/load.h"

namespace lucerna::scene::io {

struct Document {
  std::filesystem::path file;
  tinygltf::Model model;
  std::map<std::string, uint64_t> counted;  ///< warning text with {} -> count

  [[noreturn]] void fail(const std::string& element, const std::string& what) const {
    throw Error(file.filename().string() + ": " + element, what);
  }
  void count(const std::string& warning, uint64_t n = 1) { counted[warning] += n; }
};

/// Elements of an accessor as floats (normalized integers scaled as glTF says), `components` each; sparse applied.
/// Fails located at `element` when anything is out of range.
std::vector<float> read_floats(const Document& d, int accessor, int components, const std::string& element);
/// Scalars of an unsigned integer accessor.
std::vector<uint32_t> read_indices(const Document& d, int accessor, const std::string& element);
/// Number of components of an accessor's type (checked index).
int component_count(const Document& d, int accessor, const std::string& element);

void load_materials(Document& d, Scene& scene);
void load_images(Document& d, Scene& scene, const LoadOptions& options, const LoadProgress& progress);
void load_meshes(Document& d, Scene& scene, const LoadProgress& progress);
void load_nodes(Document& d, Scene& scene);
/// Environment from the glTF scene's extras, then settings.json.
void load_settings(Document& d, Scene& scene);

/// A float image by OpenImageIO; Error located at the file.
Image read_float_image(const std::filesystem::path& file);

}  // namespace lucerna::scene::io
