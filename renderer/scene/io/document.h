#pragma once
// A glTF file as read and checked, before anything is made of it.
#include <atomic>
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

/// The scene asks for more memory than it may take.
class OverBudget : public Error {
 public:
  using Error::Error;
};

/// A file that the scene names is not in its folder.
class OutsideFolder : public Error {
 public:
  using Error::Error;
};

/// What a scene may still take of LoadOptions::most_bytes. What it has taken for good or for a while is never
/// given back, so that this also bounds the work that a small file can ask for. Any thread.
class Budget {
 public:
  explicit Budget(uint64_t most) : most_(most) {}
  /// Throws OverBudget at `where` when `bytes` more go beyond what is allowed; the format says for what
  /// ("{} instances").
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

/// What every step of loading needs.
struct Document {
  Document(const LoadOptions& options) : budget(options.most_bytes), outside(options.outside) {}

  std::string file;              ///< as given, for messages
  std::filesystem::path folder;  ///< where relative references start
  nlohmann::json json;           ///< the whole document
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
/// "%20" and the like to bytes; a stray % stays.
std::string percent_decode(const std::string& uri);
/// The file that a URI means (percent-decoded; as written if only that exists). Throws OutsideFolder at the
/// item when it is not one of the scene's folder.
std::filesystem::path resolve_uri(const Document& document, const Item& uri);
/// Throws OutsideFolder at `where` unless the file is in the scene's folder or below, its symbolic links
/// followed, or files outside may be read. The file need not exist.
void require_inside(const Document& document, const std::filesystem::path& file, const std::string& where);

/// Reads the container, the JSON and the buffers, and checks types, indices and sizes of everything that
/// later steps touch (check_structure), then lets tinygltf make its model.
void open_document(Document& document, const std::filesystem::path& path);

/// Throws a located Error unless the document's structure is that of glTF 2.0 as far as we read it: after it
/// every index is in range, every view inside its buffer, every accessor inside its view, the node graph a
/// forest.
void check_structure(const Document& document);
/// extras.light_group of a node, material or lamp, a text or a whole number, as light_groups.h has names; ""
/// where there is none. Throws a located Error when it is something else.
std::string light_group(const Item& item);
/// Whether an extension is honoured (load.h lists them).
bool is_known_extension(const std::string& name);

}  // namespace lucerna::scene
