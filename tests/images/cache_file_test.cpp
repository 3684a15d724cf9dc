// links: session
// Cache files through the renderer: a loaded cache gives bit for bit the picture of the saved one. A file
// that does not fit is refused, and the refusal loses nothing.
#include <catch2/catch.hpp>
#include <filesystem>

#include "base/file.h"
#include "images/cache_support.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace cache_file_tests {

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

TEST_CASE("a loaded cache gives the picture of the saved one, bit for bit, without gathering") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", again = folder.path / "b.cache";
  Bed first;
  const film::Image picture = first.finish();
  first.r.solvers().save("cache", file);
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
  CHECK(second.r.progress().ledger().entries().back().prepared_rays == 0);
  // Saving it again gives the same file.
  second.r.solvers().save("cache", again);
  CHECK(read_file(again) == read_file(file));

  // Loading replaces a cache that is being built.
  second.set({{"seed", "5"}});
  second.r.step();
  CHECK_FALSE(test::cache(second.r)->ready());
  second.set({{"seed", "0"}});
  second.r.step();
  second.r.solver_load("cache", file);
  CHECK(identical(picture, second.finish()));
}

TEST_CASE("a loaded cache can be extended: another view adds records, and all saved records stay") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  Bed first;
  first.finish();
  first.r.solvers().save("cache", file);
  const irradiance_cache::RawRecords saved = first.records();
  const uint64_t rays = first.status().rays;
  first.r.choose_camera("above");
  const film::Image moved = first.finish();

  Bed second;
  second.r.choose_camera("above");
  second.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(second.r)->ready());
  // The result equals moving the camera in the session that saved the file.
  CHECK(identical(moved, second.finish()));
  CHECK(test::keeps_places(test::lit(second.records()), test::lit(saved)));
  CHECK(begins_with(test::lit(second.records()).lights, test::lit(saved).lights));
  CHECK(second.records().size() > saved.size());
  CHECK(second.status().loaded == saved.size());
  CHECK(second.status().rays > rays);
  CHECK(second.status().rays == first.status().rays);

  // The build settings have changed, so the cache searches for gaps again. Another seed is accepted.
  Bed third;
  for (const Settings& change : {Settings{{"cache.stop", "0"}}, Settings{{"seed", "3"}}}) {
    INFO(change.begin()->first);
    third.set(change);
    third.r.solver_load("cache", file);
    CHECK_FALSE(test::cache(third.r)->ready());
    third.finish();
    CHECK(begins_with(third.records(), saved));
  }
  // Components that are not looked up are not loaded.
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
  // A search over the view that the file was built for finds (almost) no gaps.
  Bed looked;
  looked.set({{"cache.stop", "0.0021"}});
  looked.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(looked.r)->ready());
  looked.finish();
  CHECK(looked.records().size() <= saved.size() + saved.size() / 33);
  // Sampling settings do not invalidate the cache.
  Bed fourth;
  fourth.set({{"sampling.mode", "adaptive"}, {"samples", "9"}, {"film.ev", "2"}});
  fourth.r.solver_load("cache", file);
  CHECK(test::cache(fourth.r)->ready());

  // A cache that stopped at its record limit continues with a higher limit.
  Bed narrow;
  narrow.set({{"cache.max_records", "100"}});
  narrow.finish();
  narrow.r.solvers().save("cache", file);
  REQUIRE(narrow.status().stop == irradiance_cache::StopReason::records);
  narrow.r.solver_load("cache", file);
  CHECK(test::cache(narrow.r)->ready());
  Bed wide;
  wide.r.solver_load("cache", file);
  CHECK_FALSE(test::cache(wide.r)->ready());
  wide.finish();
  CHECK(wide.records().size() > 100);
}

TEST_CASE("a file that does not fit is refused, and picture and records stay") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache", broken = folder.path / "broken.cache";
  Bed first;
  first.finish();
  first.r.solvers().save("cache", file);
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
  // The records still belong to this view.
  bed.r.restart();
  CHECK(identical(picture, bed.finish()));

  // A failed save keeps the existing file.
  CHECK_THROWS_WITH(bed.r.solvers().save("cache", folder.path / "no" / "a.cache"),
                    Contains("cannot be written"));

  // Tertiary light was gathered differently: from records instead of paths, or the reverse.
  Bed paths(Settings{{"components.secondary", "cache"}});
  CHECK(paths.refusal(file) ==
        file.string() +
            ": the tertiary light of its records was gathered by 'cache', here it is by 'path'; set "
            "components.tertiary cache");
  paths.finish();
  const fs::path other = folder.path / "paths.cache";
  paths.r.solvers().save("cache", other);
  CHECK(paths.refusal(other).empty());
  CHECK_THAT(bed.refusal(other), Contains("was made with") || Contains("were made with"));
  CHECK_THAT(first.refusal(other), Contains("gathered by 'path', here it is by 'cache'"));
  // Without lookups of tertiary light this makes no difference.
  paths.set({{"components.tertiary", "off"}});
  CHECK(paths.refusal(file).empty());

  // The file lacks a component.
  Bed caustic(Settings{{"components.tertiary", "cache"}});
  CHECK_THAT(caustic.refusal(file), Contains("its records hold secondary, tertiary light; the looked-up "
                                             "components also need caustic light"));
  // The file has more records than the limit.
  const uint32_t count = first.records().size();
  Bed narrow;
  narrow.set({{"cache.max_records", std::to_string(count - 1)}});
  CHECK_THAT(narrow.refusal(file), Contains(fmt::format("holds {} records, but the limit is {}; set "
                                                        "cache.max_records to {} or more",
                                                        count, count - 1, count)));
  narrow.set({{"cache.max_records", std::to_string(count)}});
  CHECK(narrow.refusal(file).empty());
}

TEST_CASE("a cache belongs to its scene and lighting; without a built cache there is nothing to save") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  session::Renderer empty(test::renderer_options(false));
  CHECK_THROWS_WITH(empty.solvers().save("cache", file), Contains("load a scene first"));
  CHECK_THROWS_WITH(empty.solver_load("cache", file), Contains("load the scene first"));

  Bed bed;
  CHECK_THROWS_WITH(bed.r.solvers().save("cache", file),
                    Contains("still being built (pass 1, 0 records so far)"));
  CHECK_FALSE(fs::exists(file));
  bed.finish();
  bed.r.solvers().save("cache", file);
  CHECK(bed.refusal(file).empty());

  // Light edits, and their undo.
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
  CHECK_THROWS_WITH(plain.r.solvers().save("cache", file), Contains("no component is computed by 'cache'"));
}

TEST_CASE("the cache of a scene without diffuse surfaces can be saved and loaded") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  scene::Scene mirrors = test::block_room();
  mirrors.materials[0].metallic = 1, mirrors.materials[0].roughness = 0.1f;
  Bed first(k_cached, mirrors);
  const film::Image picture = first.finish();
  REQUIRE(test::cache(first.r)->records().size() == 0);
  first.r.solvers().save("cache", file);
  Bed second(k_cached, mirrors);
  second.r.solver_load("cache", file);
  CHECK(test::cache(second.r)->ready());
  CHECK(identical(picture, second.finish()));
}

}  // namespace cache_file_tests
