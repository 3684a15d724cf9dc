#pragma once
// A glTF file, read and checked, before conversion.
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "scene/io/json.h"
#include "scene/io/load.h"

namespace lucerna::scene {

/// Warnings by kind, with counts: each kind is one line of the scene.
class Warnings {
 public:
  /// Adds `count` cases of `kind`, a sentence in which "{}" is replaced by the count; `example` locates the
  /// first case.
  void add(const std::string& kind, const std::string& example = {}, uint64_t count = 1);
  /// One line per kind, in order of first occurrence.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string kind, example;
    uint64_t count = 0;
  };
  std::vector<Entry> entries_;
  std::map<std::string, size_t> index_;
};

/// The scene needs more memory than allowed.
class OverBudget : public Error {
 public:
  using Error::Error;
};

/// A file named by the scene is outside its folder.
class OutsideFolder : public Error {
 public:
  using Error::Error;
};

/// The remaining part of LoadOptions::most_bytes. Memory used temporarily counts too, so this also bounds the
/// work that a small file can cause. Thread-safe.
class Budget {
 public:
  explicit Budget(uint64_t most) : most_(most) {}
  /// Throws OverBudget at `where` if `bytes` more exceed the budget; the format describes their use ("{}
  /// instances").
  template <class... Args>
  void take(uint64_t bytes, const std::string& where, fmt::format_string<Args...> format, Args&&... args) {
    const uint64_t before = taken_.fetch_add(bytes);
    if (before <= most_ && bytes <= most_ - before) return;
    taken_ = most_;
    refuse(bytes, before, where, fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  [[noreturn]] void refuse(uint64_t bytes, uint64_t before, const std::string& where,
                           const std::string& what) const;
  uint64_t most_;
  std::atomic<uint64_t> taken_{0};
};

/// Shared state of all loading steps.
struct Document {
  Document(const LoadOptions& options) : budget(options.most_bytes), outside(options.outside) {}

  std::string file;                         ///< as given, for messages
  std::filesystem::path folder;             ///< where relative references start
  nlohmann::json json;                      ///< the whole document
  std::shared_ptr<const std::string> text;  ///< of the JSON, as in the file
  tinygltf::Model model;  ///< accessors, meshes, nodes, cameras, samplers, textures; buffers with their bytes
  Warnings warnings;
  std::function<void(float, const char*)> progress;  ///< throws Cancelled
  mutable Budget budget;                             ///< of memory
  bool outside;                                      ///< files outside the folder are read too
  /// Elements of sparse accessors, by index, once one has been read.
  std::map<uint32_t, std::vector<uint8_t>> sparse;

  Item root() const { return Item(file, json); }
};

/// The bytes of a regular file. Throws an Error that starts with `where`.
std::vector<uint8_t> read_file(const Document& document, const std::filesystem::path& path,
                               const std::string& where);
std::vector<uint8_t> read_file(const std::filesystem::path& path, const std::string& where, Budget& budget);

/// Bytes behind a "data:" URI. Throws an Error at `item` unless it is base64 or percent-encoded text.
std::vector<uint8_t> decode_data_uri(const Item& item);
bool is_data_uri(const std::string& uri);
/// Decodes "%20" and the like; a stray % stays.
std::string percent_decode(const std::string& uri);
/// The file that a URI names (percent-decoded, or as written if only that exists). Throws OutsideFolder at
/// the item if it is outside the scene's folder.
std::filesystem::path resolve_uri(const Document& document, const Item& uri);
/// The bytes that a URI has, or those of the file that it names. Throws like the functions above.
std::vector<uint8_t> uri_bytes(const Document& document, const Item& uri);
/// The bytes of the buffer view of that index.
std::vector<uint8_t> view_bytes(const Document& document, const Item& index);
/// Throws OutsideFolder at `where` unless the file is in the scene's folder or below, symbolic links
/// followed, or files outside are allowed. The file need not exist.
void require_inside(const Document& document, const std::filesystem::path& file, const std::string& where);

/// Reads the container, the JSON and the buffers, and checks types, indices and sizes of everything that
/// later steps touch (check_structure), then lets tinygltf make its model.
void open_document(Document& document, const std::filesystem::path& path);

/// Throws a located Error unless the parts that are read are valid glTF 2.0: afterwards every index is in
/// range, every view inside its buffer, every accessor inside its view, and the node graph is a forest.
void check_structure(const Document& document);
/// extras.light_group of a node, material or lamp: a text or a whole number, normalized as in light_groups.h;
/// "" if there is none. Throws a located Error for other types.
std::string light_group(const Item& item);
/// extras.portal of a node or mesh; none: not given. Throws a located Error for other types.
std::optional<bool> portal_mark(const Item& item);
/// True if the extension is supported (load.h lists them).
bool is_known_extension(const std::string& name);

}  // namespace lucerna::scene
