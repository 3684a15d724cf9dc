// links: session
// Caches as files, through the renderer: a loaded one shows the picture of the one that was saved, bit for
// bit; what does not fit is refused, and nothing is lost by that.
#include <catch2/catch.hpp>
#include <filesystem>

#include "base/file.h"
#include "images/cache_support.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;
using test::begins_with, test::identical, test::k_cached, test::Settings;

namespace {

struct Bed : test::CacheRenderer {
  explicit Bed(const Settings& settings = k_cached, const scene::Scene& scene = test::block_room())
      : CacheRenderer(scene, 32) {
    r.settings().set("samples", "4");
    r.settings().set("cache.max_records", "5000");
    for (const auto& [key, value] : test::k_dense_records) r.settings().set(key, value);
    set(settings);
  }
  std::string refusal(const fs::path& file) {
    try {
      r.solver_load("cache", file);
    } catch (const Error& e) {
      CHECK(e.where() == file.string());
      return e.what();
    }
    return "";
  }
};

}  // namespace

TEST_CASE("a loaded cache shows the picture of the one that was saved, to the bit, and gathers nothing") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", again = folder.path / "b.cache";
  Bed first;
  const film::Image picture = first.finish();
  first.r.solver_save("cache", file);
  const irradiance_cache::RawRecords saved = first.records();
  const irradiance_cache::CacheStatus status = first.status();
  REQUIRE(saved.size() > 100);
  CHECK(status.loaded == 0);

  Bed second;
  second.r.solver_load("cache", file);
  CHECK(test::cache(second.r)->ready());
  const film::Image shown = second.finish();
  CHECK(identical(picture, shown));
  CHECK(begins_with(second.records(), saved));
  CHECK(second.status().records == saved.size());
  CHECK(second.status().loaded == saved.size());
  CHECK(second.status().rays == status.rays);
  CHECK(second.status().stop == status.stop);
  CHECK(second.r.ledger().entries().back().prepared_rays == 0);
  // Saved again it is the same file.
  second.r.solver_save("cache", again);
  CHECK(read_file(again) == read_file(file));

  // Over another cache, in the middle of its building: as if that had not been.
  second.set({{"seed", "5"}});
  second.r.step();
  CHECK_FALSE(test::cache(second.r)->ready());
  second.set({{"seed", "0"}});
  second.r.step();
  second.r.solver_load("cache", file);
  CHECK(identical(picture, second.finish()));
}

TEST_CASE("a loaded cache goes on: what another view is missing is added, and all that was saved stays") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  Bed first;
  first.finish();
  first.r.solver_save("cache", file);
  const irradiance_cache::RawRecords saved = first.records();
  const uint64_t rays = first.status().rays;
  first.r.choose_camera("above");
  const film::Image moved = first.finish();

  Bed second;
  second.r.choose_camera("above");
  second.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(second.r)->ready());
  // The same as if the camera had been moved where it was made.
  CHECK(identical(moved, second.finish()));
  CHECK(test::keeps_places(test::lit(second.records()), test::lit(saved)));
  CHECK(begins_with(test::lit(second.records()).lights, test::lit(saved).lights));
  CHECK(second.records().size() > saved.size());
  CHECK(second.status().loaded == saved.size());
  CHECK(second.status().rays > rays);
  CHECK(second.status().rays == first.status().rays);

  // What is asked of the building has changed: it looks again. Another seed is no obstacle.
  Bed third;
  for (const Settings& change : {Settings{{"cache.stop", "0"}}, Settings{{"seed", "3"}}}) {
    INFO(change.begin()->first);
    third.set(change);
    third.r.solver_load("cache", file);
    CHECK_FALSE(test::cache(third.r)->ready());
    third.finish();
    CHECK(begins_with(third.records(), saved));
  }
  // Parts that nothing looks up are left behind.
  third.set({{"components.tertiary", "off"}});
  third.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(third.r)->ready());
  bool secondary = true, tertiary = false;
  for (const auto& record : test::cache(third.r)->records().read()) {
    secondary &= record.crowded || record.parts[shared::k_part_secondary].value != vec3(0);
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
  looked.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(looked.r)->ready());
  looked.finish();
  CHECK(looked.records().size() <= saved.size() + saved.size() / 33);
  // How it is sampled has not changed.
  Bed fourth;
  fourth.set({{"sampling.mode", "adaptive"}, {"samples", "9"}, {"film.ev", "2"}});
  fourth.r.solver_load("cache", file);
  CHECK(test::cache(fourth.r)->ready());

  // One that ended for want of room goes on where there is more.
  Bed narrow;
  narrow.set({{"cache.max_records", "100"}});
  narrow.finish();
  narrow.r.solver_save("cache", file);
  REQUIRE(narrow.status().stop == irradiance_cache::StopReason::records);
  narrow.r.solver_load("cache", file);
  CHECK(test::cache(narrow.r)->ready());
  Bed wide;
  wide.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(wide.r)->ready());
  wide.finish();
  CHECK(wide.records().size() > 100);
}

