// links: scene_io
// Triangles from glTF: every encoding, and the defaults for omitted data.
#include <cmath>

#include "scene/tangents.h"
#include "unit/scene_support.h"

namespace scene_geometry_tests {

using namespace lucerna;
using namespace lucerna::test;
using scene::Primitive;
using scene::Scene;

namespace {

// Corner positions of every triangle, in order: what a renderer sees, however vertices are shared.
std::vector<vec3> corners(const Primitive& p) {
  std::vector<vec3> out;
  for (const uvec3& t : p.triangles)
    for (int k = 0; k < 3; ++k) out.push_back(p.positions[t[k]]);
  return out;
}

const std::vector<float> k_square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
const vec3 k_a(0, 0, 0), k_b(1, 0, 0), k_c(0, 1, 0), k_d(1, 1, 0);

const Primitive& only(const Scene& scene) {
  REQUIRE(scene.meshes.size() == 1);
  REQUIRE(scene.meshes[0].primitives.size() == 1);
  return scene.meshes[0].primitives[0];
}

template <class T>
void check_indices() {
  Asset asset;
  const int positions = asset.accessor("VEC3", k_square);
  const int indices = asset.accessor<T>("SCALAR", {0, 1, 2, 2, 1, 3});
  asset.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  CHECK(corners(only(asset.load())) == std::vector<vec3>{k_a, k_b, k_c, k_c, k_b, k_d});
}

}  // namespace

TEST_CASE("indices of every type") {
  check_indices<uint8_t>();
  check_indices<uint16_t>();
  check_indices<uint32_t>();
}

TEST_CASE("lists, strips and fans, with and without indices") {
  const auto load = [](int mode, std::vector<float> positions, std::vector<uint16_t> indices) {
    Asset asset;
    json primitive = {{"attributes", {{"POSITION", asset.accessor("VEC3", positions)}}}, {"mode", mode}};
    if (!indices.empty()) primitive["indices"] = asset.accessor("SCALAR", indices);
    asset.mesh(primitive);
    return corners(only(asset.load()));
  };
  const std::vector<float> triangle(k_square.begin(), k_square.begin() + 9);
  CHECK(load(4, triangle, {}) == std::vector<vec3>{k_a, k_b, k_c});
  // A strip's second triangle is reversed so that it faces the same way.
  CHECK(load(5, k_square, {}) == std::vector<vec3>{k_a, k_b, k_c, k_b, k_d, k_c});
  CHECK(load(5, k_square, {3, 2, 1, 0}) == std::vector<vec3>{k_d, k_c, k_b, k_c, k_a, k_b});
  CHECK(load(6, k_square, {0, 1, 3, 2}) == std::vector<vec3>{k_b, k_d, k_a, k_d, k_c, k_a});
}

TEST_CASE("points and lines are omitted with one warning") {
  Asset asset;
  asset.triangle();
  for (int mode : {0, 1, 2, 3}) asset.triangle()["mode"] = mode;
  const Scene scene = asset.load();
  CHECK(scene::count_triangles(scene) == 1);
  CHECK(warnings_with(scene, "4 primitives of points or lines") == 1);
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("vertices beyond the last whole triangle are ignored with a warning") {
  Asset asset;
  asset.mesh({{"attributes", {{"POSITION", asset.accessor("VEC3", k_square)}}}});
  const Scene scene = asset.load();
  CHECK(scene::count_triangles(scene) == 1);
  CHECK(warnings_with(scene, "not a multiple of 3") == 1);
}

TEST_CASE("sparse accessors, over data and over zeros") {
  for (const bool over_data : {true, false}) {
    Asset asset;
    int positions = 0;
    if (over_data)
      positions = asset.accessor<float>("VEC3", {9, 9, 9, 1, 0, 0, 9, 9, 9});
    else
      positions = asset.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
    const std::vector<uint16_t> which = over_data ? std::vector<uint16_t>{0, 2} : std::vector<uint16_t>{1, 2};
    const std::vector<float> values =
        over_data ? std::vector<float>{0, 0, 0, 0, 1, 0} : std::vector<float>{1, 0, 0, 0, 1, 0};
    const json indices{{"bufferView", asset.view(which)}, {"componentType", 5123}};
    asset.doc["accessors"][positions]["sparse"] = {
        {"count", 2}, {"indices", indices}, {"values", {{"bufferView", asset.view(values)}}}};
    asset.mesh({{"attributes", {{"POSITION", positions}}}});
    CHECK(corners(only(asset.load())) == std::vector<vec3>{k_a, k_b, k_c});
  }
}

TEST_CASE("sparse indices are used in index accessors") {
  Asset asset;
  const int positions = asset.accessor("VEC3", k_square);
  const int indices = asset.accessor<uint32_t>("SCALAR", {0, 1, 1});
  const json which{{"bufferView", asset.view(std::vector<uint8_t>{2})}, {"componentType", 5121}};
  asset.doc["accessors"][indices]["sparse"] = {
      {"count", 1}, {"indices", which}, {"values", {{"bufferView", asset.view(std::vector<uint32_t>{3})}}}};
  asset.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  CHECK(corners(only(asset.load())) == std::vector<vec3>{k_a, k_b, k_d});
}

TEST_CASE("interleaved attributes") {
  Asset asset;
  const std::vector<float> data{0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2};
  const int view = asset.view(data, 24);
  const auto accessor = [&](int offset) {
    return asset.add("accessors", {{"bufferView", view},
                                   {"byteOffset", offset},
                                   {"componentType", 5126},
                                   {"type", "VEC3"},
                                   {"count", 3}});
  };
  const int positions = accessor(0), normals = accessor(12);
  asset.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
  const Scene scene = asset.load();
  const Primitive& p = only(scene);
  CHECK(corners(p) == std::vector<vec3>{k_a, k_b, k_c});
  for (const vec3& n : p.normals) CHECK(n == vec3(0, 0, 1));  // normalized
}

TEST_CASE("quantized positions and normals") {
  Asset asset;
  asset.doc["extensionsUsed"] = asset.doc["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int view = asset.view(std::vector<int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}, 8);
  const int positions = asset.add(
      "accessors",
      {{"bufferView", view}, {"componentType", 5122}, {"normalized", true}, {"type", "VEC3"}, {"count", 3}});
  const int normals =
      asset.add("accessors",
                {{"bufferView", asset.view(std::vector<int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, 4)},
                 {"componentType", 5120},
                 {"normalized", true},
                 {"type", "VEC3"},
                 {"count", 3}});
  asset.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
  const Scene scene = asset.load();
  const Primitive& p = only(scene);
  CHECK(corners(p) == std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(0, -1, 0)});  // -32768 is -1, not below
  CHECK(p.normals[0] == vec3(0, 0, 1));
  CHECK(scene.warnings.empty());

  Asset whole;  // not normalized: the numbers themselves
  const int raw = whole.add(
      "accessors", {{"bufferView", whole.view(std::vector<uint8_t>{0, 0, 0, 0, 200, 0, 0, 0, 0, 7, 0, 0}, 4)},
                    {"componentType", 5121},
                    {"type", "VEC3"},
                    {"count", 3}});
  whole.mesh({{"attributes", {{"POSITION", raw}}}});
  CHECK(corners(only(whole.load())) == std::vector<vec3>{vec3(0), vec3(200, 0, 0), vec3(0, 7, 0)});
}

TEST_CASE("vertex colours of every kind") {
  const auto load = [](auto values, const char* type) {
    Asset asset;
    json& primitive = asset.triangle();
    using T = typename decltype(values)::value_type;
    // Elements of a vertex attribute start at multiples of 4 bytes.
    const size_t n = static_cast<size_t>(type[3] - '0'), stride = (n * sizeof(T) + 3) / 4 * 4 / sizeof(T);
    std::vector<T> padded;
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < stride; ++k) padded.push_back(k < n ? values[i * n + k] : T(0));
    const int view = asset.view(padded, static_cast<int>(stride * sizeof(T)));
    primitive["attributes"]["COLOR_0"] =
        asset.add("accessors", {{"bufferView", view},
                                {"componentType", Asset::component_type<T>()},
                                {"normalized", sizeof(T) < 4},
                                {"type", type},
                                {"count", 3}});
    return only(asset.load()).colors;
  };
  const std::vector<vec4> rgb{vec4(1, 0, 0, 1), vec4(0, 1, 0, 1), vec4(0, 0, 1, 1)};
  const std::vector<vec4> rgba{vec4(1, 0, 0, 0), vec4(0, 1, 0, 1), vec4(0, 0, 1, 0)};
  CHECK(load(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3") == rgb);
  CHECK(load(std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255}, "VEC3") == rgb);
  CHECK(load(std::vector<uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 65535}, "VEC3") == rgb);
  CHECK(load(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0}, "VEC4") == rgba);
  CHECK(load(std::vector<uint8_t>{255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 255, 0}, "VEC4") == rgba);
  CHECK(load(std::vector<uint16_t>{65535, 0, 0, 0, 0, 65535, 0, 65535, 0, 0, 65535, 0}, "VEC4") == rgba);
  // Outside 0..1: clamped. All white: omitted.
  CHECK(load(std::vector<float>{2, -1, 0, 0, 1, 0, 0, 0, 1}, "VEC3") == rgb);
  CHECK(load(std::vector<float>{1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3").empty());
}

TEST_CASE("missing normals are the faces' normals") {
  Asset asset;  // two triangles that share an edge at a right angle
  const int positions = asset.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const int tangents = asset.accessor<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
  const int indices = asset.accessor<uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  asset.mesh({{"attributes", {{"POSITION", positions}, {"TANGENT", tangents}}}, {"indices", indices}});
  const Scene scene = asset.load();
  const Primitive& p = only(scene);
  REQUIRE(p.triangles.size() == 2);
  REQUIRE(p.normals.size() == p.positions.size());
  for (int k = 0; k < 3; ++k) {
    CHECK(p.normals[p.triangles[0][k]] == vec3(0, 0, 1));
    CHECK(p.normals[p.triangles[1][k]] == vec3(1, 0, 0));
  }
  CHECK(p.tangents.empty());
}

TEST_CASE("normals of length zero become their faces' normals") {
  Asset asset;
  json& primitive = asset.triangle();
  primitive["attributes"]["NORMAL"] = asset.accessor<float>("VEC3", {0, 0, 0, NAN, 0, 1, 0, 0, 1});
  const Scene scene = asset.load();
  for (const vec3& n : only(scene).normals) CHECK(n == vec3(0, 0, 1));
  CHECK(warnings_with(scene, "2 normals without a direction") == 1);
}

TEST_CASE("degenerate triangles are removed and counted") {
  Asset asset;
  const float tiny = 1e-30f;
  const int positions =
      asset.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, tiny, 0, 0, 0, tiny, 0});
  const int indices = asset.accessor<uint8_t>(
      "SCALAR", {0, 1, 2, /* repeated */ 0, 1, 1, /* collinear */ 0, 1, 3, /* area underflows */ 0, 4, 5});
  asset.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const Scene scene = asset.load();
  CHECK(corners(only(scene)) == std::vector<vec3>{k_a, k_b, k_c});
  CHECK(only(scene).positions.size() == 3);
  CHECK(warnings_with(scene, "3 degenerate triangles removed") == 1);
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("an emissive mesh without area adds no light") {
  Asset asset;
  asset.triangle();
  json& flat = asset.mesh(
      {{"attributes", {{"POSITION", asset.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0})}}}});
  flat["material"] = asset.add("materials", {{"emissiveFactor", {1, 1, 1}}});
  const Scene scene = asset.load();
  CHECK(scene::count_triangles(scene) == 1);
  CHECK(scene.instances.size() == 1);
  CHECK(warnings_with(scene, "1 degenerate triangles removed") == 1);
}

