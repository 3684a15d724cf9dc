#include <algorithm>
#include <cctype>
#include <cstring>
#include <functional>

#include "base/error.h"
#include "base/file.h"
#include "scene/io/document.h"
#include "scene/io/images.h"
#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

namespace fs = std::filesystem;

/// True for "http:" and the like, and for absolute paths.
bool is_elsewhere(const std::string& uri) {
  if (uri.starts_with('/')) return true;
  const size_t colon = uri.find_first_of(":/");
  return colon != std::string::npos && uri[colon] == ':' && colon > 1;
}

std::string percent_encoded(const std::string& path) {
  std::string uri;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || std::strchr("-._~/!$&'()*+,;=@", c) || byte >= 0x80)
      uri += c;
    else
      uri += fmt::format("%{:02X}", byte);
  }
  return uri;
}

/// Calls `visit` with each reference to a file.
void for_each_uri(EditedJson& root, const std::function<void(EditedJson&)>& visit) {
  const auto visit_member = [&](EditedJson& object, const char* key) {
    if (!object.is_object()) return;
    if (const auto uri = object.find(key); uri != object.end() && uri->is_string()) visit(*uri);
  };
  for (const char* list : {"buffers", "images"})
    if (const auto found = root.find(list); found != root.end())
      for (EditedJson& item : *found) visit_member(item, "uri");
  // Extensions anywhere, for example profiles of lights.
  const std::function<void(EditedJson&, bool)> walk = [&](EditedJson& value, bool inside) {
    if (inside) visit_member(value, "uri");
    for (auto& [key, child] : value.items())
      if (child.is_structured() && key != "extras") walk(child, inside || key == "extensions");
  };
  walk(root, false);
  // Pictures of spots.
  static const EditedJson::json_pointer lamps("/extensions/KHR_lights_punctual/lights"),
      picture("/extras/lucerna/picture");
  if (root.contains(lamps) && root[lamps].is_array())
    for (EditedJson& lamp : root[lamps])
      if (lamp.contains(picture)) visit_member(lamp[picture], "uri");
  if (const auto scenes = root.find("scenes"); scenes != root.end())
    for (EditedJson& scene : *scenes)
      if (const auto extras = scene.find("extras"); extras != scene.end() && extras->is_object()) {
        if (const auto e = extras->find("environment"); e != extras->end()) visit_member(*e, "file");
        if (const auto own = extras->find("lucerna"); own != extras->end() && own->is_object())
          if (const auto e = own->find("environment"); e != own->end()) visit_member(*e, "file");
      }
}

/// Bytes of buffers and images in one binary chunk.
class Embedding {
 public:
  Embedding(EditedJson& root, const Folders& folders, bool outside, const std::string& where)
      : root_(root), folders_(folders), outside_(outside), where_(where) {}

  std::vector<uint8_t> run() {
    if (!can_move_buffers()) return {};
    std::vector<size_t> starts;
    if (const auto buffers = root_.find("buffers"); buffers != root_.end())
      for (EditedJson& buffer : *buffers) starts.push_back(append(buffer_bytes(buffer)));
    if (const auto views = root_.find("bufferViews"); views != root_.end())
      for (EditedJson& view : *views) {
        const size_t start = starts.at(view.at("buffer").get<size_t>());
        if (start > 0) view["byteOffset"] = start + view.value("byteOffset", size_t{0});
        view["buffer"] = 0;
      }
    embed_images();
    if (chunk_.empty()) return {};
    EditedJson buffer = root_["buffers"].is_array() && root_["buffers"].size() == 1 ? root_["buffers"][0]
                                                                                    : EditedJson::object();
    buffer.erase("uri");
    buffer["byteLength"] = chunk_.size();
    root_["buffers"] = EditedJson::array({std::move(buffer)});
    return std::move(chunk_);
  }

 private:
  /// Extensions of views name buffers by their own numbers.
  bool can_move_buffers() const {
    for (const char* list : {"buffers", "bufferViews"})
      if (const auto found = root_.find(list); found != root_.end())
        for (const EditedJson& item : *found)
          if (item.contains("extensions")) return false;
    return true;
  }

