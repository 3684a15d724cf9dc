#include "scene/io/save.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "scene/io/container.h"
#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

namespace fs = std::filesystem;

bool ends_in(const fs::path& file, const char* ending) {
  std::string own = file.extension().string();
  std::transform(own.begin(), own.end(), own.begin(), [](unsigned char c) { return std::tolower(c); });
  return own == ending;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

Container opened(const fs::path& file) {
  const std::string bytes = lucerna::read_file(file);
  return take_apart({bytes.begin(), bytes.end()}, file.string());
}

/// Without the padding of a .glb.
std::string_view trimmed(std::string_view text) { return text.substr(0, text.find_last_not_of(" \n") + 1); }

/// Refuses to replace what the user may not know of.
void check_target(const SaveRequest& request, const std::string& where) {
  check_writable(request.file);
  if (request.replace || !file_exists(request.file)) return;
  const bool own = is_same_file(request.file, request.loaded->file);
  if (!own && !request.written)
    throw Error(where, "the file exists and is not the open scene; replace=true replaces it");
  std::string text;
  try {
    text = trimmed(opened(request.file).json());
  } catch (const Error&) {  // no glTF any more: changed too
  }
  const bool known = (own && text == trimmed(*request.loaded->document)) ||
                     (request.written && text == trimmed(*request.written));
  if (!known)
    throw Error(where,
                "the file has changed on disk since it was opened or saved here; replace=true replaces it");
}

/// The rest of a .glb behind its JSON, as long as it still belongs to the scene.
Container source_container(const Scene& loaded) {
  const EditedJson root = EditedJson::parse(*loaded.document);
  const auto list = root.find("buffers");
  const bool inside = list != root.end() && std::any_of(list->begin(), list->end(), [](const EditedJson& b) {
                        return !b.contains("uri");
                      });
  // A .gltf is complete without its file.
  if (!inside && !file_exists(loaded.file)) return {};
  Container source = opened(loaded.file);
  // Reading another file's bytes with these views would show wrong geometry.
  const auto buffers = [](std::string_view json) {
    const EditedJson now = EditedJson::parse(json, nullptr, false);
    return now.is_object() && now.contains("buffers") ? now["buffers"] : EditedJson();
  };
  if (inside && source.json() != *loaded.document && buffers(source.json()) != buffers(*loaded.document))
    throw Error(loaded.file,
                "the file has changed on disk since it was opened: its geometry is no longer there");
  return source;
}

std::string stem_of(const fs::path& file) { return file.stem().string(); }

/// Buffers of a .glb as a file beside the .gltf.
void write_bin(const SaveRequest& request, EditedJson& root, std::string_view bin) {
  const fs::path file = request.file.parent_path() / (stem_of(request.file) + ".bin");
  if (!request.replace && !request.written && file_exists(file))
    throw Error(file.string(), "the file exists; replace=true replaces it");
  EditedJson& buffer = root.at("buffers").at(0);
  write_file(file, bin.substr(0, std::min(bin.size(), buffer.at("byteLength").get<size_t>())));
  buffer["uri"] = uri_of(file.filename(), fs::path());
}

}  // namespace

SavedScene save(const SaveRequest& request) {
  const std::string where = request.file.string();
  const bool binary = ends_in(request.file, ".glb");
  if (!binary && !ends_in(request.file, ".gltf"))
    throw Error(where, "a scene is saved as .gltf or .glb; name a file with one of these endings");
  const Scene& loaded = *request.loaded;
  if (!loaded.document) throw Error(where, "the scene was not read from a file");
  check_target(request, where);

  const Container source = source_container(loaded);
  const Folders folders{absolute_path(loaded.file).parent_path(), absolute_path(request.file).parent_path()};
  EditedJson root = EditedJson::parse(*loaded.document);
  EditedJson before = root;
  SavedScene saved;
  write_lights(root, loaded, *request.edited);
  write_objects(root, loaded, *request.edited, saved.notes);
  write_materials(root, request, folders);
  write_cameras(root, loaded.origin, request.cameras);

  std::vector<uint8_t> chunk;
  if (binary && !source.binary) chunk = embed_files(root, folders, request.outside, where);
  move_uris(root, folders);
  write_scene_extras(root, request, folders);
  if (const size_t outside = count_outside(root); outside > count_outside(before))
    saved.notes.push_back(
        fmt::format("{}: {} files that it names lie outside its folder; opening it needs --allow-outside, or "
                    "scene.open FILE outside=true",
                    where, outside));
  if (!binary && source.has_bin) write_bin(request, root, source.bin());
  // Untouched documents stay as they are, to the byte.
  const std::string text = root == before ? *loaded.document : text_like(root, *loaded.document);
  if (!binary)
    write_file(request.file, text);
  else if (source.binary)
    write_file(request.file, glb_bytes(text, source.chunks()));
  else
    write_file(request.file, glb_bytes(text, chunk_bytes(chunk)));
  saved.written = std::make_shared<const std::string>(text);
  return saved;
}

}  // namespace lucerna::scene