TEST_CASE("an empty scene loads with a warning") {
  const Scene scene = Asset().load();
  CHECK(scene.instances.empty());
  CHECK(warnings_with(scene, "no triangles") == 1);
  CHECK(scene::bounds(scene).empty());
  const scene::Camera camera = scene::default_camera(scene);
  CHECK(std::isfinite(camera.to_world[3].z));
}

TEST_CASE("a primitive keeps only the vertices it uses") {
  Asset asset;
  std::vector<float> many(3 * 1000, 0.5f);
  std::copy(k_square.begin(), k_square.end(), many.begin());
  const int positions = asset.accessor("VEC3", many);
  asset.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", asset.accessor("VEC3", many)}}},
              {"indices", asset.accessor<uint16_t>("SCALAR", {3, 2, 1})}});
  const Scene scene = asset.load();
  CHECK(only(scene).positions.size() == 3);
  CHECK(corners(only(scene)) == std::vector<vec3>{k_d, k_c, k_b});
}

namespace {

// A unit square in the XY plane facing +Z, texture coordinates u right and v down (as in glTF), or mirrored
// in u.
Primitive square(float x, bool mirrored) {
  Primitive p;
  p.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
  p.normals.assign(4, vec3(0, 0, 1));
  p.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  if (mirrored)
    for (vec2& uv : p.uv0) uv.x = 1 - uv.x;
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  return p;
}

scene::TextureUse plain_map() {
  scene::TextureUse use;
  use.texture = 0;
  return use;
}

}  // namespace

