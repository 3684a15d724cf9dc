// links: session
// Caches as files, through the renderer: a loaded one shows the picture of the one that was saved, bit for
// bit; what does not fit is refused, and nothing is lost by that.
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>

#include "base/file.h"
#include "support/folder.h"
#include "support/render.h"

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;

namespace {

using Settings = std::map<std::string, std::string>;
const Settings k_both{{"components.secondary", "cache"}, {"components.tertiary", "cache"}};

/// A closed room of four metres with a block in it, lit by a lamp under its ceiling; two cameras.
scene::Scene room() {
  scene::Scene s;
  s.name = "room", s.file = "room.gltf";
  s.materials.resize(1);
  s.materials[0].base_color = vec4(0.7f, 0.6f, 0.5f, 1);
  s.materials[0].roughness = 1, s.materials[0].metallic = 0, s.materials[0].specular = 0;
  const auto box = [&](vec3 lo, vec3 hi) {
    scene::Primitive p;
    for (int k = 0; k < 8; ++k)
      p.positions.emplace_back(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z);
    for (const auto& [a, b, c, d] : {std::array{0u, 1u, 3u, 2u},
                                     {4u, 6u, 7u, 5u},
                                     {0u, 2u, 6u, 4u},
                                     {1u, 5u, 7u, 3u},
                                     {0u, 4u, 5u, 1u},
                                     {2u, 3u, 7u, 6u}})
      p.triangles.emplace_back(a, b, c), p.triangles.emplace_back(a, c, d);
    s.meshes.push_back({"box", {p}});
    s.instances.push_back({"box", scene::Id(s.meshes.size() - 1), mat4(1), false});
  };
  box({-2, 0, -2}, {2, 2.5f, 2});
  box({-0.5f, 0, -1}, {0.5f, 1, 0});
  s.lights.push_back({.name = "lamp", .intensity = vec3(5), .position = {1, 2, 1}});
  for (const vec3 eye : {vec3(0, 1.5f, 1.9f), vec3(-1, 2.2f, -1)}) {
    scene::Camera c;
    c.name = s.cameras.empty() ? "front" : "above";
    c.yfov = 1.3f;
    c.to_world[3] = vec4(eye, 1);
    s.cameras.push_back(c);
  }
  // The second looks down.
  s.cameras[1].to_world[1] = vec4(0, 0, -1, 0), s.cameras[1].to_world[2] = vec4(0, 1, 0, 0);
  s.environment.given = true;
  return s;
}

struct Bed {
  session::Renderer r;
  explicit Bed(const Settings& settings = k_both, const scene::Scene& scene = room())
      : r({.device = "cpu", .validation = true, .shaders = {}, .defines = {}}) {
    r.set_size(32, 32);
    r.set_scene(std::make_shared<scene::Scene>(scene));
    r.settings().set("samples", "4");
    r.settings().set("path.batch", "8192");
    r.settings().set("cache.max_records", "5000");
    set(settings);
  }
  ~Bed() { CHECK(r.device().validation_messages() == 0); }
  void set(const Settings& settings) {
    for (const auto& [key, value] : settings) r.settings().set(key, value);
    r.apply_settings();
  }
  film::Image finish() {
    while (r.step()) {
    }
    return r.image();
  }
  std::string refusal(const fs::path& file) {
    try {
      r.load_cache(file);
    } catch (const Error& e) {
      CHECK(e.where() == file.string());
      return e.what();
    }
    return "";
  }
};

bool same(const film::Image& a, const film::Image& b) {
  for (size_t c = 0; c < a.components.size(); ++c)
    if (a.components[c].size() != b.components[c].size() ||
        std::memcmp(a.components[c].data(), b.components[c].data(), a.components[c].size() * sizeof(vec3)))
      return false;
  return a.samples == b.samples;
}

/// Whether the first records of `all` are `some`, to the bit.
bool begins_with(const irradiance_cache::RawRecords& all, const irradiance_cache::RawRecords& some) {
  const auto begins = [](const std::vector<vec4>& a, const std::vector<vec4>& b) {
    return a.size() >= b.size() && std::memcmp(a.data(), b.data(), b.size() * sizeof(vec4)) == 0;
  };
  return begins(all.places, some.places) && begins(all.lights, some.lights) &&
         begins(all.spheres, some.spheres);
}

irradiance_cache::RawRecords records(const Bed& bed) {
  return bed.r.cache()->records().raw(bed.r.cache()->records().size());
}

}  // namespace

