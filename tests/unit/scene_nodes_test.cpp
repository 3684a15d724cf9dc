// links: scene_io
// Placement: hierarchy, instances, cameras, lights, environment, settings; and the description of a scene.
#include <cmath>

#include "unit/scene_support.h"

namespace scene_nodes_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using scene::Scene;

namespace {

bool close(const vec3& a, const vec3& b, float tolerance = 1e-5f) { return glm::length(a - b) < tolerance; }
vec3 at(const mat4& m, const vec3& p) { return vec3(m * vec4(p, 1)); }

const json k_quarter_about_z{0, 0, std::sqrt(0.5), std::sqrt(0.5)};

Asset with_light(const json& light, const json& node = json::object()) {
  Asset asset;
  asset.triangle();
  asset.doc["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.doc["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  json n = node;
  n["extensions"]["KHR_lights_punctual"]["light"] = 0;
  asset.doc["scenes"][0]["nodes"].push_back(asset.add("nodes", n));
  return asset;
}

Asset with_camera(const json& camera, const json& node = json::object()) {
  Asset asset;
  json n = node;
  n["camera"] = asset.add("cameras", camera);
  asset.doc["scenes"][0]["nodes"].push_back(asset.add("nodes", n));
  return asset;
}

}  // namespace

TEST_CASE("translation, rotation, scale and matrices multiply down the hierarchy") {
  Asset asset;
  asset.triangle({{"name", "leaf"}, {"translation", {1, 0, 0}}, {"scale", {2, 2, 2}}});
  const int middle = asset.add("nodes", {{"rotation", k_quarter_about_z}, {"children", {0}}});
  const int top = asset.add(
      "nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1}}, {"children", {middle}}});
  asset.doc["scenes"][0]["nodes"] = {top};
  const Scene scene = asset.load();
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].name == "leaf");
  CHECK_FALSE(scene.instances[0].flipped);
  // (1, 0, 0) -> scaled (2, 0, 0) -> moved (3, 0, 0) -> rotated (0, 3, 0) -> moved (10, 23, 30)
  CHECK(close(at(scene.instances[0].to_world, {1, 0, 0}), {10, 23, 30}));
  const Box box = scene::bounds(scene);
  CHECK(close(box.lo, {8, 21, 30}));
  CHECK(close(box.hi, {10, 23, 30}));
}

TEST_CASE("a mesh in several nodes is one mesh with several instances; a mirrored one is flipped") {
  Asset asset;
  asset.triangle();
  asset.doc["scenes"][0]["nodes"] = {0, asset.add("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}}),
                                     asset.add("nodes", {{"mesh", 0}, {"scale", {-1, -1, 1}}})};
  const Scene scene = asset.load();
  CHECK(scene.meshes.size() == 1);
  REQUIRE(scene.instances.size() == 3);
  CHECK(scene::count_triangles(scene) == 3);
  CHECK_FALSE(scene.instances[0].flipped);
  CHECK(scene.instances[1].flipped);
  CHECK_FALSE(scene.instances[2].flipped);
}

TEST_CASE("the default scene is shown") {
  Asset asset;
  asset.triangle({{"name", "first"}});
  asset.triangle({{"name", "second"}});
  asset.doc["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  CHECK(asset.load().instances.at(0).name == "first");
  asset.doc["scene"] = 1;
  const Scene scene = asset.load();
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].name == "second");
  CHECK(scene.meshes.size() == 1);
  asset.doc.erase("scene");
  asset.doc.erase("scenes");
  CHECK(asset.load().instances.size() == 2);  // without scenes, all roots
}