TEST_CASE("tangents point along u, bitangents up in the picture") {
  Primitive p = square(0, false);
  scene::make_tangents(p, plain_map());
  REQUIRE(p.tangents.size() == 4);
  for (const vec4& t : p.tangents) CHECK(t == vec4(1, 0, 0, 1));  // cross(n, t) = +y: the direction of green

  Primitive m = square(0, true);
  scene::make_tangents(m, plain_map());
  for (const vec4& t : m.tangents) CHECK(t == vec4(-1, 0, 0, -1));  // -cross(n, t) = +y as well

  scene::TextureUse turned = plain_map();  // reads the texture rotated by a quarter turn: u' = v, v' = -u
  turned.m = {0, 1, 0, -1, 0, 0};
  Primitive q = square(0, false);
  scene::make_tangents(q, turned);
  for (const vec4& t : q.tangents) CHECK(glm::length(vec3(t) - vec3(0, -1, 0)) < 1e-6f);
}

TEST_CASE("vertices are split where mirrored and unmirrored maps meet") {
  Primitive p = square(0, false);
  // The mirrored square on its right shares the edge 1-2 with it.
  p.positions.insert(p.positions.end(), {{2, 0, 0}, {2, 1, 0}});
  p.normals.assign(6, vec3(0, 0, 1));
  p.uv0.insert(p.uv0.end(), {{0, 1}, {0, 0}});
  p.triangles.insert(p.triangles.end(), {{1, 4, 5}, {1, 5, 2}});
  scene::make_tangents(p, plain_map());
  CHECK(p.positions.size() == 8);
  CHECK(p.uv0.size() == 8);
  for (size_t i = 0; i < p.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const vec4 t = p.tangents[p.triangles[i][k]];
      CHECK(t == (i < 2 ? vec4(1, 0, 0, 1) : vec4(-1, 0, 0, -1)));
    }
}

