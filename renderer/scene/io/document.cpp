#include "scene/io/document.h"

#include <algorithm>
#include <fstream>

#include "base/json_text.h"
#include "scene/io/container.h"
#include "scene/light_groups.h"

namespace lucerna::scene {

namespace {

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

void read_buffers(Document& document, const Container& container) {
  const auto buffers = document.root().find("buffers");
  const size_t count = buffers ? buffers->size() : 0;
  document.model.buffers.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Item buffer = buffers->at(i);
    const auto length = static_cast<size_t>(buffer.at("byteLength").integer(1, int64_t{1} << 40));
    std::vector<uint8_t>& data = document.model.buffers[i].data;
    if (const auto uri = buffer.find("uri")) {
      data = uri_bytes(document, *uri);
    } else {
      if (!container.binary || i != 0) buffer.fail("'uri' is missing");
      if (!container.has_bin) buffer.fail("the .glb has no binary chunk");
      data.assign(container.bytes.begin() + static_cast<std::ptrdiff_t>(container.bin_begin),
                  container.bytes.begin() + static_cast<std::ptrdiff_t>(container.bin_end));
    }
    if (data.size() < length)
      buffer.fail("byteLength is {}, but only {} bytes are there", length, data.size());
    data.resize(length);
  }
}

// Copies the members that tinygltf shall see. It gets nothing else: extensions, extras, materials and images
// are read here, with located messages, and its own image and file reading stays out of the way.
nlohmann::json pick(const nlohmann::json& from, std::initializer_list<const char*> keys) {
  nlohmann::json result = nlohmann::json::object();
  for (const char* key : keys)
    if (const auto found = from.find(key); found != from.end()) result[key] = *found;
  return result;
}

nlohmann::json pick_each(const nlohmann::json& root, const char* list,
                         std::initializer_list<const char*> keys) {
  nlohmann::json result = nlohmann::json::array();
  if (const auto found = root.find(list); found != root.end())
    for (const nlohmann::json& element : *found) result.push_back(pick(element, keys));
  return result;
}

// tinygltf takes 3.0 for a float and refuses it as an integer; JSON schema does not distinguish them.
void whole_numbers_to_integers(nlohmann::json& value) {
  if (value.is_structured()) {
    for (nlohmann::json& child : value) whole_numbers_to_integers(child);
  } else if (value.is_number_float()) {
    const double number = value.get<double>();
    if (number >= 0 && number < 9.0e15 && number == static_cast<double>(static_cast<uint64_t>(number)))
      value = static_cast<uint64_t>(number);
  }
}

void make_model(Document& document) {
  const nlohmann::json& root = document.json;
  nlohmann::json reduced;
  reduced["asset"] = {{"version", "2.0"}};
  reduced["bufferViews"] =
      pick_each(root, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"});
  reduced["accessors"] =
      pick_each(root, "accessors",
                {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "sparse"});
  reduced["meshes"] = pick_each(root, "meshes", {"name", "primitives"});
  for (nlohmann::json& mesh : reduced["meshes"])
    for (nlohmann::json& primitive : mesh["primitives"])
      primitive = pick(primitive, {"attributes", "indices", "material", "mode"});
  reduced["nodes"] = pick_each(
      root, "nodes", {"name", "children", "matrix", "translation", "rotation", "scale", "mesh", "camera"});
  reduced["samplers"] = pick_each(root, "samplers", {"magFilter", "minFilter", "wrapS", "wrapT"});
  reduced["textures"] = pick_each(root, "textures", {"sampler", "source"});
  whole_numbers_to_integers(reduced);

  tinygltf::TinyGLTF parser;
  tinygltf::Model model;
  std::string error, warning;
  const std::string text = json_text(reduced);
  if (text.size() > 0xffffffffu) throw_error(document.file, "more than 4 GiB of JSON");
  bool ok = false;
  try {
    ok = parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                    static_cast<unsigned>(text.size()), "", tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!ok) {
    const size_t end = error.find('\n');
    throw_error(document.file, "not a valid glTF document: {}", error.substr(0, std::min<size_t>(end, 300)));
  }
  model.buffers = std::move(document.model.buffers);
  document.model = std::move(model);
}

}  // namespace

void Warnings::add(const std::string& kind, const std::string& example, uint64_t count) {
  if (count == 0) return;
  const auto [place, fresh] = index_.try_emplace(kind, entries_.size());
  if (fresh) entries_.push_back({kind, example, 0});
  entries_[place->second].count += count;
}

std::vector<std::string> Warnings::lines() const {
  std::vector<std::string> result;
  for (const Entry& entry : entries_) {
    std::string line = entry.kind;
    if (const size_t at = line.find("{}"); at != std::string::npos)
      line.replace(at, 2, std::to_string(entry.count));
    if (!entry.example.empty())
      line += fmt::format(" ({}{})", entry.count > 1 ? "first: " : "", entry.example);
    result.push_back(std::move(line));
  }
  return result;
}

std::vector<uint8_t> read_file(const Document& document, const std::filesystem::path& path,
                               const std::string& where) {
  return read_file(path, where, document.budget);
}

std::vector<uint8_t> read_file(const std::filesystem::path& path, const std::string& where, Budget& budget) {
  const std::string name = where == path.string() ? "" : fmt::format(" '{}'", path.string());
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!exists(status)) throw_error(where, "no such file{}", name);
  // Devices and pipes have no end or never answer.
  if (!is_regular_file(status)) throw_error(where, "not a regular file{}", name);
  const uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) throw_error(where, "the file cannot be opened{}", name);
  budget.take(size, where, "a file of {} bytes", size);
  std::vector<uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<uintmax_t>(stream.gcount()) != size) throw_error(where, "the file cannot be read{}", name);
  return bytes;
}