TEST_CASE("EXT_mesh_gpu_instancing") {
  Asset asset;
  asset.triangle({{"translation", {0, 0, 5}}});
  json attributes;
  attributes["TRANSLATION"] = asset.accessor<float>("VEC3", {1, 0, 0, 0, 2, 0});
  attributes["ROTATION"] = asset.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 23170, 23170}, true);
  attributes["SCALE"] = asset.accessor<float>("VEC3", {1, 1, 1, 3, 3, -3});
  asset.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  const Scene scene = asset.load();
  REQUIRE(scene.instances.size() == 2);
  CHECK(close(at(scene.instances[0].to_world, {1, 0, 0}), {2, 0, 5}));
  CHECK(close(at(scene.instances[1].to_world, {1, 0, 1}), {0, 5, 2}, 1e-3f));
  CHECK_FALSE(scene.instances[0].flipped);
  CHECK(scene.instances[1].flipped);
  CHECK(scene.meshes.size() == 1);

  // An instance of size zero is hidden, with a rotation or without.
  json& given = asset.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  given["SCALE"] = asset.accessor<float>("VEC3", {1, 1, 1, 0, 0, 0});
  given["ROTATION"] = asset.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, 0, 0});
  const Scene one = asset.load();
  REQUIRE(one.instances.size() == 1);
  CHECK(one.instances[0].name == "node 0 #0");
  CHECK(warnings_with(one,
                      "1 meshes in nodes or instances of scale 0: left out (nodes[0].extensions."
                      "EXT_mesh_gpu_instancing, instance 1)") == 1);
}

TEST_CASE("cameras") {
  const Scene scene = with_camera({{"name", "eye"},
                                   {"type", "perspective"},
                                   {"perspective", {{"yfov", 0.5}, {"aspectRatio", 1.5}, {"znear", 0.1}}}},
                                  {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}})
                          .load();
  REQUIRE(scene.cameras.size() == 1);
  const scene::Camera& camera = scene.cameras[0];
  CHECK(camera.name == "eye");
  CHECK_FALSE(camera.orthographic);
  CHECK(camera.yfov == 0.5f);
  CHECK(camera.aspect == 1.5f);
  CHECK(close(vec3(camera.to_world[3]), {1, 2, 3}));
  CHECK(close(vec3(camera.to_world[2]), {0, 0, 1}));  // no scale

  const Scene flat = with_camera({{"type", "orthographic"},
                                  {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}},
                                 {{"name", "plan"}})
                         .load();
  CHECK(flat.cameras.at(0).orthographic);
  CHECK(flat.cameras[0].name == "plan");
  CHECK(flat.cameras[0].xmag == 4);
  CHECK(flat.cameras[0].ymag == 2);
}

TEST_CASE("a camera's lens is read from its extras, and an invalid one leaves a pinhole") {
  const auto loaded = [](const json& own) {
    return with_camera({{"type", "perspective"},
                        {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}},
                        {"extras", {{"lucerna", own}}}})
        .load();
  };
  const Scene scene = loaded(
      {{"f_number", 2.8}, {"focus_distance", 1.5}, {"aperture_blades", 6}, {"aperture_rotation", 0.25}});
  CHECK(scene.cameras.at(0).lens ==
        scene::Lens{.f_number = 2.8f, .focus_distance = 1.5f, .blades = 6, .rotation = 0.25f});
  CHECK(loaded({{"unknown", 1}}).cameras.at(0).lens == scene::Lens{});
  for (const auto& [own, why] :
       {std::pair<json, std::string>{{{"f_number", 0}, {"focus_distance", 1}}, "f_number: 0 is not above 0"},
        {{{"f_number", 2}}, "its plane of focus is 0 m ahead"},
        {{{"f_number", 2}, {"focus_distance", -1}}, "its plane of focus is -1 m ahead"},
        {{{"f_number", "wide"}}, "expected a number"},
        {{{"f_number", 2}, {"focus_distance", 1}, {"aperture_blades", 2}},
         "aperture_blades: 2 is neither 0"}}) {
    INFO(own.dump());
    const Scene pinhole = loaded(own);
    CHECK(pinhole.cameras.at(0).lens.f_number == 0);
    CHECK(warnings_with(pinhole, "1 lenses of cameras that cannot be used: pinholes instead") == 1);
    CHECK(warnings_with(pinhole, why) == 1);
  }
}

