// links: scene_io
// Saving of moved and hidden objects: nodes in nodes, shared nodes, skins, copies; visibility read and
// written.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "base/file.h"
#include "scene/io/save.h"
#include "scene/object_place.h"
#include "unit/scene_support.h"

namespace scene_save_objects_tests {

using namespace lucerna;
using namespace lucerna::scene;
using namespace lucerna::test;
using Catch::Contains;

namespace {

const json k_hidden = {{"KHR_node_visibility", {{"visible", false}}}};

/// A scene in a folder, its edited copy, and what reading the saved file gives.
struct Bench {
  TempFolder folder;
  std::shared_ptr<const Scene> loaded;
  std::shared_ptr<Scene> edited;
  SavedScene result;

  explicit Bench(const Asset& asset) {
    loaded = std::make_shared<const Scene>(load(asset.gltf(folder)));
    edited = std::make_shared<Scene>(*loaded);
  }
  size_t find(const std::string& name) const {
    for (size_t i = 0; i < loaded->instances.size(); ++i)
      if (loaded->instances[i].name == name) return i;
    FAIL("no object " << name);
    return 0;
  }
  void put(const std::string& name, const ObjectPlace& place) {
    const size_t i = find(name);
    Instance& instance = edited->instances[i];
    instance.to_world = placed(loaded->instances[i].to_world, box_of(loaded->meshes[instance.mesh]), place);
    instance.flipped = glm::determinant(glm::dmat3(instance.to_world)) < 0;
    instance.hidden = place.hidden;
  }
  Scene saved() {
    result = save({.loaded = loaded, .edited = edited, .file = folder / "b.gltf"});
    return load(folder / "b.gltf");
  }
  json document() { return json::parse(read_file(folder / "b.gltf")); }
};

/// All instances in the same order, to the last digit.
void check_same(const Scene& read, const Scene& edited) {
  REQUIRE(read.instances.size() == edited.instances.size());
  for (size_t i = 0; i < read.instances.size(); ++i) {
    const Instance &a = read.instances[i], &b = edited.instances[i];
    INFO(b.name);
    CHECK(a.name == b.name);
    CHECK(a.to_world == b.to_world);
    CHECK(a.hidden == b.hidden);
    CHECK(a.flipped == b.flipped);
    CHECK(a.group == b.group);
    CHECK(read.meshes[a.mesh].name == edited.meshes[b.mesh].name);
  }
}

/// A table with a cup, turned and sized unevenly, with another one inside; a chair that holds a lamp; a free
/// plate; a shelf.
Asset room() {
  Asset a;
  const auto node = [&](const char* name, json n = json::object()) {
    a.triangle();
    a.doc["scenes"][0]["nodes"].erase(a.doc["scenes"][0]["nodes"].size() - 1);
    json& made = a.doc["nodes"].back();
    made.update(n), made["name"] = name;
    a.doc["meshes"].back()["name"] = std::string(name) + " mesh";
    return int(a.doc["nodes"].size()) - 1;
  };
  a.doc["extensionsUsed"] = {"KHR_lights_punctual"};
  a.doc["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"name", "lamp"}}}}}}};
  const int spoon = node("spoon", {{"translation", {0.1, 0.2, 0.3}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
  const int cup = node(
      "cup", {{"children", {spoon}}, {"rotation", {0.1825741858, 0.3651483717, 0.5477225575, 0.7302967433}}});
  const int table = node("table", {{"children", {cup}},
                                   {"translation", {1.1, 2.3, 3.7}},
                                   {"scale", {2, 1, 0.5}},
                                   {"extras", {{"light_group", "set"}, {"note", 1}}}});
  const int lamp = a.add("nodes", {{"name", "bulb"},
                                   {"translation", {0, 1, 0}},
                                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const int chair =
      node("chair", {{"children", {lamp}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1}}});
  const int plate = node("plate", {{"translation", {0, 0.75, 0}}});
  const int shelf = node("shelf");
  for (const int n : {table, chair, plate, shelf}) a.doc["scenes"][0]["nodes"].push_back(n);
  return a;
}

}  // namespace

TEST_CASE("moved, turned, sized and mirrored objects read back exactly, and the rest stays") {
  Bench b(room());
  b.put("plate", {.moved = {0.1f, 0.2f, 0.3f}, .turned = {10, 20, 30}, .scaled = {1, -2, 3}});
  b.put("table", {.moved = {1, 0, 0}, .turned = {0, 33, 0}});
  b.put("spoon", {.moved = {0.01f, 0, 0}, .turned = {1, 2, 3}, .scaled = vec3(1.7f)});
  b.put("chair", {.moved = {0, 0, -3}});
  check_same(b.saved(), *b.edited);
  const json d = b.document();
  // The cup has not moved with its table, nor the lamp with its chair.
  CHECK(d["nodes"][2]["translation"] == json({1.1, 2.3, 3.7}));
  CHECK(!d["nodes"][2].contains("mesh"));
  CHECK(d["nodes"][2]["extras"]["note"] == 1);
  CHECK(!d["nodes"][4].contains("mesh"));
  // What is alone in its node has its matrix there.
  CHECK(d["nodes"][5].contains("mesh"));
  CHECK(d["nodes"][5]["matrix"].size() == 16);
  CHECK(!d["nodes"][5].contains("translation"));
  CHECK(d["nodes"][6] == json({{"mesh", d["nodes"][6]["mesh"]}, {"name", "shelf"}}));
  CHECK(b.result.notes.empty());
  CHECK(load(b.folder / "b.gltf").lights[0].position == b.loaded->lights[0].position);
}

TEST_CASE("objects in every position read back exactly, and nodes have right angles") {
  for (int seed = 0; seed < 40; ++seed) {
    Bench b(room());
    const auto f = [&](int k) { return std::sin(float(seed * 31 + k * 17)); };
    for (const char* name : {"spoon", "cup", "table"})
      b.put(name, {.moved = 3.0f * vec3(f(1), f(2), f(3)),
                   .turned = 180.0f * vec3(f(4), f(5), f(6)),
                   .scaled = vec3(1.2f + f(7), 1.2f + f(8), 1.2f + f(9))});
    check_same(b.saved(), *b.edited);
    const json doc = b.document();
    size_t matrices = 0;
    for (const json& n : doc["nodes"]) {
      if (!n.contains("matrix")) continue;
      ++matrices;
      glm::dmat3 m;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) m[c][r] = n["matrix"][size_t(4 * c + r)].get<double>();
      for (int c = 0; c < 3; ++c)
        CHECK(std::abs(glm::dot(glm::normalize(m[c]), glm::normalize(m[(c + 1) % 3]))) < 2e-5);
    }
    CHECK(matrices > 0);
  }
}

TEST_CASE("saving a saved scene again keeps all digits, and moving back leaves no trace in the picture") {
  Bench b(room());
  b.put("cup", {.turned = {12, 34, 56}});
  const Scene once = b.saved();
  b.loaded = std::make_shared<const Scene>(once), b.edited = std::make_shared<Scene>(once);
  b.put("plate", {.moved = {1, 1, 1}});
  check_same(b.saved(), *b.edited);
  // Moved elsewhere, in another program: its matrix counts.
  json d = b.document();
  for (json& n : d["nodes"])
    if (n.contains("matrix")) n["matrix"][12] = n["matrix"][12].get<double>() + 1;
  write(b.folder / "c.gltf", d.dump());
  const Scene moved = load(b.folder / "c.gltf");
  CHECK(moved.instances[b.find("cup")].to_world[3].x != b.edited->instances[b.find("cup")].to_world[3].x);
}

TEST_CASE("hidden nodes are read: objects below them are hidden, lamps are off, cameras stay") {
  Asset a = room();
  a.doc["nodes"][1]["extensions"] = k_hidden;                                   // the cup, with its spoon
  a.doc["nodes"][4]["extensions"] = k_hidden;                                   // the chair, with its lamp
  a.doc["nodes"][6]["extensions"] = {{"KHR_node_visibility", json::object()}};  // visible by default
  Bench b(a);
  const auto hidden = [&](const char* name) { return b.loaded->instances[b.find(name)].hidden; };
  CHECK(hidden("cup"));
  CHECK(hidden("spoon"));
  CHECK(hidden("chair"));
  CHECK_FALSE(hidden("table"));
  CHECK_FALSE(hidden("shelf"));
  CHECK_FALSE(b.loaded->lights[0].enabled);
  CHECK(count_triangles(*b.loaded) == 3);
  CHECK(b.loaded->extensions.back() == "KHR_node_visibility");
  CHECK(b.loaded->unknown_extensions.empty());
}

TEST_CASE("hiding and showing is saved, of one object alone") {
  Bench b(room());
  b.put("plate", {.hidden = true});
  b.put("table", {.hidden = true});  // not its cup
  b.put("chair", {.moved = {0, 1, 0}, .hidden = true});
  check_same(b.saved(), *b.edited);
  json d = b.document();
  CHECK(d["nodes"][5]["extensions"]["KHR_node_visibility"]["visible"] == false);
  CHECK(std::count(d["extensionsUsed"].begin(), d["extensionsUsed"].end(), "KHR_node_visibility") == 1);
  CHECK(load(b.folder / "b.gltf").lights[0].enabled);

  // Shown again, one of those that a parent hides.
  Asset a = room();
  a.doc["nodes"][2]["extensions"] = k_hidden;
  a.doc["nodes"][4]["extensions"] = k_hidden;
  a.doc["extensionsUsed"].push_back("KHR_node_visibility");
  for (const auto& shown : std::vector<std::vector<const char*>>{{"spoon"},
                                                                 {"cup"},
                                                                 {"table"},
                                                                 {"chair"},
                                                                 {"table", "spoon"},
                                                                 {"table", "cup", "spoon", "chair"}}) {
    Bench c(a);
    for (const char* name : shown) c.put(name, {});
    INFO(fmt::format("{}", fmt::join(shown, " ")));
    const Scene read = c.saved();
    check_same(read, *c.edited);
    CHECK_FALSE(read.lights[0].enabled);
    const bool any = c.document().dump().find("\"visible\":false") != std::string::npos;
    const auto used = c.document()["extensionsUsed"];
    CHECK((std::find(used.begin(), used.end(), "KHR_node_visibility") != used.end()) == any);
  }
}

TEST_CASE("a lamp below a hidden node can be switched on, and one that its node's object shows stays off") {
  Asset a = room();
  a.doc["nodes"][4]["extensions"] = k_hidden;
  Bench b(a);
  b.edited->lights[0].enabled = true;
  const Scene on = b.saved();
  CHECK(on.lights[0].enabled);
  CHECK(on.instances[b.find("chair")].hidden);
  // The lamp is in the object's own node.
  Asset own = room();
  own.doc["nodes"][5]["extensions"] = k_hidden;
  own.doc["nodes"][5]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
  Bench c(own);
  REQUIRE(c.loaded->lights.size() == 2);
  c.put("plate", {});
  const Scene off = c.saved();
  CHECK_FALSE(off.instances[c.find("plate")].hidden);
  CHECK_FALSE(off.lights[1].enabled);
}

TEST_CASE("animated nodes, skins and copies of a node are saved in nodes of their own") {
  // Animated: the channel goes on turning the node, with the mesh below it.
  Asset animated = room();
  const int times = animated.accessor<float>("SCALAR", {0, 1}),
            ways = animated.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0});
  animated.doc["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 5}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", ways}}}}}};
  Bench b(animated);
  b.put("plate", {.moved = {0, 0, 2}});
  check_same(b.saved(), *b.edited);
  CHECK(b.document()["nodes"][5]["translation"] == json({0, 0.75, 0}));

  // Placed by joints.
  Asset skinned;
  json& primitive = skinned.triangle({{"name", "cloth"}, {"skin", 0}, {"translation", {9, 9, 9}}});
  const int joints = skinned.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const int weights = skinned.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  primitive["attributes"]["JOINTS_0"] = joints, primitive["attributes"]["WEIGHTS_0"] = weights;
  skinned.doc["skins"] = {{{"joints", {1}}}};
  skinned.doc["nodes"].push_back({{"name", "bone"}, {"translation", {1, 2, 3}}});
  skinned.doc["scenes"][0]["nodes"].push_back(1);
  Bench s(skinned);
  s.put("cloth", {.moved = {1, 0, 0}, .turned = {0, 45, 0}});
  const Scene read = s.saved();
  check_same(read, *s.edited);
  REQUIRE(s.result.notes.size() == 1);
  CHECK_THAT(s.result.notes[0], Contains("'cloth' is placed by joints"));
  s.loaded = std::make_shared<const Scene>(read), s.edited = std::make_shared<Scene>(read);
  s.put("cloth", {.moved = {0, 1, 0}});
  check_same(s.saved(), *s.edited);

  // Copies of a mesh in one node.
  Asset copies;
  copies.triangle({{"name", "tile"}, {"translation", {0, 0, 1}}, {"rotation", {0, 0.6, 0, 0.8}}});
  const int where = copies.accessor<float>("VEC3", {0, 0, 0, 0.1f, 0, 0, 0.2f, 0, 0});
  copies.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {
      {"attributes", {{"TRANSLATION", where}}}};
  copies.doc["nodes"][0]["extras"] = {{"light_group", "floor"}};
  copies.doc["extensionsUsed"] = copies.doc["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  copies.triangle({{"name", "last"}});
  Bench c(copies);
  c.put("tile #1", {.moved = {0, 1, 0}});
  c.put("tile #2", {.hidden = true});
  check_same(c.saved(), *c.edited);
  CHECK(!c.document().contains("extensionsRequired"));
}