TEST_CASE("what does not fit is refused, and neither picture nor records are lost by it") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", broken = folder.path / "broken.cache";
  Bed first;
  first.finish();
  first.r.solver_save("cache", file);
  const std::string bytes = read_file(file);

  Bed bed;
  bed.set({{"cache.error", "0.4"}, {"path.max_depth", "9"}});
  const film::Image picture = bed.finish();
  const irradiance_cache::RawRecords mine = bed.records();
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
  CHECK(test::cache(bed.r)->ready());
  CHECK(identical(picture, bed.r.image()));
  CHECK(begins_with(bed.records(), mine));
  CHECK(bed.records().size() == mine.size());
  // It still is the cache of this view.
  bed.r.restart();
  CHECK(identical(picture, bed.finish()));

  // Neither is the file there when a new one cannot be written.
  CHECK_THROWS_WITH(bed.r.solver_save("cache", folder.path / "no" / "a.cache"),
                    Contains("cannot be written"));

  // Tertiary light that was gathered otherwise: its records were read in the place of paths, or the reverse.
  Bed paths(Settings{{"components.secondary", "cache"}});
  CHECK(paths.refusal(file) ==
        file.string() +
            ": the tertiary light of its records was gathered by 'cache', here it is by 'path'; set "
            "components.tertiary cache");
  paths.finish();
  const fs::path other = folder.path / "paths.cache";
  paths.r.solver_save("cache", other);
  CHECK(paths.refusal(other).empty());
  CHECK_THAT(bed.refusal(other), Contains("was made with") || Contains("were made with"));
  CHECK_THAT(first.refusal(other), Contains("gathered by 'path', here it is by 'cache'"));
  // Where nothing reads it there is no difference.
  paths.set({{"components.tertiary", "off"}});
  CHECK(paths.refusal(file).empty());

  // Parts that it does not hold.
  Bed caustic(Settings{{"components.tertiary", "cache"}});
  CHECK_THAT(caustic.refusal(file), Contains("its records hold secondary, tertiary light; the components "
                                             "that are looked up need caustic light too"));
  // More than there is room for.
  const uint32_t count = first.records().size();
  Bed narrow;
  narrow.set({{"cache.max_records", std::to_string(count - 1)}});
  CHECK_THAT(narrow.refusal(file), Contains(fmt::format("holds {} records, but the limit is {}; set "
                                                        "cache.max_records to {} or more",
                                                        count, count - 1, count)));
  narrow.set({{"cache.max_records", std::to_string(count)}});
  CHECK(narrow.refusal(file).empty());
}

TEST_CASE("a cache is of its scene as it is lit; without one, or before it is built, there is none to save") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  session::Renderer empty(test::renderer_options(false));
  CHECK_THROWS_WITH(empty.solver_save("cache", file), Contains("load a scene first"));
  CHECK_THROWS_WITH(empty.solver_load("cache", file), Contains("load the scene first"));

  Bed bed;
  CHECK_THROWS_WITH(bed.r.solver_save("cache", file),
                    Contains("still being built (pass 1, 0 records so far)"));
  CHECK_FALSE(fs::exists(file));
  bed.finish();
  bed.r.solver_save("cache", file);
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
  CHECK(test::cache(bed.r)->ready());

  scene::Scene other = test::block_room();
  other.name = "attic";
  other.instances[1].to_world[3].x = 0.1f;
  other.materials[0].base_color.x = 0.1f;
  Bed attic(k_cached, other);
  CHECK_THAT(
      attic.refusal(file),
      Contains("records of another scene ('room', this is 'attic'): they differ in geometry, materials"));

  Bed plain(Settings{});
  CHECK_THAT(plain.refusal(file), Contains("no component is computed by 'cache'"));
  CHECK_THROWS_WITH(plain.r.solver_save("cache", file), Contains("no component is computed by 'cache'"));
}

TEST_CASE("the cache of a scene without diffuse surfaces is saved and loaded like any other") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  scene::Scene mirrors = test::block_room();
  mirrors.materials[0].metallic = 1, mirrors.materials[0].roughness = 0.1f;
  Bed first(k_cached, mirrors);
  const film::Image picture = first.finish();
  REQUIRE(test::cache(first.r)->records().size() == 0);
  first.r.solver_save("cache", file);
  Bed second(k_cached, mirrors);
  second.r.solver_load("cache", file);
  CHECK(test::cache(second.r)->ready());
  CHECK(identical(picture, second.finish()));
}