TEST_CASE("a loaded cache shows the picture of the one that was saved, to the bit, and gathers nothing") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", again = folder.path / "b.cache";
  Bed first;
  const film::Image picture = first.finish();
  first.r.save_cache(file);
  const irradiance_cache::RawRecords saved = records(first);
  const irradiance_cache::CacheStatus status = first.r.cache()->status();
  REQUIRE(saved.size() > 100);
  CHECK(status.loaded == 0);

  Bed second;
  second.r.load_cache(file);
  CHECK(second.r.cache()->ready());
  const film::Image shown = second.finish();
  CHECK(same(picture, shown));
  CHECK(begins_with(records(second), saved));
  CHECK(second.r.cache()->status().records == saved.size());
  CHECK(second.r.cache()->status().loaded == saved.size());
  CHECK(second.r.cache()->status().rays == status.rays);
  CHECK(second.r.cache()->status().stop == status.stop);
  CHECK(second.r.ledger().entries().back().prepared_rays == 0);
  // Saved again it is the same file.
  second.r.save_cache(again);
  CHECK(read_file(again) == read_file(file));

  // Over another cache, in the middle of its building: as if that had not been.
  second.set({{"seed", "5"}});
  second.r.step();
  CHECK_FALSE(second.r.cache()->ready());
  second.set({{"seed", "0"}});
  second.r.step();
  second.r.load_cache(file);
  CHECK(same(picture, second.finish()));
}

TEST_CASE("a loaded cache goes on: what another view is missing is added, and all that was saved stays") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  Bed first;
  first.finish();
  first.r.save_cache(file);
  const irradiance_cache::RawRecords saved = records(first);
  const uint64_t rays = first.r.cache()->status().rays;
  first.r.choose_camera("above");
  const film::Image moved = first.finish();

  Bed second;
  second.r.choose_camera("above");
  second.r.load_cache(file);
  CHECK_FALSE(second.r.cache()->ready());
  // The same as if the camera had been moved where it was made.
  CHECK(same(moved, second.finish()));
  CHECK(begins_with(records(second), saved));
  CHECK(records(second).size() > saved.size());
  CHECK(second.r.cache()->status().loaded == saved.size());
  CHECK(second.r.cache()->status().rays > rays);
  CHECK(second.r.cache()->status().rays == first.r.cache()->status().rays);

  // What is asked of the building has changed: it looks again. Another seed is no obstacle.
  Bed third;
  for (const Settings& change : {Settings{{"cache.stop", "0"}}, Settings{{"seed", "3"}}}) {
    INFO(change.begin()->first);
    third.set(change);
    third.r.load_cache(file);
    CHECK_FALSE(third.r.cache()->ready());
    third.finish();
    CHECK(begins_with(records(third), saved));
  }
  // Parts that nothing looks up are left behind.
  third.set({{"components.tertiary", "off"}});
  third.r.load_cache(file);
  CHECK_FALSE(third.r.cache()->ready());
  bool secondary = true, tertiary = false;
  for (const auto& record : third.r.cache()->records().read()) {
    secondary &= record.parts[shared::k_part_secondary].value != vec3(0);
    tertiary |= record.parts[shared::k_part_tertiary].value != vec3(0);
  }
  CHECK(secondary);
  CHECK_FALSE(tertiary);
  const film::Image without = third.finish();
  for (size_t i = 0; i < without.samples.size(); ++i) tertiary |= without.components[2][i] != vec3(0);
  CHECK_FALSE(tertiary);
  // Having looked at the view that it was made for, it has found (nearly) nothing.
  Bed looked;
  looked.set({{"cache.stop", "0.0021"}});
  looked.r.load_cache(file);
  CHECK_FALSE(looked.r.cache()->ready());
  looked.finish();
  CHECK(records(looked).size() <= saved.size() + saved.size() / 33);
  // How it is sampled has not changed.
  Bed fourth;
  fourth.set({{"sampling.mode", "adaptive"}, {"samples", "9"}, {"film.ev", "2"}});
  fourth.r.load_cache(file);
  CHECK(fourth.r.cache()->ready());

  // One that ended for want of room goes on where there is more.
  Bed narrow;
  narrow.set({{"cache.max_records", "100"}});
  narrow.finish();
  narrow.r.save_cache(file);
  REQUIRE(narrow.r.cache()->status().stop == irradiance_cache::StopReason::records);
  narrow.r.load_cache(file);
  CHECK(narrow.r.cache()->ready());
  Bed wide;
  wide.r.load_cache(file);
  CHECK_FALSE(wide.r.cache()->ready());
  wide.finish();
  CHECK(records(wide).size() > 100);
}