TEST_CASE("tangents of a sphere have unit length, lie in the surface and follow the parallels") {
  Primitive p;
  const int rows = 16, columns = 32;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const float u = static_cast<float>(c) / columns, v = static_cast<float>(r) / rows;
      const float phi = 2 * k_pi * u, theta = k_pi * (0.1f + 0.8f * v);
      p.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                               -std::sin(theta) * std::sin(phi));
      p.normals.push_back(p.positions.back());
      p.uv0.emplace_back(u, v);
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<uint32_t>(r * (columns + 1) + c), down = i + columns + 1;
      p.triangles.emplace_back(i, down, down + 1);
      p.triangles.emplace_back(i, down + 1, i + 1);
    }
  scene::make_tangents(p, plain_map());
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const vec3 t(p.tangents[i]), n = p.normals[i];
    const vec3 east = glm::normalize(glm::cross(vec3(0, 1, 0), n));
    CHECK(std::abs(glm::length(t) - 1) < 1e-5f);
    CHECK(std::abs(glm::dot(t, n)) < 1e-5f);
    CHECK(glm::dot(t, east) > 0.98f);
    CHECK(p.tangents[i].w == 1);
  }
}

TEST_CASE("degenerate texture coordinates still give frames") {
  Primitive p = square(0, false);
  p.uv0.assign(4, vec2(0.5f));
  scene::make_tangents(p, plain_map());
  for (const vec4& t : p.tangents) {
    CHECK(std::abs(glm::length(vec3(t)) - 1) < 1e-6f);
    CHECK(std::abs(t.z) < 1e-6f);
  }
  p.uv0.clear();
  scene::make_tangents(p, plain_map());
  CHECK(p.tangents.size() == 4);
}

}  // namespace scene_geometry_tests