TEST_CASE("an invalid camera does not prevent a scene from loading") {
  const auto left_out = [](const json& camera, const std::string& why) {
    Asset asset = with_camera(camera);
    asset.triangle();
    const Scene scene = asset.load();
    CHECK(scene.cameras.empty());
    CHECK(scene.instances.size() == 1);
    CHECK(warnings_with(scene, "1 cameras that cannot be used: left out") == 1);
    CHECK(warnings_with(scene, why) == 1);
  };
  left_out({{"type", "perspective"}, {"perspective", {{"yfov", 0}}}},
           "cameras[0].perspective.yfov: 0 is not above 0");
  left_out({{"type", "perspective"}, {"perspective", {{"yfov", "wide"}}}}, "expected a number");
  left_out({{"type", "fisheye"}}, "cameras[0].type: 'fisheye', expected perspective or orthographic");
  left_out({{"type", "orthographic"}}, "cameras[0]: 'orthographic' is missing");
  left_out({{"type", "orthographic"}, {"orthographic", {{"xmag", 0}, {"ymag", 1}}}},
           "cameras[0].orthographic.xmag: 0 is not other than 0");
}

TEST_CASE("a camera is found by its name, or by its number from 1") {
  const auto camera = [](const char* name, double yfov) {
    return json{{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}};
  };
  Asset asset = with_camera(camera("cam", 0.5));
  for (const auto& [name, yfov] : {std::pair("cam", 0.25), std::pair("1", 0.75)})
    asset.doc["scenes"][0]["nodes"].push_back(
        asset.add("nodes", {{"camera", asset.add("cameras", camera(name, yfov))}}));
  const Scene scene = asset.load();
  CHECK(scene::find_camera(scene, "cam").yfov == 0.5f);
  CHECK(scene::find_camera(scene, "2").yfov == 0.25f);
  CHECK(scene::find_camera(scene, "1").yfov == 0.75f);  // a name takes precedence over a number
  CHECK(scene::starting_camera(scene, "3").yfov == 0.75f);
  for (const char* none : {"0", "4", "-1", "2.5", "2 ", "99999999999999999999"})
    CHECK_THROWS_WITH(scene::find_camera(scene, none), Contains("it has 'cam', 'cam', '1'"));
}