TEST_CASE("what does not fit is refused, and neither picture nor records are lost by it") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", broken = folder.path / "broken.cache";
  Bed first;
  first.finish();
  first.r.save_cache(file);
  const std::string bytes = read_file(file);

  Bed bed;
  bed.set({{"cache.error", "0.4"}, {"path.max_depth", "9"}});
  const film::Image picture = bed.finish();
  const irradiance_cache::RawRecords mine = records(bed);
  const uint64_t restarts = bed.r.restarts();
  CHECK_THAT(bed.refusal(file),
             Contains("its records were made with cache.error = 0.3 (now 0.4), path.max_depth = 64 (now 9)"));
  CHECK_THAT(bed.refusal(folder.path / "none.cache"), Contains("cannot be read"));
  for (const size_t length : {size_t{0}, size_t{9}, bytes.size() / 2, bytes.size() - 1}) {
    write_file(broken, bytes.substr(0, length));
    CHECK_THAT(bed.refusal(broken), Contains("cut short"));
  }
  std::string flipped = bytes;
  flipped[bytes.size() / 3] ^= 16;
  write_file(broken, flipped);
  CHECK_THAT(bed.refusal(broken), Contains("damaged: its checksum is"));
  CHECK(bed.r.restarts() == restarts);
  CHECK(bed.r.done());
  CHECK(bed.r.cache()->ready());
  CHECK(same(picture, bed.r.image()));
  CHECK(begins_with(records(bed), mine));
  CHECK(records(bed).size() == mine.size());
  // It still is the cache of this view.
  bed.r.restart();
  CHECK(same(picture, bed.finish()));

  // Neither is the file there when a new one cannot be written.
  CHECK_THROWS_WITH(bed.r.save_cache(folder.path / "no" / "a.cache"), Contains("cannot be written"));

  // Parts that it does not hold.
  Bed caustic(Settings{{"components.tertiary", "cache"}});
  CHECK_THAT(caustic.refusal(file), Contains("its records hold secondary, tertiary light; the components "
                                             "that are looked up need caustic light too"));
  // More than there is room for.
  const uint32_t count = records(first).size();
  Bed narrow;
  narrow.set({{"cache.max_records", std::to_string(count - 1)}});
  CHECK_THAT(narrow.refusal(file), Contains(fmt::format("holds {} records and there is room for {}; set "
                                                        "cache.max_records to {} or more",
                                                        count, count - 1, count)));
  narrow.set({{"cache.max_records", std::to_string(count)}});
  CHECK(narrow.refusal(file).empty());
}

TEST_CASE("a cache is of its scene as it is lit; without one, or before it is built, there is none to save") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  session::Renderer empty({.device = "cpu", .validation = false, .shaders = {}, .defines = {}});
  CHECK_THROWS_WITH(empty.save_cache(file), Contains("load a scene first"));
  CHECK_THROWS_WITH(empty.load_cache(file), Contains("load the scene first"));

  Bed bed;
  CHECK_THROWS_WITH(bed.r.save_cache(file), Contains("still being built (pass 1, 0 records so far)"));
  CHECK_FALSE(fs::exists(file));
  bed.finish();
  bed.r.save_cache(file);
  CHECK(bed.refusal(file).empty());

  // Edits of the light, and taking them back.
  scene::Light lamp = bed.r.scene()->lights[0];
  const scene::Light before = lamp;
  lamp.intensity.x = 4;
  bed.r.set_light(0, lamp);
  CHECK_THAT(bed.refusal(file), Contains("they differ in lights"));
  bed.r.set_environment(0.5f, 0);
  CHECK_THAT(bed.refusal(file), Contains("they differ in environment, lights"));
  bed.r.set_environment(1, 0);
  bed.r.set_light(0, before);
  CHECK(bed.refusal(file).empty());
  CHECK(bed.r.cache()->ready());

  scene::Scene other = room();
  other.name = "attic";
  other.instances[1].to_world[3].x = 0.1f;
  other.materials[0].base_color.x = 0.1f;
  Bed attic(k_both, other);
  CHECK_THAT(
      attic.refusal(file),
      Contains("records of another scene ('room', this is 'attic'): they differ in geometry, materials"));

  Bed plain(Settings{});
  CHECK_THAT(plain.refusal(file), Contains("no component is computed by 'cache'"));
  CHECK_THROWS_WITH(plain.r.save_cache(file), Contains("no component is computed by 'cache'"));
}

TEST_CASE("the cache of a scene without diffuse surfaces is saved and loaded like any other") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  scene::Scene mirrors = room();
  mirrors.materials[0].metallic = 1, mirrors.materials[0].roughness = 0.1f;
  Bed first(k_both, mirrors);
  const film::Image picture = first.finish();
  REQUIRE(first.r.cache()->records().size() == 0);
  first.r.save_cache(file);
  Bed second(k_both, mirrors);
  second.r.load_cache(file);
  CHECK(second.r.cache()->ready());
  CHECK(same(picture, second.finish()));
}