bool is_data_uri(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

std::vector<uint8_t> decode_data_uri(const Item& item) {
  const std::string& uri = item.text();
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) item.fail("a data URI without data");
  std::vector<uint8_t> bytes;
  if (uri.compare(comma - std::min<size_t>(comma, 7), 7, ";base64") != 0) {
    const std::string text = percent_decode(uri.substr(comma + 1));
    return {text.begin(), text.end()};
  }
  bytes.reserve((uri.size() - comma) / 4 * 3);
  uint32_t bits = 0;
  int held = 0;
  for (size_t i = comma + 1; i < uri.size() && uri[i] != '='; ++i) {
    const int value = base64_value(uri[i]);
    if (value < 0) item.fail("character {} of the data URI is not base64", i);
    bits = (bits << 6) | static_cast<uint32_t>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<uint8_t>(bits >> held));
  }
  return bytes;
}

std::vector<uint8_t> uri_bytes(const Document& document, const Item& uri) {
  if (is_data_uri(uri.text())) return decode_data_uri(uri);
  return read_file(document, resolve_uri(document, uri), uri.where());
}

std::vector<uint8_t> view_bytes(const Document& document, const Item& index) {
  const auto& views = document.model.bufferViews;
  const tinygltf::BufferView& view = views[index.index(views.size(), "bufferViews")];
  const auto begin =
      document.model.buffers[static_cast<size_t>(view.buffer)].data.begin() + std::ptrdiff_t(view.byteOffset);
  return {begin, begin + std::ptrdiff_t(view.byteLength)};
}

std::string percent_decode(const std::string& uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string result;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      result += static_cast<char>(16 * hex(uri[i + 1]) + hex(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

void Budget::refuse(uint64_t bytes, uint64_t before, const std::string& where,
                    const std::string& what) const {
  constexpr double k_gib = 1024.0 * 1024 * 1024;
  throw OverBudget(where,
                   fmt::format("{} would take {:.2f} GiB more, beyond the {:.2f} GiB that a scene may "
                               "have ({:.2f} GiB are taken); --scene-memory GIB allows more",
                               what, static_cast<double>(bytes) / k_gib, static_cast<double>(most_) / k_gib,
                               static_cast<double>(std::min(before, most_)) / k_gib));
}

void require_inside(const Document& document, const std::filesystem::path& file, const std::string& where) {
  if (document.outside) return;
  std::error_code error;
  const auto real = [&](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(path.empty() ? "." : path, error);
  };
  const std::filesystem::path folder = real(document.folder);
  const std::filesystem::path target = error ? folder : real(file);
  const auto parted = std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
  if (!error && parted.first == folder.end() && parted.second != target.end()) return;
  throw OutsideFolder(where, fmt::format("'{}' is not in the scene's folder and is not read; --allow-outside "
                                         "reads what scenes name elsewhere, as scene.open FILE outside=true "
                                         "does in the window",
                                         file.string()));
}

std::filesystem::path resolve_uri(const Document& document, const Item& item) {
  const std::string& uri = item.text();
  // Texts with a zero byte would be cut short by the system and name another file.
  std::string decoded = percent_decode(uri);
  decoded.erase(std::find(decoded.begin(), decoded.end(), '\0'), decoded.end());
  std::error_code error;
  std::filesystem::path path = document.folder / decoded;
  if (decoded != uri && uri.find('\0') == std::string::npos && !std::filesystem::exists(path, error) &&
      std::filesystem::exists(document.folder / uri, error))
    path = document.folder / uri;
  require_inside(document, path, item.where());
  return path;
}

void open_document(Document& document, const std::filesystem::path& path) {
  document.file = path.string();
  document.folder = path.parent_path();
  const Container container = take_apart(read_file(document, path, document.file), document.file);
  const std::string_view text = container.json();
  document.json = parse_json(document.file, text.data(), text.data() + text.size());
  document.text = std::make_shared<const std::string>(text);
  document.progress(0.05f, "structure");
  check_structure(document);
  document.progress(0.1f, "buffers");
  read_buffers(document, container);
  make_model(document);
}

std::string light_group(const Item& item) {
  const auto extras = item.find("extras");
  if (!extras || !extras->json().is_object()) return "";
  const auto group = extras->find("light_group");
  if (!group) return "";
  const auto& json = group->json();
  if (json.is_number_integer()) return group_name(json_text(json));
  if (!json.is_string()) group->fail("expected the name of a light group");
  return group_name(json.get<std::string>());
}

std::optional<bool> portal_mark(const Item& item) {
  const auto extras = item.find("extras");
  if (!extras || !extras->json().is_object()) return std::nullopt;
  const auto mark = extras->find("portal");
  if (!mark) return std::nullopt;
  // Blender's custom properties are numbers unless made Boolean.
  if (mark->json() == 0 || mark->json() == 1) return mark->json() == 1;
  return mark->boolean();
}

}  // namespace lucerna::scene