TEST_CASE("negative xmag and ymag mirror the picture") {
  const json plan{{"type", "orthographic"},
                  {"orthographic", {{"xmag", -4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}};
  Scene scene = with_camera(plan).load();
  REQUIRE(scene.cameras.size() == 1);
  CHECK(scene.cameras[0].xmag == 4);
  CHECK(scene.cameras[0].aspect == 2);
  CHECK(close(vec3(scene.cameras[0].to_world[0]), {-1, 0, 0}));
  CHECK(close(vec3(scene.cameras[0].to_world[1]), {0, 1, 0}));
  CHECK(warnings_with(scene, "1 cameras with a negative xmag or ymag") == 1);
}

TEST_CASE("the default camera sees the whole scene") {
  Asset asset;
  asset.triangle({{"translation", {100, 50, 0}}, {"scale", {30, 30, 30}}});
  const Scene scene = asset.load();
  CHECK(scene.cameras.empty());
  const scene::Camera camera = scene::default_camera(scene);
  const mat4 to_camera = glm::inverse(camera.to_world);
  for (const vec3& p : scene.meshes[0].primitives[0].positions) {
    const vec3 q = at(to_camera, at(scene.instances[0].to_world, p));
    CHECK(q.z < 0);
    CHECK(std::abs(q.x / q.z) < std::tan(0.5f * camera.yfov));
    CHECK(std::abs(q.y / q.z) < std::tan(0.5f * camera.yfov));
  }
}

TEST_CASE("punctual lights") {
  Scene scene =
      with_light(
          {{"name", "lamp"}, {"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 3}},
          {{"translation", {1, 2, 3}}})
          .load();
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == scene::LightKind::point);
  CHECK(scene.lights[0].name == "lamp");
  CHECK(scene.lights[0].intensity == vec3(10, 5, 0));
  CHECK(scene.lights[0].position == vec3(1, 2, 3));
  CHECK(scene.warnings.empty());  // the range is ignored without a warning

  // A quarter turn about x takes -Z to +Y.
  scene = with_light(
              {{"type", "directional"}},
              {{"name", "sun"}, {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}, {"scale", {2, 2, 2}}})
              .load();
  CHECK(scene.lights.at(0).kind == scene::LightKind::directional);
  CHECK(scene.lights[0].name == "sun");
  CHECK(scene.lights[0].intensity == vec3(1));
  CHECK(close(scene.lights[0].direction, {0, 1, 0}));

  scene =
      with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}).load();
  CHECK(scene.lights.at(0).inner_cone == 0.25f);
  CHECK(scene.lights[0].outer_cone == 0.5f);
  CHECK(close(scene.lights[0].direction, {0, 0, -1}));
  scene = with_light({{"type", "spot"}}).load();
  CHECK(scene.lights.at(0).inner_cone == 0);
  CHECK(scene.lights[0].outer_cone == Approx(k_pi / 4));

  scene = with_light(
              {{"type", "spot"}, {"intensity", -1}, {"spot", {{"innerConeAngle", 2}, {"outerConeAngle", 3}}}})
              .load();
  CHECK(scene.lights.at(0).outer_cone == Approx(k_pi / 2));
  CHECK(scene.lights[0].inner_cone == scene.lights[0].outer_cone);
  CHECK(scene.lights[0].intensity == vec3(0));
  CHECK(scene.warnings.size() == 2);
  CHECK_THAT(failure(with_light({{"type", "laser"}})),
             Contains("extensions.KHR_lights_punctual.lights[0].type: 'laser'"));
}

TEST_CASE("environment in the scene's extras") {
  TempFolder folder;
  Asset asset;
  asset.triangle();
  write_image<float>(folder / "sky.exr", 2, 1, 3, {1, 2, 3, 4, 5, 6});
  json& environment = asset.doc["scenes"][0]["extras"]["environment"];
  environment = {{"type", "equirectangular"},
                 {"file", "sky.exr"},
                 {"scale", 2.5},
                 {"rotation", 30},
                 {"mapping", "any words"}};
  Scene scene = scene::load(asset.gltf(folder));
  REQUIRE(scene.environment.image != scene::k_none);
  CHECK(scene.images[scene.environment.image].floats == std::vector<float>{1, 2, 3, 1, 4, 5, 6, 1});
  CHECK(scene.environment.scale == 2.5f);
  CHECK(scene.environment.rotation == 30);
  CHECK(scene.environment.file == "sky.exr");

  environment = {{"radiance", {1, 2, 3}}, {"mood", "dark"}};
  scene = scene::load(asset.gltf(folder));
  CHECK(scene.environment.image == scene::k_none);
  CHECK(scene.environment.radiance == vec3(1, 2, 3));

  environment = {{"type", "none"}};
  scene = scene::load(asset.gltf(folder));
  CHECK(scene.environment.radiance == vec3(0));
  CHECK(warnings_with(scene, "neither 'file' nor 'radiance'") == 1);

  // An 8-bit picture is decoded as sRGB.
  write_image<uint8_t>(folder / "sky.png", 1, 1, 3, {255, 188, 0});
  environment = {{"file", "sky.png"}};
  scene = scene::load(asset.gltf(folder));
  CHECK(scene.images[scene.environment.image].floats[0] == Approx(1));
  CHECK(scene.images[scene.environment.image].floats[1] == Approx(0.5029).margin(1e-3));
}

TEST_CASE("settings.json: its environment overrides the file's, the rest becomes settings in order") {
  TempFolder folder;
  Asset asset;
  asset.triangle();
  asset.doc["scenes"][0]["extras"]["environment"] = {{"file", "is-not-even-looked-for.exr"}};
  const std::filesystem::path file = asset.gltf(folder);
  write(folder / "settings.json",
        R"({"samples": 64, "components": {"primary": "off", "caustic": "path"}, "film.ev": -1.5,
            "environment": {"radiance": [0.5, 0.25, 0], "scale": 2}, "show": {"primary": true}, "camera": "main"})");
  Scene scene = scene::load(file);
  CHECK(scene.environment.radiance == vec3(0.5f, 0.25f, 0));
  CHECK(scene.environment.scale == 2);
  using Settings = std::vector<std::pair<std::string, std::string>>;
  CHECK(scene.settings == Settings{{"samples", "64"},
                                   {"components.primary", "off"},
                                   {"components.caustic", "path"},
                                   {"film.ev", "-1.5"},
                                   {"show.primary", "true"},
                                   {"camera", "main"}});

  write(folder / "settings.json", R"({"samples": 1})");
  CHECK_THAT(failure(file), Contains("extras.environment.file"));  // nothing overrides it now
  scene::LoadOptions options;
  options.settings = false;
  asset.doc["scenes"][0].erase("extras");
  CHECK(scene::load(asset.gltf(folder), options).settings.empty());
}

