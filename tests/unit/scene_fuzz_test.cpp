// links: scene_io
// No input makes the loader crash, hang or throw anything except an Error: a .glb truncated at every byte,
// and mutations of its JSON and its binary part. Run it with the sanitizers too.
#include <cmath>
#include <random>
#include <set>

#include "unit/scene_support.h"

namespace scene_fuzz_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

// One small file that uses every feature.
std::vector<uint8_t> everything(const TempFolder& folder) {
  write_image<uint8_t>(folder / "i.png", 2, 2, 4, std::vector<uint8_t>(16, 128));
  Asset a;
  const int inside =
      a.add("images", {{"bufferView", a.view(bytes_of(folder / "i.png"))}, {"mimeType", "image/png"}});
  const int uri = a.add("images", {{"uri", "data:image/png;base64," + base64(bytes_of(folder / "i.png"))}});
  a.add("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
  const int t0 = a.add("textures", {{"source", inside}, {"sampler", 0}}),
            t1 = a.add("textures", {{"source", uri}});
  a.textured_triangle(
      {{"normalTexture", {{"index", t0}}},
       {"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", t1},
           {"extensions", {{"KHR_texture_transform", {{"rotation", 1}, {"scale", {2, 2}}}}}}}}}},
       {"extensions",
        {{"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}},
         {"KHR_materials_ior", {{"ior", 1.4}}}}}});
  json& indexed = a.triangle({{"translation", {0, 0, 1}}, {"rotation", {0, 0, 0, 1}}});
  indexed["indices"] = a.accessor<uint16_t>("SCALAR", {0, 1, 2, 2, 1, 0});
  indexed["mode"] = 5;
  indexed["attributes"]["COLOR_0"] =
      a.accessor<uint8_t>("VEC4", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, true);
  json& sparse = a.triangle({{"scale", {2, 2, 2}}});
  const int p = sparse["attributes"]["POSITION"];
  const int which = a.view(std::vector<uint8_t>{1}), what = a.view(std::vector<float>{3, 0, 0});
  a.doc["accessors"][p]["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", which}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", what}}}};
  a.triangle({{"extensions",
               {{"EXT_mesh_gpu_instancing",
                 {{"attributes", {{"TRANSLATION", a.accessor<float>("VEC3", {1, 2, 3, 4, 5, 6})}}}}}}}});
  a.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
  a.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  a.doc["scenes"][0]["nodes"].push_back(
      a.add("nodes", {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  a.doc["scenes"][0]["extras"]["environment"] = {{"radiance", {1, 1, 1}}, {"scale", 1}};
  return a.glb_bytes();
}

// The invariants of a loaded scene.
bool sound(const scene::Scene& s) {
  for (const scene::Instance& i : s.instances)
    if (i.mesh >= s.meshes.size()) return false;
  for (const scene::Mesh& m : s.meshes)
    for (const scene::Primitive& p : m.primitives) {
      const size_t n = p.positions.size();
      if (p.material >= s.materials.size() || p.normals.size() != n || p.triangles.empty()) return false;
      for (const auto size : {p.uv0.size(), p.uv1.size(), p.colors.size(), p.tangents.size()})
        if (size != 0 && size != n) return false;
      if (s.materials[p.material].normal_texture && p.tangents.size() != n) return false;
      for (const uvec3& t : p.triangles)
        if (t.x >= n || t.y >= n || t.z >= n) return false;
      for (size_t i = 0; i < n; ++i) {
        if (!(glm::dot(p.positions[i], p.positions[i]) < 1e30f)) return false;
        if (!(std::abs(glm::length(p.normals[i]) - 1) < 1e-4f)) return false;
        if (!p.tangents.empty() &&
            !(std::abs(glm::length(vec3(p.tangents[i])) - 1) < 1e-3f && std::abs(p.tangents[i].w) == 1))
          return false;
        if (!p.uv0.empty() && !(glm::dot(p.uv0[i], p.uv0[i]) < 1e30f)) return false;
        if (!p.colors.empty() && !glm::all(glm::lessThanEqual(p.colors[i], vec4(1)))) return false;
      }
    }
  for (const scene::Texture& t : s.textures)
    if (t.image >= s.images.size()) return false;
  for (const scene::Image& i : s.images) {
    const size_t size = 4 * size_t(i.width) * i.height;
    if (size == 0 || (i.bytes.size() != size && i.floats.size() != size)) return false;
  }
  for (const scene::Light& l : s.lights)
    if (!(std::abs(glm::length(l.direction) - 1) < 1e-4f) || !(glm::dot(l.intensity, vec3(1)) >= 0))
      return false;
  return true;
}

// Loads the bytes; returns whether it succeeded. Any exception except an Error escapes and fails the test.
bool try_load(const std::filesystem::path& file, const std::vector<uint8_t>& bytes) {
  write(file, bytes.data(), bytes.size());
  try {
    const scene::Scene scene = scene::load(file);
    if (!sound(scene)) FAIL("a damaged file made an invalid scene");
    scene::describe_text(scene);
    return true;
  } catch (const Error& error) {
    if (std::string(error.what()).find(file.string()) == std::string::npos)
      FAIL("not located: " << error.what());
    return false;
  }
}

size_t json_length(const std::vector<uint8_t>& glb) {
  uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  return length;
}

}  // namespace

TEST_CASE("a .glb truncated at every byte") {
  TempFolder folder;
  const std::vector<uint8_t> whole = everything(folder);
  REQUIRE(try_load(folder / "x.glb", whole));
  size_t loaded = 0;
  for (size_t length = 0; length < whole.size(); ++length)
    loaded +=
        try_load(folder / "x.glb",
                 std::vector<uint8_t>(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
  CHECK(loaded == 0);
}

TEST_CASE("bytes changed at random, 4000 files") {
  TempFolder folder;
  const std::vector<uint8_t> whole = everything(folder);
  const size_t json_end = 20 + json_length(whole);
  std::mt19937 random(20240607);
  const auto below = [&random](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
  size_t loaded = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<uint8_t> bytes = whole;
    // A third of the files each: damage in the JSON, in the binary part, anywhere.
    const size_t first = round % 3 == 1 ? json_end : round % 3 == 0 ? 20 : 0;
    const size_t last = round % 3 == 0 ? json_end : bytes.size();
    for (size_t changes = 1 + below(4); changes > 0; --changes) {
      const size_t at = first + below(last - first);
      if (below(2) == 0)
        bytes[at] ^= static_cast<uint8_t>(1u << below(8));
      else
        bytes[at] = static_cast<uint8_t>(below(256));
    }
    loaded += try_load(folder / "x.glb", bytes);
  }
  CHECK(loaded > 400);  // many changes are harmless; if all were refused, only the parser would be tested
  CHECK(loaded < 3600);
}

TEST_CASE("numbers, strings and structures of the JSON exchanged, 3000 files") {
  TempFolder folder;
  const std::vector<uint8_t> whole = everything(folder);
  const size_t length = json_length(whole);
  const json original =
      json::parse(whole.begin() + 20, whole.begin() + 20 + static_cast<std::ptrdiff_t>(length));
  const std::vector<uint8_t> rest(whole.begin() + 20 + static_cast<std::ptrdiff_t>(length), whole.end());
  const std::vector<json> odd{0,
                              -1,
                              1,
                              2,
                              3,
                              255,
                              65535,
                              1e9,
                              2147483648.0,
                              4294967295.0,
                              1e18,
                              1e300,
                              -1e300,
                              0.5,
                              1e-40,
                              nullptr,
                              true,
                              "",
                              "x",
                              json::array(),
                              json::object(),
                              json::array({0}),
                              json::array({0, 0, 0}),
                              5121,
                              5126,
                              "VEC4"};
  std::mt19937 random(77);
  const auto below = [&random](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
  std::set<std::string> all;  // every value of the document, and every object and array that contains it
  const json flat = original.flatten();
  for (const auto& [path, value] : flat.items())
    for (json::json_pointer pointer(path); !pointer.empty(); pointer = pointer.parent_pointer())
      all.insert(pointer.to_string());
  const std::vector<std::string> places(all.begin(), all.end());
  size_t loaded = 0;
  for (int round = 0; round < 3000; ++round) {
    json doc = original;
    for (size_t changes = 1 + below(2); changes > 0; --changes) {
      const json::json_pointer place(places[below(places.size())]);
      if (!doc.contains(place)) continue;
      if (below(6) == 0 && doc.at(place.parent_pointer()).is_object())
        doc.at(place.parent_pointer()).erase(place.back());
      else
        doc.at(place) = odd[below(odd.size())];
    }
    std::string text = doc.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<uint8_t> bytes(whole.begin(), whole.begin() + 20);
    const auto put = [&bytes](size_t at, size_t value) {
      for (size_t k = 0; k < 4; ++k) bytes[at + k] = static_cast<uint8_t>(value >> (8 * k));
    };
    put(8, 20 + text.size() + rest.size());
    put(12, text.size());
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    loaded += try_load(folder / "x.glb", bytes);
  }
  CHECK(loaded > 150);
  CHECK(loaded < 2700);
}

}  // namespace scene_fuzz_tests
