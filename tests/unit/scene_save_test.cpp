// links: scene_io
// Saving of scenes: edits read back exactly, and everything else is kept.
#include "scene/io/save.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

#include "base/color.h"
#include "base/file.h"
#include "scene/io/json_edit.h"
#include "scene/io/light_picture_file.h"
#include "scene/io/light_profile_file.h"
#include "scene/lamp.h"
#include "scene/sky_image.h"
#include "scene/solar.h"
#include "unit/scene_support.h"

namespace scene_save_tests {

using namespace lucerna;
using namespace lucerna::scene;
using namespace lucerna::test;
using Catch::Contains;

namespace {

/// Two lamps, of which one is in a turned and moved parent, a sun, a material, a camera, and things that are
/// not known.
Asset room() {
  Asset a;
  const int material = a.add("materials", {{"name", "paint"},
                                           {"pbrMetallicRoughness", {{"roughnessFactor", 0.25}, {"x", 1}}},
                                           {"extensions", {{"EXT_unknown", {{"a", {1, 2}}}}}}});
  a.triangle({{"name", "floor"}})["material"] = material;
  a.doc["extensionsUsed"] = {"KHR_lights_punctual", "EXT_unknown"};
  a.doc["extensions"] = {
      {"KHR_lights_punctual",
       {{"lights",
         {{{"type", "spot"}, {"name", "reading"}, {"intensity", 5}, {"spot", {{"outerConeAngle", 0.5}}}},
          {{"type", "point"},
           {"color", {1, 0.5, 0.25}},
           {"range", 3},
           {"extras", {{"light_group", "table"}}}},
          {{"type", "directional"}, {"name", "sun"}}}}}},
      {"EXT_unknown", {{"deep", {{"b", "c"}}}}}};
  const auto lamp = [](int light) { return json{{"KHR_lights_punctual", {{"light", light}}}}; };
  const int reading =
      a.add("nodes", {{"name", "lamp node"}, {"extensions", lamp(0)}, {"translation", {0.1, 0.2, 0.3}}});
  const int arm = a.add("nodes", {{"children", {reading}},
                                  {"translation", {1, 2, 3}},
                                  {"rotation", {0.1825741858, 0.3651483717, 0.5477225575, 0.7302967433}},
                                  {"scale", {2, 1, 0.5}}});
  const int table = a.add("nodes", {{"name", "table lamp"}, {"extensions", lamp(1)}});
  const int sun = a.add("nodes", {{"extensions", lamp(2)}, {"extras", {{"note", "keep"}}}});
  const int camera =
      a.add("cameras",
            {{"type", "perspective"}, {"name", "view"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  const int eye = a.add("nodes", {{"camera", camera}, {"translation", {0, 1, 5}}});
  for (const int n : {arm, table, sun, eye}) a.doc["scenes"][0]["nodes"].push_back(n);
  a.doc["asset"]["generator"] = "by hand";
  return a;
}

/// A scene in a folder, its edited copy, and what reading the saved file gives.
struct Bench {
  TempFolder folder;
  std::filesystem::path source;
  std::shared_ptr<const Scene> loaded;
  std::shared_ptr<Scene> edited;
  SaveRequest request;

  explicit Bench(const Asset& asset, const std::string& name = "a.gltf") {
    source = name.ends_with(".glb") ? asset.glb(folder, name) : asset.gltf(folder, name);
    read();
  }
  void read() {
    loaded = std::make_shared<const Scene>(load(source));
    edited = std::make_shared<Scene>(*loaded);
  }
  Scene saved(const std::filesystem::path& file) {
    request.loaded = loaded, request.edited = edited, request.file = file;
    result = save(request);
    LoadOptions options;
    options.outside = true;
    return load(file, options);
  }
  Scene saved() { return saved(folder / "b.gltf"); }
  std::string failure(const std::filesystem::path& file) {
    try {
      saved(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  json document(const std::string& name = "b.gltf") { return json::parse(read_file(folder / name)); }
  SavedScene result;
};

std::vector<uint8_t> pixels(const Scene& s) { return s.images[0].bytes; }
std::vector<vec3> corners(const Scene& s) { return s.meshes[0].primitives[0].positions; }

void check_equal(const std::vector<Light>& a, const std::vector<Light>& b) {
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    INFO(a[i].name);
    Light other = b[i];
    other.id = a[i].id;  // nodes may have other numbers
    CHECK(a[i].name == other.name);
    CHECK(a[i].position == other.position);
    CHECK(a[i].direction == other.direction);
    CHECK(a[i].intensity == other.intensity);
    CHECK(a[i] == other);
  }
}

}  // namespace

TEST_CASE("without edits a scene is saved to the byte") {
  Bench b(room());
  b.saved();
  CHECK(read_file(b.folder / "b.gltf") == read_file(b.source));
  Bench glb(room(), "a.glb");
  glb.saved(glb.folder / "b.glb");
  CHECK(read_file(glb.folder / "b.glb") == read_file(glb.source));
}

TEST_CASE("edited lights read back exactly") {
  Bench b(room());
  REQUIRE(b.edited->lights.size() == 3);
  Light& reading = b.edited->lights[0];
  reading.position = {0.7123f, -1.3f, 2.000001f};
  reading.direction = vec3(glm::normalize(glm::dvec3(0.3, -1, 0.01)));
  reading.intensity = {12.345f, 6.789f, 0.123f};
  reading.inner_cone = reading.outer_cone = 0.5f * k_pi;
  reading.name = "Reading \"lamp\" \xC3\xA9";
  Light& table = b.edited->lights[1];
  table.enabled = false, table.group = "evening";
  table.intensity = vec3(0.3f);
  Light& sun = b.edited->lights[2];
  sun.sun = SunTime{.year = 2024,
                    .month = 6,
                    .day = 21,
                    .hours = 12.25,
                    .zone = 2,
                    .latitude = 48.1,
                    .longitude = 11.6,
                    .north = 15};
  sun.direction = sun_direction(*sun.sun);
  const Scene back = b.saved();
  check_equal(b.edited->lights, back.lights);
  // The rest is as it was.
  const json doc = b.document();
  CHECK(doc["asset"] == room().doc["asset"]);
  CHECK(doc["extensions"]["EXT_unknown"] == room().doc["extensions"]["EXT_unknown"]);
  CHECK(doc["materials"] == room().doc["materials"]);
  CHECK(doc["extensions"]["KHR_lights_punctual"]["lights"][1]["range"] == 3);
  CHECK(doc["buffers"] == json::parse(read_file(b.source))["buffers"]);
  bool noted = false;
  for (const json& node : doc["nodes"])
    noted |= node.contains("extras") && node["extras"].value("note", "") == "keep";
  CHECK(noted);
}

TEST_CASE("a light that is off has intensity 0 for other programs, and its own one when it is on again") {
  Asset a;
  a.triangle();
  Bench b(a);
  const auto profile = std::make_shared<LightProfile>(
      parse_ies("IES:LM-63-2019\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n700 500.5 3\n", "x"));
  for (const LightKind kind :
       {LightKind::point, LightKind::directional, LightKind::disk, LightKind::profile}) {
    Light l;
    l.name = fmt::format("lamp {}", b.edited->lights.size());
    l.id = k_first_added + Id(b.edited->lights.size());
    l.kind = kind, l.intensity = {0.1f, 3.3f, 0.7f};
    if (kind == LightKind::disk) l.radius = 0.2f;
    if (kind == LightKind::profile) l.profile = profile;
    b.edited->lights.push_back(l);
  }
  const auto strength = [&](const json& doc, size_t i) -> double {
    for (const json& node : doc["nodes"])
      if (node.value("name", "") == fmt::format("lamp {}", i)) {
        const json& e = node["extensions"];
        if (e.contains("EXT_lights_ies")) return e["EXT_lights_ies"]["multiplier"];
        const size_t at = e["KHR_lights_punctual"]["light"];
        return doc["extensions"]["KHR_lights_punctual"]["lights"][at]["intensity"];
      }
    return -1;
  };
  const auto same = [&](Scene read) {
    REQUIRE(read.lights.size() == 4);
    std::vector<Light> edited = b.edited->lights;
    for (std::vector<Light>* lights : {&read.lights, &edited})
      for (Light& l : *lights)
        if (l.profile) l.profile = profile;
    check_equal(edited, read.lights);
  };
  // Off when saved for the first time, and switched off, edited and switched on after that.
  b.edited->lights[0].enabled = false, b.edited->lights[3].enabled = false;
  same(b.saved());
  for (const size_t i : {0u, 3u}) CHECK(strength(b.document(), i) == 0);
  for (const size_t i : {1u, 2u}) CHECK(strength(b.document(), i) > 0);
  b.source = b.folder / "b.gltf";
  b.read();
  for (Light& l : b.edited->lights) l.enabled = !l.enabled;
  same(b.saved(b.folder / "c.gltf"));
  for (const size_t i : {0u, 3u}) CHECK(strength(b.document("c.gltf"), i) > 0);
  for (const size_t i : {1u, 2u}) CHECK(strength(b.document("c.gltf"), i) == 0);
  b.source = b.folder / "c.gltf";
  b.read();
  for (const size_t i : {1u, 2u}) b.edited->lights[i].intensity = {5, 0.3f, 0.01f};
  same(b.saved(b.folder / "d.gltf"));
  for (const size_t i : {1u, 2u}) CHECK(strength(b.document("d.gltf"), i) == 0);
  // An intensity that another program wrote counts more.
  json doc = b.document("d.gltf");
  for (json& l : doc["extensions"]["KHR_lights_punctual"]["lights"]) l["intensity"] = 2;
  write_file((b.folder / "e.gltf").string(), doc.dump());
  for (const Light& l : load(b.folder / "e.gltf").lights)
    if (l.kind == LightKind::disk) CHECK(std::max({l.intensity.x, l.intensity.y, l.intensity.z}) == 2);
}

TEST_CASE("of lights that share a definition, one can be off") {
  Asset a;
  a.triangle();
  Bench b(a);
  Light l;
  l.name = "pair", l.id = k_first_added, l.kind = LightKind::point, l.intensity = vec3(3);
  b.edited->lights = {l};
  b.saved();
  json doc = b.document();
  json twin = doc["nodes"].back();
  doc["scenes"][0]["nodes"].push_back(doc["nodes"].size());
  doc["nodes"].push_back(twin);
  write_file((b.folder / "twins.gltf").string(), doc.dump());
  b.source = b.folder / "twins.gltf";
  b.read();
  REQUIRE(b.edited->lights.size() == 2);
  b.edited->lights[0].enabled = false;
  const Scene back = b.saved(b.folder / "c.gltf");
  check_equal(b.edited->lights, back.lights);
  const json lights = b.document("c.gltf")["extensions"]["KHR_lights_punctual"]["lights"];
  REQUIRE(lights.size() == 2);
  CHECK(double(lights[0]["intensity"]) + double(lights[1]["intensity"]) == 3);
}

TEST_CASE("lights in every direction and of many colours read back exactly") {
  Asset a;
  a.triangle();
  Bench b(a);
  uint32_t state = 7;
  const auto random = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
  for (Id i = 0; i < 300; ++i) {
    Light l;
    l.name = fmt::format("lamp {}", i), l.id = k_first_added + i;
    l.kind = i % 2 ? LightKind::spot : LightKind::directional;
    l.direction = vec3(glm::normalize(glm::dvec3(random() - 0.5, random() - 0.5, random() - 0.5)));
    if (i < 6) l.direction = vec3(0), l.direction[int(i) % 3] = i < 3 ? 1.0f : -1.0f;
    l.intensity = 100.0f * vec3(random(), random(), random());
    if (l.kind == LightKind::spot) l.position = 10.0f * vec3(random(), random(), random()) - 5.0f;
    b.edited->lights.push_back(l);
  }
  const Scene back = b.saved();
  check_equal(b.edited->lights, back.lights);
}

TEST_CASE("lamps with a shape or a measured distribution read back exactly") {
  Asset a;
  a.triangle();
  Bench b(a);
  uint32_t state = 9;
  const auto random = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
  const auto profile = std::make_shared<LightProfile>(
      parse_ies("IES:LM-63-2019\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n700 500.5 3\n", "x"));
  profile->name = "downlight.ies";
  for (Id i = 0; i < 150; ++i) {
    Light l;
    l.name = fmt::format("lamp {}", i), l.id = k_first_added + i;
    l.kind = static_cast<LightKind>(static_cast<uint32_t>(LightKind::sphere) + i % 5);
    if (l.kind == LightKind::profile) l.profile = profile;
    l.position = 10.0f * vec3(random(), random(), random()) - 5.0f;
    l.intensity = 100.0f * vec3(random(), random(), random());
    if (l.kind != LightKind::sphere) {
      l.direction = vec3(glm::normalize(glm::dvec3(random() - 0.5, random() - 0.5, random() - 0.5)));
      l.right = rolled(l.direction, 360 * random());
    }
    if (l.kind == LightKind::rectangle) l.height = 0.01f + random();
    if (l.kind == LightKind::rectangle || l.kind == LightKind::tube) l.width = 0.01f + 3 * random();
    if (has_shape(l.kind) && l.kind != LightKind::rectangle) l.radius = 0.01f + random();
    l.two_sided = has_shape(l.kind) && i % 3 == 0, l.visible = !has_shape(l.kind) || i % 7 != 0;
    b.edited->lights.push_back(l);
  }
  const auto same_profiles = [](std::vector<Light> lights, const std::vector<Light>& as) {
    for (size_t i = 0; i < lights.size(); ++i)
      if (lights[i].profile && as[i].profile) {
        CHECK(lights[i].profile->intensity == as[i].profile->intensity);
        CHECK(lights[i].profile->name == as[i].profile->name);
        lights[i].profile = as[i].profile;
      }
    return lights;
  };
  Scene back = b.saved();
  check_equal(b.edited->lights, same_profiles(back.lights, b.edited->lights));
  const json doc = b.document();
  CHECK(doc["extensions"]["EXT_lights_ies"]["lights"].size() == 1);
  // Edits of what was saved.
  b.source = b.folder / "b.gltf";
  b.read();
  for (Light& l : b.edited->lights) {
    l.intensity *= 1.7f;
    if (l.kind == LightKind::profile || l.kind == LightKind::rectangle) l.right = rolled(l.direction, 77);
    if (has_shape(l.kind)) l.visible = !l.visible;
    if (l.kind == LightKind::disk) l.radius *= 0.3f;
  }
  b.edited->lights.erase(b.edited->lights.begin() + 4, b.edited->lights.begin() + 9);
  back = b.saved(b.folder / "c.gltf");
  check_equal(b.edited->lights, same_profiles(back.lights, b.edited->lights));
}

TEST_CASE("the picture of a spot is saved with it, and one that cannot be read is a warning") {
  const auto hdr = [](std::initializer_list<int> bytes) {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    for (const int b : bytes) text += char(b);
    return text;
  };
  Asset a;
  a.triangle();
  Bench b(a);
  write_file((b.folder / "slide.hdr").string(), hdr({128, 64, 0, 129, 0, 32, 128, 129}));
  write_file((b.folder / "black.hdr").string(), hdr({0, 0, 0, 0, 0, 0, 0, 0}));
  size_t mended = 7;
  const auto picture = load_light_picture(b.folder / "slide.hdr", mended);
  CHECK(mended == 0);
  CHECK(picture->texels[0].x == Approx(1).epsilon(0.01));
  CHECK_THROWS_WITH(load_light_picture(b.folder / "black.hdr", mended),
                    Contains("black.hdr: the picture is black"));
  CHECK_THROWS_WITH(load_light_picture(b.folder / "gone.png", mended), Contains("gone.png: cannot be read"));
  write_file((b.folder / "text.png").string(), "no picture");
  CHECK_THROWS_WITH(load_light_picture(b.folder / "text.png", mended), Contains("text.png"));

  Light l;
  l.name = "projector", l.id = k_first_added, l.kind = LightKind::spot, l.position = {1, 2, 3};
  l.direction = vec3(glm::normalize(glm::dvec3(1, -2, 0.5)));
  set_picture(l, picture);
  l.right = rolled(l.direction, 33);
  b.edited->lights.push_back(l);
  Scene back = b.saved();
  REQUIRE(back.lights.size() == 1);
  REQUIRE(back.lights[0].picture);
  CHECK(back.lights[0].picture->texels == picture->texels);
  CHECK(back.lights[0].picture->name == "slide.hdr");
  back.lights[0].picture = picture;
  check_equal(b.edited->lights, back.lights);

  // By a file beside the scene; files that are gone or black.
  using Case = std::pair<const char*, bool>;
  for (const auto& [name, read] :
       std::initializer_list<Case>{{"slide.hdr", true}, {"gone.hdr", false}, {"black.hdr", false}}) {
    json doc = b.document();
    doc["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["lucerna"]["picture"] = {{"uri", name}};
    write_file((b.folder / "c.gltf").string(), doc.dump());
    const Scene scene = load(b.folder / "c.gltf");
    REQUIRE(scene.lights.size() == 1);
    CHECK((scene.lights[0].picture != nullptr) == read);
    const auto warned = std::count_if(scene.warnings.begin(), scene.warnings.end(), [&](const auto& text) {
      return text.find("pictures of spots that cannot be read") != std::string::npos &&
             text.find(name) != std::string::npos;
    });
    CHECK((warned > 0) == !read);
  }
  // Edited and saved in another folder it stays a file, which is named from there; so does an untouched one.
  {
    json doc = b.document();
    doc["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["lucerna"]["picture"] = {
        {"uri", "slide.hdr"}};
    write_file((b.folder / "c.gltf").string(), doc.dump());
    Bench c(a);
    c.source = b.folder / "c.gltf";
    std::filesystem::create_directory(b.folder / "other");
    for (const bool edited : {false, true}) {
      c.read();
      if (edited) c.edited->lights[0].intensity *= 2.0f;
      const Scene moved = c.saved(b.folder / "other" / "c.gltf");
      REQUIRE(moved.lights.size() == 1);
      REQUIRE(moved.lights[0].picture);
      CHECK(moved.lights[0].picture->texels == picture->texels);
      CHECK(b.document("other/c.gltf")["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["lucerna"]
                                      ["picture"]["uri"] == "../slide.hdr");
      std::filesystem::remove(b.folder / "other" / "c.gltf");
    }
  }
  json wide = b.document();
  wide["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["outerConeAngle"] = 1.5;
  write_file((b.folder / "d.gltf").string(), wide.dump());
  const Scene without = load(b.folder / "d.gltf");
  CHECK_FALSE(without.lights.at(0).picture);
  CHECK(std::any_of(without.warnings.begin(), without.warnings.end(), [](const std::string& w) {
    return w.find("more than 80 degrees") != std::string::npos;
  }));
}

TEST_CASE("shapes and distributions that cannot be used: a warning with the place, and the rest is read") {
  Asset a;
  a.triangle();
  a.doc["extensionsUsed"] = {"KHR_lights_punctual", "EXT_lights_ies"};
  const auto shape = [](json own) {
    return json{{"type", "point"}, {"extras", {{"lucerna", std::move(own)}}}};
  };
  a.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      shape({{"shape", "sphere"}, {"radius", 0}}), shape({{"shape", "lantern"}}),
      shape({{"shape", "rectangle"}, {"width", "wide"}, {"height", 1}}),
      shape({{"shape", "disk"}, {"radius", 0.25}})};
  a.doc["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "gone.ies"}}, {{"uri", "cut.ies"}}};
  for (int i = 0; i < 4; ++i)
    a.doc["scenes"][0]["nodes"].push_back(
        a.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}}));
  for (int i = 0; i < 2; ++i)
    a.doc["scenes"][0]["nodes"].push_back(
        a.add("nodes", {{"extensions", {{"EXT_lights_ies", {{"light", i}}}}}}));
  TempFolder folder;
  write_file(folder / "cut.ies",
             "IES:LM-63-2019\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n700 500");
  const Scene s = load(a.gltf(folder, "a.gltf"));
  REQUIRE(s.lights.size() == 4);
  CHECK(s.lights[0].kind == LightKind::point);
  CHECK(s.lights[3].kind == LightKind::disk);
  CHECK(s.lights[3].radius == 0.25f);
  const std::string all = fmt::format("{}", fmt::join(s.warnings, "\n"));
  CHECK_THAT(all, Contains("radius: 0 m is not between 0.0001 and 10000"));
  CHECK_THAT(all, Contains("2 lamps whose distribution cannot be read") && Contains("gone.ies"));
  a.doc["extensions"]["EXT_lights_ies"]["lights"][0]["uri"] = "cut.ies";
  CHECK_THAT(fmt::format("{}", fmt::join(load(a.gltf(folder, "b.gltf")).warnings, "\n")),
             Contains("cut.ies") && Contains("the file ends before"));
}

TEST_CASE("added and deleted lights") {
  Bench b(room());
  Light lamp{.name = "new",
             .kind = LightKind::spot,
             .intensity = {3, 2, 1},
             .position = {1, 2, 3},
             .group = "mine",
             .id = k_first_added};
  lamp.direction = vec3(glm::normalize(glm::dvec3(1, -1, 0)));
  b.edited->lights.erase(b.edited->lights.begin() + 1);
  b.edited->lights.push_back(lamp);
  const Scene back = b.saved();
  check_equal(b.edited->lights, back.lights);
  // Its definition is gone too, and the others are found.
  CHECK(b.document()["extensions"]["KHR_lights_punctual"]["lights"].size() == 3);
  // Without lights, the extension is no longer used.
  b.edited->lights.clear();
  CHECK(b.saved(b.folder / "c.gltf").lights.empty());
  const json none = b.document("c.gltf");
  CHECK(none["extensionsUsed"] == json{"EXT_unknown"});
  CHECK_FALSE(none["extensions"].contains("KHR_lights_punctual"));
}

TEST_CASE("a light that moves out of a node with a mesh leaves the mesh there") {
  Asset a;
  a.triangle({{"name", "body"},
              {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
              {"translation", {1, 1, 1}},
              {"extras", {{"light_group", "g"}}}});
  a.doc["extensionsUsed"] = {"KHR_lights_punctual"};
  a.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "bulb"}}};
  Bench b(a);
  b.edited->lights[0].position = {5, 5, 5};
  const Scene back = b.saved();
  check_equal(b.edited->lights, back.lights);
  CHECK(back.instances.size() == 1);
  CHECK(std::as_const(back.instances)[0].to_world == std::as_const(b.loaded->instances)[0].to_world);
}

TEST_CASE("two nodes of one light are edited apart") {
  Asset a;
  a.triangle();
  a.doc["extensionsUsed"] = {"KHR_lights_punctual"};
  a.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  for (const char* name : {"left", "right"})
    a.doc["scenes"][0]["nodes"].push_back(
        a.add("nodes", {{"name", name}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  Bench b(a);
  b.edited->lights[1].intensity = {7, 0, 0};
  const Scene back = b.saved();
  check_equal(b.edited->lights, back.lights);
  CHECK(back.lights[0].intensity == vec3(1));
}

TEST_CASE("emission that is switched off is saved beside black") {
  Asset a = room();
  a.doc["materials"][0]["emissiveFactor"] = {1, 0.5, 0.25};
  Bench b(a);
  REQUIRE(b.loaded->materials[0].emission == vec3(1, 0.5f, 0.25f));
  Material& m = b.edited->materials[0];
  m.off_emission = m.emission, m.emission = vec3(0);
  CHECK(b.saved().materials[0] == m);
  CHECK(b.document()["materials"][0]["emissiveFactor"] == json::parse("[0, 0, 0]"));
  // Switched on again, nothing of it is left in the file.
  b.source = b.folder / "b.gltf";
  b.read();
  Material& again = b.edited->materials[0];
  again.emission = again.off_emission, again.off_emission = vec3(0);
  CHECK(b.saved(b.folder / "c.gltf").materials[0] == b.edited->materials[0]);
  CHECK(read_file(b.folder / "c.gltf").find("off_emission") == std::string::npos);
  for (const char* bad : {"[1, 2]", "[-1, 0, 0]", "\"red\"", "[1e60, 0, 0]"}) {
    INFO(bad);
    Asset broken = room();
    broken.doc["materials"][0]["extras"]["lucerna"]["off_emission"] = json::parse(bad);
    CHECK_THROWS_WITH(load(broken.gltf(b.folder, "bad.gltf")), Catch::Contains("off_emission"));
  }
}

TEST_CASE("materials' factors read back exactly, also of the default material") {
  Asset a = room();
  a.triangle();
  Bench b(a);
  REQUIRE(b.edited->materials.size() == 2);
  for (Material& m : b.edited->materials) {
    m.base_color = {0.1f, 0.23456f, 0.9f, m.base_color.w};
    m.roughness = 0.777f, m.metallic = 0.1f;
    m.emission = {40.5f, 28.123f, 12.7f};
    m.clearcoat = 0.3f, m.clearcoat_roughness = 0.12f;
    m.sheen_color = {0.1f, 0.2f, 0.7f}, m.sheen_roughness = 0.35f;
    m.anisotropy = 0.45f, m.anisotropy_rotation = 1.2f;
    m.dispersion = 0.25f, m.diffuse_roughness = 0.6f;
    m.height = 0.0123f, m.deep_relief = true;
    m.iridescence = 0.9f, m.iridescence_maximum = 333.3f;
  }
  const Scene back = b.saved();
  REQUIRE(back.materials.size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    CHECK(back.materials[i].base_color == b.edited->materials[i].base_color);
    CHECK(back.materials[i].emission == b.edited->materials[i].emission);
    CHECK(back.materials[i].roughness == 0.777f);
    CHECK(back.materials[i].metallic == 0.1f);
    CHECK(back.materials[i] == b.edited->materials[i]);
  }
  CHECK(b.document()["materials"][0]["extensions"]["EXT_unknown"] ==
        room().doc["materials"][0]["extensions"]["EXT_unknown"]);
  // Weak emission needs no extension.
  for (Material& m : b.edited->materials) m.emission = {0.5f, 0.25f, 0};
  CHECK(b.saved(b.folder / "c.gltf").materials[0].emission == vec3(0.5f, 0.25f, 0));
  CHECK_FALSE(read_file(b.folder / "c.gltf").find("emissive_strength") != std::string::npos);
}

TEST_CASE("colours and strengths multiply to exactly the given values") {
  uint32_t state = 3;
  for (int i = 0; i < 2000; ++i) {
    vec3 value;
    for (int k = 0; k < 3; ++k)
      value[k] = std::ldexp(float((state = state * 1664525u + 1013904223u) >> 8), i % 40 - 30);
    const auto [color, strength] = split_strength(value);
    const vec3 written(float(number_json(color.x).get<double>()), float(number_json(color.y).get<double>()),
                       float(number_json(color.z).get<double>()));
    CHECK(written * float(number_json(strength).get<double>()) == value);
    CHECK(strength_of(color) <= 1);
  }
  CHECK(split_strength(vec3(0)).second == 0);
}

TEST_CASE("cameras are added, and replaced by name") {
  Bench b(room());
  Camera corner = b.loaded->cameras[0];
  corner.name = "corner";
  corner.to_world = mat4(1);
  corner.to_world[3] = vec4(3, 1, 2, 1);
  corner.yfov = 0.5f, corner.lens = {.f_number = 2, .focus_distance = 3, .blades = 6},
  corner.shift = {0, 0.1f};
  corner.wide = Wide::fisheye;
  corner.section = {.normal = {0, 0, 1}, .offset = -0.5f};
  Camera view = corner;
  view.name = "view", view.yfov = 0.9f;
  b.request.cameras = {corner, view};
  const Scene back = b.saved();
  REQUIRE(back.cameras.size() == 2);
  CHECK(back.cameras[0].name == "view");
  CHECK(back.cameras[0].yfov == 0.9f);
  CHECK(back.cameras[1].name == "corner");
  CHECK(glm::distance(vec3(back.cameras[1].to_world[3]), vec3(3, 1, 2)) < 1e-6f);
  CHECK(back.cameras[1].lens == corner.lens);
  CHECK(back.cameras[1].shift == corner.shift);
  CHECK(back.cameras[1].wide == Wide::fisheye);
  CHECK(back.cameras[1].section == corner.section);
}

TEST_CASE("environment and settings are in the file, over settings.json") {
  Asset a = room();
  Bench b(a);
  write(b.folder / "settings.json",
        std::string(R"({"film": {"ev": 1}, "samples": 8, "environment": {"radiance": [1, 1, 1]}})"));
  b.read();
  b.edited->environment.scale = 0.5f;
  b.request.settings = {{"film.ev", "2"}, {"samples", "8"}};
  Scene back = b.saved();
  CHECK(back.environment.radiance == vec3(1));
  CHECK(back.environment.scale == 0.5f);
  // Only what differs from settings.json, which is beside it.
  CHECK(back.own_settings == std::vector<std::pair<std::string, std::string>>{{"film.ev", "2"}});
  // In another folder, all.
  std::filesystem::create_directory(b.folder / "other");
  back = b.saved(b.folder / "other/c.gltf");
  CHECK(back.own_settings.size() == 2);
  CHECK(back.environment.scale == 0.5f);
  CHECK(back.settings.empty());
  // A sky by formula.
  b.edited->environment = {
      .image = k_none - 1, .scale = 2, .given = true, .sky = SkyModel{.turbidity = 4, .to_sun = {0, 1, 0}}};
  back = b.saved(b.folder / "d.gltf");
  REQUIRE(back.environment.sky);
  CHECK(*back.environment.sky == *b.edited->environment.sky);
  CHECK(back.environment.scale == 2);
  REQUIRE(back.environment.image != k_none);
  CHECK(std::as_const(back.images)[back.environment.image].floats == sky_image(*back.environment.sky).floats);
  // The first versions wrote kcd/m2, and no unit.
  json old = json::parse(read_file(b.folder / "d.gltf"));
  json& environment = old["scenes"][0]["extras"]["lucerna"]["environment"];
  environment["sky"].erase("unit");
  write(b.folder / "old.gltf", old.dump());
  CHECK(load(b.folder / "old.gltf").environment.scale == Approx(0.002f));
}

TEST_CASE("numbers and textures of materials are saved") {
  TempFolder elsewhere;
  write_image<uint8_t>(elsewhere / "own.png", 1, 1, 4, {250, 240, 230, 255});
  write_image<uint8_t>(elsewhere / "bumps.png", 1, 1, 4, {128, 100, 255, 255});
  Asset a;
  const std::string own_bytes = lucerna::read_file(elsewhere / "own.png");
  const int image =
      a.add("images", {{"uri", "data:image/png;base64," + base64({own_bytes.begin(), own_bytes.end()})}});
  const int texture = a.add("textures", {{"source", image}});
  a.textured_triangle(
      {{"name", "paint"},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 1}}}}}});
  const int plain = a.add("materials", {{"name", "plain"}});
  a.triangle({{"name", "second"}})["material"] = plain;
  Bench b(a);
  b.read();
  REQUIRE(b.loaded->materials.size() == 2);
  REQUIRE(b.loaded->materials[0].base_color_texture);
  std::filesystem::create_directories(b.folder / "far");
  write_image<uint8_t>(b.folder / "near.png", 1, 1, 4, {10, 20, 30, 255});
  for (Material& m : b.edited->materials) {
    m.ior = 1.7f, m.specular = 0.5f, m.specular_color = {1, 2, 0.5f}, m.transmission = 0.9f,
    m.thickness = 0.02f;
    m.attenuation_color = {0.5f, 0.9f, 0.7f}, m.attenuation_distance = 0.3f;
    m.alpha_mode = AlphaMode::mask, m.base_color.w = 0.6f, m.alpha_cutoff = 0.3f, m.double_sided = true;
    m.diffuse_transmission = 0.25f, m.diffuse_transmission_color = {0.1f, 0.2f, 0.3f};
    m.iridescence_ior = 1.4f, m.iridescence_minimum = 50, m.iridescence_maximum = 300;
  }
  b.edited->materials[1].normal_scale = 0.5f;
  using Kind = TextureSource::Kind;
  const auto by_file = [](const std::filesystem::path& f) { return TextureSource{Kind::file, f.string()}; };
  const uint32_t base = texture_slot("base_color"), normal = texture_slot("normal"),
                 coat = texture_slot("clearcoat_normal"), sheen = texture_slot("sheen_color");
  b.request.textures[0] = {{base, {.kind = Kind::none}}, {sheen, by_file(b.folder / "near.png")}};
  b.request.textures[1] = {{base, {Kind::material, "", 0}},
                           {normal, by_file(elsewhere / "bumps.png")},
                           {coat, by_file(elsewhere / "bumps.png")}};
  for (const char* name : {"b.gltf", "far/c.gltf", "d.glb"}) {
    CAPTURE(name);
    const Scene back = b.saved(b.folder / name);
    for (uint32_t i = 0; i < 2; ++i)
      CHECK(static_cast<const MaterialFactors&>(back.materials[i]) == b.edited->materials[i]);
    const auto texel = [&](const TextureUse& use) {
      REQUIRE(use);
      const Image& image = std::as_const(back.images)[std::as_const(back.textures)[use.texture].image];
      return std::vector<int>(image.bytes.begin(), image.bytes.begin() + 3);
    };
    CHECK_FALSE(back.materials[0].base_color_texture);
    CHECK(texel(back.materials[0].sheen_color_texture) == std::vector<int>{10, 20, 30});
    CHECK(texel(back.materials[1].normal_texture) == std::vector<int>{128, 100, 255});
    CHECK(texel(back.materials[1].clearcoat_normal_texture) == std::vector<int>{128, 100, 255});
    CHECK(texel(back.materials[1].base_color_texture) == std::vector<int>{250, 240, 230});
    CHECK(back.materials[1].normal_texture.uv_set != back.materials[1].base_color_texture.uv_set);
  }
  const json doc = b.document("b.gltf");
  CHECK(doc["images"].size() == 3);
  CHECK(doc["images"][1]["uri"] == "near.png");
  CHECK_THAT(doc["images"][2]["uri"].get<std::string>(), Contains("data:image/png;base64,"));
}

TEST_CASE("an environment that the file names is not named twice") {
  for (const bool ours : {false, true}) {
    Asset a = room();
    const json named{{"radiance", {0.25, 0.5, 1}}, {"scale", 2}};
    a.doc["scenes"][0]["extras"]["environment"] = named;
    if (ours) a.doc["scenes"][0]["extras"]["lucerna"]["environment"] = {{"radiance", {1, 1, 1}}};
    Bench b(a);
    b.read();
    std::filesystem::create_directory(b.folder / "other");
    const Scene back = b.saved(b.folder / "other/c.gltf");
    CHECK(back.environment.radiance == (ours ? vec3(1) : vec3(0.25f, 0.5f, 1)));
    CHECK(b.document("other/c.gltf")["scenes"][0]["extras"] == b.document("a.gltf")["scenes"][0]["extras"]);
    // Beside a settings.json that overrides it, elsewhere that one is kept.
    if (ours) continue;
    write(b.folder / "settings.json", std::string(R"({"environment": {"radiance": [1, 2, 3]}})"));
    b.read();
    CHECK(b.saved(b.folder / "other/d.gltf").environment.radiance == vec3(1, 2, 3));
  }
}

TEST_CASE("a .glb contains the image of its environment") {
  Asset a = room();
  a.doc["scenes"][0]["extras"]["environment"] = {{"file", "sky.png"}, {"scale", 2}};
  TempFolder folder, other;
  write_image<uint8_t>(folder / "sky.png", 2, 1, 4, {255, 0, 0, 255, 0, 0, 255, 255});
  const auto loaded = std::make_shared<const Scene>(load(a.gltf(folder)));
  REQUIRE(loaded->environment.image != k_none);
  auto edited = std::make_shared<Scene>(*loaded);
  SaveRequest request{.loaded = loaded, .edited = edited, .file = other / "b.glb"};
  CHECK(save(request).notes.empty());
  const auto back = std::make_shared<const Scene>(load(other / "b.glb"));  // nothing is outside its folder
  const auto sky = [](const Scene& s) { return std::as_const(s.images)[s.environment.image].floats; };
  CHECK(sky(*back) == sky(*loaded));
  CHECK(back->environment.scale == 2);
  // And again, changed, as both kinds.
  auto turned = std::make_shared<Scene>(*back);
  turned->environment.rotation = 30;
  for (const char* name : {"c.glb", "c.gltf"}) {
    CAPTURE(name);
    const Scene again =
        (save({.loaded = back, .edited = turned, .file = folder / name}), load(folder / name));
    CHECK(sky(again) == sky(*loaded));
    CHECK(again.environment.rotation == 30);
  }
}

TEST_CASE("a moved lamp that is off is off for other programs too") {
  // The first versions left its intensity in the definition.
  Asset a = room();
  for (json& node : a.doc["nodes"])
    if (node.value("name", "") == "table lamp") node["extras"]["lucerna"]["enabled"] = false;
  Bench b(a);
  b.read();
  Light& lamp = *std::find_if(b.edited->lights.begin(), b.edited->lights.end(),
                              [](const Light& l) { return !l.enabled; });
  lamp.position.x += 1;
  const Scene back = b.saved(b.folder / "b.gltf");
  check_equal(b.edited->lights, back.lights);
  const json doc = b.document("b.gltf");
  int points = 0;
  for (const json& light : doc["extensions"]["KHR_lights_punctual"]["lights"]) {
    if (light["type"] != "point") continue;
    CHECK(light.value("intensity", 1.0) == 0);
    ++points;
  }
  CHECK(points == 1);
}

TEST_CASE("references stay right in another folder") {
  TempFolder folder;
  std::filesystem::create_directories(folder / "in/tex tures");
  std::filesystem::create_directories(folder / "out");
  write_image<uint8_t>(folder / "in/tex tures/a b.png", 1, 1, 4, {255, 0, 0, 255});
  Asset a;
  const int image = a.add("images", {{"uri", "tex%20tures/a%20b.png"}});
  a.textured_triangle({{"pbrMetallicRoughness",
                        {{"baseColorTexture", {{"index", a.add("textures", {{"source", image}})}}}}}});
  json doc = a.complete(false);
  doc["buffers"][0]["uri"] = "a.bin";
  write(folder / "in/a.bin", a.bin.data(), a.bin.size());
  write(folder / "in/a.gltf", doc.dump());
  const auto loaded = std::make_shared<const Scene>(load(folder / "in/a.gltf"));
  SaveRequest request{.loaded = loaded, .edited = loaded, .file = folder / "out/b.gltf"};
  const SavedScene saved = save(request);
  REQUIRE(saved.notes.size() == 1);
  CHECK_THAT(saved.notes[0], Contains("2 files that it names lie outside its folder"));
  const json out = json::parse(read_file(folder / "out/b.gltf"));
  CHECK(out["buffers"][0]["uri"] == "../in/a.bin");
  CHECK(out["images"][0]["uri"] == "../in/tex%20tures/a%20b.png");
  LoadOptions outside;
  outside.outside = true;
  CHECK(pixels(load(folder / "out/b.gltf", outside)) == pixels(*loaded));
  // A .glb holds all of it.
  request.file = folder / "out/b.glb";
  CHECK(save(request).notes.empty());
  const Scene glb = load(folder / "out/b.glb");
  CHECK(pixels(glb) == pixels(*loaded));
  CHECK(corners(glb) == corners(*loaded));
  // And back: the binary chunk is a file.
  SaveRequest back{.loaded = std::make_shared<const Scene>(glb), .file = folder / "out/c.gltf"};
  back.edited = back.loaded;
  save(back);
  CHECK(std::filesystem::exists(folder / "out/c.bin"));
  CHECK(corners(load(folder / "out/c.gltf")) == corners(*loaded));
}

TEST_CASE("nothing is replaced that the user may not know of") {
  Bench b(room());
  b.edited->lights[0].intensity = vec3(3);
  CHECK_THAT(b.failure(b.folder / "gone/b.gltf"), Contains("gone"));
  CHECK_THAT(b.failure(b.folder / "b.obj"), Contains("a scene is saved as .gltf or .glb"));
  write(b.folder / "b.gltf", std::string("{}"));
  CHECK_THAT(b.failure(b.folder / "b.gltf"),
             Contains("the file exists and is not the open scene; replace=true"));
  CHECK(read_file(b.folder / "b.gltf") == "{}");
  // Over the source, twice.
  CHECK(b.failure(b.source).empty());
  CHECK_THAT(b.failure(b.source), Contains("has changed on disk"));
  b.request.written = b.result.written;
  b.edited->lights[0].intensity = vec3(4);
  CHECK(b.failure(b.source).empty());
  CHECK(load(b.source).lights[0].intensity == vec3(4));
  // Meanwhile another program writes it.
  json doc = json::parse(read_file(b.source));
  doc["asset"]["generator"] = "another";
  write(b.source, doc.dump());
  b.request.written = b.result.written;
  CHECK_THAT(b.failure(b.source), Contains("the file has changed on disk since it was opened or saved here"));
  CHECK(json::parse(read_file(b.source)) == doc);
  b.request.replace = true;
  CHECK(b.failure(b.source).empty());
  // A .glb whose geometry is gone.
  Bench glb(room(), "a.glb");
  Asset other;
  other.triangle(), other.triangle();
  other.glb(glb.folder, "a.glb");
  CHECK_THAT(glb.failure(glb.folder / "c.glb"), Contains("its geometry is no longer there"));
}

TEST_CASE("damaged extras are refused or ignored where they stand") {
  const auto with = [](const json& own) {
    Asset a = room();
    for (json& node : a.doc["nodes"])
      if (node.contains("extras")) node["extras"]["lucerna"] = own;
    return failure(a);
  };
  CHECK(with({{"enabled", false}}).empty());
  CHECK(with({{"enabled", false}, {"off_intensity", {1, 2, 3}}}).empty());
  CHECK_THAT(with({{"enabled", false}, {"off_intensity", {1, -2, 3}}}),
             Contains("extras.lucerna.off_intensity") && Contains("-2 is not positive and finite"));
  CHECK_THAT(with({{"enabled", "no"}}), Contains("extras.lucerna.enabled: expected true or false"));
  const json sun{{"date", "2024-06-31"}, {"time", 12}, {"latitude", 1}, {"longitude", 2}};
  CHECK_THAT(with({{"sun", sun}}), Contains("extras.lucerna.sun: there is no date 2024-06-31"));
  Asset a = room();
  a.doc["scenes"][0]["extras"]["lucerna"]["environment"] = {
      {"sky", {{"kind", "starry"}, {"to_sun", {0, 1, 0}}}}};
  CHECK_THAT(failure(a), Contains("extras.lucerna.environment.sky.kind: 'starry', expected preetham"));
  a.doc["scenes"][0]["extras"]["lucerna"]["environment"] = {
      {"sky", {{"kind", "preetham"}, {"turbidity", 99}, {"to_sun", {0, 1, 0}}}}};
  CHECK_THAT(failure(a), Contains("the turbidity is 99"));
  a.doc["scenes"][0]["extras"]["lucerna"]["environment"] = {
      {"sky", {{"kind", "preetham"}, {"to_sun", {0, 1, 0}}, {"unit", "nit"}}}};
  CHECK_THAT(failure(a), Contains("sky.unit: 'nit', expected cd/m2 or kcd/m2"));
  a.doc["scenes"][0]["extras"]["lucerna"] = {{"settings", {{"film.ev", json::array()}}}};
  CHECK_THAT(failure(a), Contains("extras.lucerna.settings.film.ev: expected a number"));
}

}  // namespace scene_save_tests