TEST_CASE("progress is reported in order and can cancel") {
  TempFolder folder;
  Asset asset;
  asset.triangle();
  const std::filesystem::path file = asset.gltf(folder);
  std::vector<float> reported;
  scene::load(file, {}, [&](float fraction, const std::string& what) {
    CHECK_FALSE(what.empty());
    reported.push_back(fraction);
    return true;
  });
  CHECK(std::is_sorted(reported.begin(), reported.end()));
  CHECK(reported.front() == 0);
  CHECK(reported.back() == 1);
  for (size_t stop = 0; stop < reported.size(); ++stop) {
    size_t calls = 0;
    CHECK_THROWS_AS(scene::load(file, {}, [&](float, const std::string&) { return calls++ != stop; }),
                    scene::Cancelled);
    CHECK(calls == stop + 1);
  }
}

TEST_CASE("animations are listed and ignored") {
  Asset asset;
  asset.triangle();
  asset.doc["animations"] = {json::object(), json::object()};
  CHECK(warnings_with(asset.load(), "2 animations are ignored") == 1);
}

TEST_CASE("a description lists the contents of a scene") {
  TempFolder folder;
  write_image<uint8_t>(folder / "i.png", 4, 2, 3, std::vector<uint8_t>(24, 9));
  Asset asset = with_light({{"type", "point"}, {"intensity", 3}});
  asset.textured_triangle(
      {{"name", "pane"}, {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", "i.png"}})}});
  asset.textured_triangle(
      {{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", texture}}}});
  asset.doc["extensionsUsed"].push_back("EXT_never");
  const Scene scene = scene::load(asset.gltf(folder));
  const nlohmann::ordered_json d = scene::describe(scene);
  CHECK(d["triangles"] == 3);
  CHECK(d["emissive_triangles"] == 1);
  CHECK(d["vertices"] == 9);
  CHECK(d["instances"] == 3);
  CHECK(d["meshes"] == 3);
  REQUIRE(d["materials"].size() == 3);
  CHECK(d["materials"][1]["name"] == "pane");
  CHECK(d["materials"][1]["kind"] == "glass, thin wall");
  CHECK_THAT(d["materials"][2]["kind"].get<std::string>(), Contains("emitter"));
  CHECK(d["images"][0]["width"] == 4);
  CHECK(d["image_bytes"] == 32);
  CHECK(d["lights"][0]["kind"] == "point");
  CHECK(d["environment"].is_null());
  CHECK(d["unknown_extensions"][0] == "EXT_never");
  CHECK(d["bounds"]["hi"][0] == 1);
  CHECK(d["warnings"].size() == 1);
  const std::string text = scene::describe_text(scene);
  for (const char* word : {"triangles    3 (1 emissive)", "pane: glass, thin wall", "i.png: 4 x 2", "point",
                           "EXT_never", "warning"})
    CHECK_THAT(text, Contains(word));
}

}  // namespace scene_nodes_tests