TEST_CASE("copies of a mesh far from its own origin keep their places, flattened ones are refused") {
  Asset far;
  far.mesh(
      {{"attributes", {{"POSITION", far.accessor<float>("VEC3", {40000, 0, 0, 40001, 0, 0, 40000, 1, 0})}}}},
      {{"name", "tile"}, {"rotation", {0, 0.6, 0, 0.8}}});
  const int where = far.accessor<float>("VEC3", {-40000, 0, 0, -40002, 0, 0, -40004, 1, 0});
  far.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", {{"TRANSLATION", where}}}};
  far.doc["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  Bench b(far);
  const glm::dvec3 shift = b.loaded->meshes[0].shift;
  REQUIRE(std::abs(shift.x - 40000) < 10);
  b.put("tile #1", {.moved = {0, 1, 0}, .turned = {0, 30, 0}});
  const Scene read = b.saved();
  check_same(read, *b.edited);
  // Other programs read the nodes alone: the first corner of each copy.
  const json d = b.document();
  for (size_t i = 0; i < 3; ++i) {
    const json& n = d["nodes"][1 + i];
    glm::dmat4 local(1);
    REQUIRE(n.contains("matrix"));
    for (int k = 0; k < 16; ++k) local[k / 4][k % 4] = n["matrix"][size_t(k)].get<double>();
    glm::dmat4 parent = glm::mat4_cast(glm::dquat(0.8, 0, 0.6, 0));
    const glm::dvec3 corner(parent * local * glm::dvec4(40000, 0, 0, 1));
    const vec3 shown(b.edited->instances[b.find(n["name"])].to_world *
                     vec4(vec3(glm::dvec3(40000, 0, 0) - shift), 1));
    CHECK(glm::length(vec3(corner) - shown) < 1e-2f);
  }

  Asset flat = far;
  const int sizes = flat.accessor<float>("VEC3", {1, 1, 1, 1, 1, 0, 1, 1, 1});
  flat.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = sizes;
  Bench c(flat);
  c.put("tile #0", {.moved = {0, 1, 0}});
  CHECK_THROWS_WITH(c.saved(), Contains("object 'tile #1': it is placed by joints or by a matrix"));
}

TEST_CASE("a scene whose objects are as they were is saved to the byte") {
  Bench b(room());
  b.put("plate", {.moved = {1, 1, 1}, .hidden = true});
  b.put("plate", {});
  b.saved();
  CHECK(read_file(b.folder / "a.gltf") == read_file(b.folder / "b.gltf"));
}

TEST_CASE("damaged visibility and matrices are refused where they stand") {
  const auto failure = [](const Asset& a) {
    TempFolder folder;
    try {
      load(a.gltf(folder));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  Asset a = room();
  a.doc["nodes"][5]["extensions"] = {{"KHR_node_visibility", {{"visible", "no"}}}};
  CHECK_THAT(failure(a), Contains("nodes[5].extensions.KHR_node_visibility.visible"));
  a.doc["nodes"][5]["extensions"] = {{"KHR_node_visibility", 1}};
  CHECK_THAT(failure(a), Contains("nodes[5].extensions.KHR_node_visibility"));
  a = room();
  a.doc["nodes"][5]["extras"] = {{"lucerna", {{"to_world", {1, 2, 3}}}}};
  CHECK_THAT(failure(a), Contains("nodes[5].extras.lucerna.to_world") && Contains("3 numbers, expected 16"));
  json matrix = json::array();
  for (int i = 0; i < 16; ++i) matrix.push_back(i % 5 == 0 ? 1 : 0);
  matrix[3] = 1;
  a.doc["nodes"][5]["extras"] = {{"lucerna", {{"to_world", matrix}}}};
  CHECK_THAT(failure(a), Contains("the last row is not 0 0 0 1"));
  matrix[3] = "x";
  a.doc["nodes"][5]["extras"] = {{"lucerna", {{"to_world", matrix}}}};
  CHECK_THAT(failure(a), Contains("nodes[5].extras.lucerna.to_world[3]"));
}

}  // namespace scene_save_objects_tests
