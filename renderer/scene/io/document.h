#pragma once
// A glTF file as read and checked, before anything is made of it.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "scene/io/json.h"
#include "scene/io/load.h"

namespace lucerna::scene {

/// Counted warnings: each kind is one line of the scene, whatever the number of cases.
class Warnings {
 public:
  /// Adds `count` cases of `kind`, a sentence in which "{}" stands for the count; `example` locates the first
  /// case.
  void add(const std::string& kind, const std::string& example = {}, uint64_t count = 1);
  /// One line a kind, in the order in which they first came.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string kind, example;
    uint64_t count = 0;
  };
  std::vector<Entry> entries_;
  std::map<std::string, size_t> index_;
};

/// What every step of loading needs.
struct Document {
  std::string file;              ///< as given, for messages
  std::filesystem::path folder;  ///< where relative references start
  nlohmann::json json;           ///< the whole document
  tinygltf::Model model;  ///< accessors, meshes, nodes, cameras, samplers, textures; buffers with their bytes
  Warnings warnings;
  std::function<void(float, const char*)> progress;  ///< throws Cancelled

  Item root() const { return Item(file, json); }
};

/// The bytes of a regular file. Throws an Error that starts with `where`.
std::vector<uint8_t> read_file(const std::filesystem::path& path, const std::string& where);

/// Bytes behind a "data:" URI. Throws an Error at `item` unless it is base64 or percent-encoded text.
std::vector<uint8_t> decode_data_uri(const Item& item);
bool is_data_uri(const std::string& uri);
/// "%20" and the like to bytes; a stray % stays.
std::string percent_decode(const std::string& uri);
/// The file that a relative URI means (percent-decoded; as written if only that exists).
std::filesystem::path resolve_uri(const Document& document, const std::string& uri);

/// Reads the container, the JSON and the buffers, and checks types, indices and sizes of everything that
/// later steps touch (check_structure), then lets tinygltf make its model.
void open_document(Document& document, const std::filesystem::path& path);

/// Throws a located Error unless the document's structure is that of glTF 2.0 as far as we read it: after it
/// every index is in range, every view inside its buffer, every accessor inside its view, the node graph a
/// forest.
void check_structure(const Document& document);
/// Whether an extension is honoured (load.h lists them).
bool is_known_extension(const std::string& name);

}  // namespace lucerna::scene
