#pragma once
// Tiny glTF files, generated where needed.
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/io/load.h"
#include "support/folder.h"

#if defined(__SANITIZE_ADDRESS__)
// OpenImageIO 2.4 leaks the text of an error when a PNG is truncated.
extern "C" const char* __lsan_default_suppressions() { return "leak:OpenImageIO_v2_4::ImageInput::geterror"; }
#endif

namespace lucerna::test {

using nlohmann::json;

using TempFolder = Folder;

inline void write(const std::filesystem::path& path, const void* data, size_t size) {
  std::ofstream(path, std::ios::binary)
      .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}
inline void write(const std::filesystem::path& path, const std::string& text) {
  write(path, text.data(), text.size());
}

inline std::string base64(const std::vector<uint8_t>& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = (bits << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) out += k > bytes.size() - i ? '=' : digits[(bits >> (18 - 6 * k)) & 63];
  }
  return out;
}

/// Pixels of 8 or 16 bits or floats (T), `channels` each, through OpenImageIO; the name's extension selects
/// the format.
template <class T>
void write_image(const std::filesystem::path& path, int width, int height, int channels,
                 const std::vector<T>& pixels) {
  const auto type = sizeof(T) == 1   ? OIIO::TypeDesc::UINT8
                    : sizeof(T) == 2 ? OIIO::TypeDesc::UINT16
                                     : OIIO::TypeDesc::FLOAT;
  OIIO::ImageSpec spec(width, height, channels, type);
  spec["oiio:UnassociatedAlpha"] = 1;
  auto out = OIIO::ImageOutput::create(path.string());
  REQUIRE(out);
  REQUIRE(out->open(path.string(), spec));
  REQUIRE(out->write_image(type, pixels.data()));
  out->close();
}

inline std::vector<uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A document with one buffer, built step by step.
struct Asset {
  json doc = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", json::array()}}}}};
  std::vector<uint8_t> bin;

  template <class T>
  int view(const std::vector<T>& data, int stride = 0) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", data.size() * sizeof(T)}};
    if (stride) v["byteStride"] = stride;
    const auto* raw = reinterpret_cast<const uint8_t*>(data.data());
    bin.insert(bin.end(), raw, raw + data.size() * sizeof(T));
    return add("bufferViews", v);
  }
  int add(const char* list, const json& element) {
    doc[list].push_back(element);
    return static_cast<int>(doc[list].size()) - 1;
  }
  template <class T>
  static int component_type() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
  }
  /// Tightly packed elements of `type` ("VEC3" ...).
  template <class T>
  int accessor(const char* type, const std::vector<T>& data, bool normalized = false) {
    const size_t n = std::string(type) == "SCALAR" ? 1 : static_cast<size_t>(type[3] - '0');
    json a = {{"bufferView", view(data)},
              {"componentType", component_type<T>()},
              {"type", type},
              {"count", data.size() / n}};
    if (normalized) a["normalized"] = true;
    return add("accessors", a);
  }
  /// Adds a mesh of one primitive in a node of the scene; returns the primitive.
  json& mesh(const json& primitive, const json& node = json::object()) {
    const int index = add("meshes", {{"primitives", {primitive}}});
    json n = node;
    n["mesh"] = index;
    doc["scenes"][0]["nodes"].push_back(add("nodes", n));
    return doc["meshes"].back()["primitives"][0];
  }
  /// One triangle (0,0,0) (1,0,0) (0,1,0), no normals.
  json& triangle(const json& node = json::object()) {
    return mesh({{"attributes", {{"POSITION", accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}}}}, node);
  }
  /// Adds a triangle with texture coordinates and its own material; returns the material's index.
  int textured_triangle(const json& material) {
    json& primitive = triangle();
    const int uv = accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    primitive["attributes"]["TEXCOORD_0"] = uv;
    primitive["attributes"]["TEXCOORD_1"] = uv;
    return primitive["material"] = add("materials", material);
  }

  json complete(bool embedded) const {
    json d = doc;
    if (bin.empty()) return d;
    d["buffers"] = {{{"byteLength", bin.size()}}};
    if (embedded) d["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bin);
    return d;
  }
  std::filesystem::path gltf(const TempFolder& folder, const std::string& name = "a.gltf") const {
    write(folder / name, complete(true).dump(1));
    return folder / name;
  }
  std::vector<uint8_t> glb_bytes() const {
    std::string text = complete(false).dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<uint8_t> data = bin;
    data.resize((data.size() + 3) / 4 * 4, 0);
    std::vector<uint8_t> out;
    const auto u32 = [&out](size_t value) {
      for (int k = 0; k < 4; ++k) out.push_back(static_cast<uint8_t>(value >> (8 * k)));
    };
    u32(0x46546c67), u32(2), u32(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size()));
    u32(text.size()), u32(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    if (!data.empty()) {
      u32(data.size()), u32(0x004e4942);
      out.insert(out.end(), data.begin(), data.end());
    }
    return out;
  }
  std::filesystem::path glb(const TempFolder& folder, const std::string& name = "a.glb") const {
    const std::vector<uint8_t> bytes = glb_bytes();
    write(folder / name, bytes.data(), bytes.size());
    return folder / name;
  }
  scene::Scene load() const {
    TempFolder folder;
    return scene::load(gltf(folder));
  }
};

/// The message with which a load fails; empty if it succeeds.
inline std::string failure(const std::filesystem::path& path) {
  try {
    scene::load(path);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}
inline std::string failure(const Asset& asset) {
  TempFolder folder;
  return failure(asset.gltf(folder));
}

/// The number of warnings that contain `text`.
inline size_t warnings_with(const scene::Scene& scene, const std::string& text) {
  size_t count = 0;
  for (const std::string& line : scene.warnings) count += line.find(text) != std::string::npos;
  return count;
}

}  // namespace lucerna::test