  size_t append(const std::string& bytes) {
    chunk_.resize((chunk_.size() + 3) / 4 * 4, 0);
    const size_t start = chunk_.size();
    chunk_.insert(chunk_.end(), bytes.begin(), bytes.end());
    return start;
  }

  std::string buffer_bytes(const EditedJson& buffer) const {
    std::string bytes = bytes_of(buffer.at("uri").get<std::string>());
    const auto length = buffer.at("byteLength").get<size_t>();
    if (bytes.size() < length)
      throw_error(where_, "a buffer has {} bytes, expected {}: it has changed since the scene was opened",
                  bytes.size(), length);
    bytes.resize(length);
    return bytes;
  }

  std::string bytes_of(const std::string& uri) const {
    if (is_data_uri(uri)) {
      const nlohmann::json text = uri;
      const std::vector<uint8_t> bytes = decode_data_uri(Item(where_, text));
      return {bytes.begin(), bytes.end()};
    }
    return lucerna::read_file(file_of(uri, folders_.from));
  }

  /// True if a scene may name this file.
  bool may_read(const std::string& uri) const {
    if (is_data_uri(uri) || outside_) return true;
    if (is_elsewhere(uri)) return false;
    Document document{LoadOptions{}};
    document.folder = folders_.from;
    try {
      require_inside(document, file_of(uri, folders_.from), where_);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  void embed_images() {
    const size_t count = root_.contains("images") ? root_["images"].size() : 0;
    for (size_t i = 0; i < count; ++i) {
      std::string bytes = image_bytes(root_["images"][i]);
      const std::string mime = mime_type(bytes);
      if (mime.empty()) continue;
      const size_t start = append(bytes);
      EditedJson& views = array_at(root_, "bufferViews");
      views.push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", bytes.size()}});
      const size_t view = views.size() - 1;
      EditedJson& image = root_["images"][i];
      image.erase("uri");
      image["mimeType"] = mime;
      image["bufferView"] = view;
    }
  }

  /// Of an image with a URI; "" if it may not be read, or cannot be, as before.
  std::string image_bytes(const EditedJson& image) const {
    const auto uri = image.find("uri");
    if (uri == image.end() || !may_read(uri->get<std::string>())) return "";
    try {
      return bytes_of(uri->get<std::string>());
    } catch (const Error&) {
      return "";
    }
  }

  EditedJson& root_;
  const Folders& folders_;
  bool outside_;
  const std::string& where_;
  std::vector<uint8_t> chunk_;
};

}  // namespace

fs::path file_of(const std::string& uri, const fs::path& folder) {
  const fs::path decoded = folder / percent_decode(uri);
  return !file_exists(decoded) && file_exists(folder / uri) ? folder / uri : decoded;
}

std::string uri_of(const fs::path& file, const fs::path& folder) {
  return percent_encoded(file.lexically_relative(folder).generic_string());
}

std::string moved_uri(const std::string& uri, const Folders& folders) {
  if (folders.same() || is_data_uri(uri) || is_elsewhere(uri)) return uri;
  return uri_of(absolute_path(file_of(uri, folders.from)), folders.to);
}

void move_uris(EditedJson& root, const Folders& folders) {
  if (folders.same()) return;
  for_each_uri(root, [&](EditedJson& uri) { uri = moved_uri(uri.get<std::string>(), folders); });
}

size_t count_outside(EditedJson root) {
  size_t outside = 0;
  // An environment that another one overrides is not read.
  if (const auto scenes = root.find("scenes"); scenes != root.end())
    for (EditedJson& scene : *scenes)
      if (scene.contains(EditedJson::json_pointer("/extras/lucerna/environment")))
        scene["extras"].erase("environment");
  for_each_uri(root, [&](const EditedJson& uri) { outside += uri.get<std::string>().starts_with("../"); });
  return outside;
}

std::vector<uint8_t> embed_files(EditedJson& root, const Folders& folders, bool outside,
                                 const std::string& where) {
  return Embedding(root, folders, outside, where).run();
}

}  // namespace lucerna::scene
