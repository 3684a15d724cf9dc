// links: session
// What a change invalidates of an irradiance cache: every row of its table. A cache that is relit in place
// equals a cache built in that light.
#include <catch2/catch.hpp>
#include <set>

#include "images/cache_support.h"
#include "solvers/irradiance_cache/info.h"
#include "solvers/registry.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace cache_invalidation_tests {

using namespace lucerna;
using irradiance_cache::RawRecords;
using irradiance_cache::StopReason;
using scene::Change;
using test::begins_with, test::identical, test::Settings;

namespace {

const Settings k_base = test::dense_records({{"components.secondary", "cache"},
                                             {"components.tertiary", "cache"},
                                             {"cache.rays", "64"},
                                             // Positions and radii do not depend on the light.
                                             {"cache.irradiance_weight", "0"},
                                             {"cache.metric", "split-sphere"},
                                             {"cache.max_rays", "256"},
                                             {"cache.error", "0.6"},
                                             {"cache.max_records", "5000"},
                                             {"samples", "2"},
                                             {"path.batch", "8192"}});

scene::Scene room() { return test::block_room(true); }

struct Bed : test::CacheRenderer {
  explicit Bed(const Settings& more = {}, bool validated = false) : CacheRenderer(room(), 24, validated) {
    set(k_base);
    if (!more.empty()) set(more);
  }
  void set_lamp(vec3 intensity, bool enabled = true) {
    scene::Light lamp = r.scene()->lights[0];
    lamp.intensity = intensity, lamp.enabled = enabled;
    r.set_light(0, lamp);
  }
  void paint(uint32_t material, vec3 color, float metallic = 0, vec3 emission = vec3(0)) {
    scene::Material m = r.scene()->materials[material];
    m.base_color = vec4(color, 1), m.metallic = metallic, m.emission = emission;
    r.set_material(material, m);
  }
};

/// True if the first lit records of `all` are those of `some` bit for bit, except for their light. Their
/// radii may shrink where records have been added, which see nearer surfaces.
bool same_places(const RawRecords& all, const RawRecords& some) {
  if (all.size() == some.size() && !begins_with(all.spheres, some.spheres)) return false;
  return test::keeps_places(test::lit(all), test::lit(some));
}

double mean(const film::Image& image, int component) { return test::mean(image.components[component]); }

}  // namespace

TEST_CASE("every kind of change invalidates what its row says, and nothing else") {
  const test::Folder folder;
  const auto file = folder.path / "base.cache";
  Bed bed({}, true);
  bed.finish();
  bed.r.solvers().save("cache", file);
  const RawRecords base = bed.records();
  const uint64_t base_rays = bed.status().rays;
  REQUIRE(base.size() > 100);
  REQUIRE(bed.status().stop == StopReason::covered);

  // One change of each kind; settings get values that differ from k_base and from the defaults.
  const std::map<Change, std::function<void()>> edits{
      {Change::camera, [&] { bed.r.choose_camera("above"); }},
      {Change::size, [&] { bed.r.set_size(40, 24); }},
      {Change::lamp,
       [&] {
         bed.set_lamp({9, 2, 1});
       }},
      {Change::environment, [&] { bed.r.set_environment(2, 90); }},
      {Change::colour,
       [&] {
         bed.paint(1, {0.9f, 0.1f, 0.1f});
       }},
      {Change::material,
       [&] {
         bed.paint(1, {0.9f, 0.9f, 0.9f}, 1);
       }},
      {Change::shaders, [&] { bed.r.reload_shaders(); }},
      {Change::restart, [&] { bed.r.restart(); }},
  };
  const std::map<Change, std::function<void()>> undo{
      {Change::camera, [&] { bed.r.choose_camera("front"); }},
      {Change::size, [&] { bed.r.set_size(24, 24); }},
      {Change::lamp, [&] { bed.set_lamp(vec3(5)); }},
      {Change::environment, [&] { bed.r.set_environment(1, 0); }},
      {Change::colour, [&] { bed.r.set_material(1, room().materials[1]); }},
      {Change::material, [&] { bed.r.set_material(1, room().materials[1]); }},
  };
  const std::map<std::string_view, Settings> settings{
      {"components.", {{"components.primary", "off"}}},
      {"effects.", {{"effects.off", "point"}}},
      {"scene.", {{"scene.clay", "true"}}},
      {"samples", {{"samples", "3"}}},
      {"sampling.", {{"sampling.mode", "adaptive"}, {"sampling.max_samples", "64"}}},
      {"film.", {{"film.ev", "1"}, {"film.layer", "depth"}}},
      {"show.", {{"show.primary", "false"}}},
      {"preview.", {{"preview.filter", "off"}}},
      {"overlay.", {{"overlay.records", "true"}, {"overlay.overlap", "true"}}},
      {"relight.", {{"relight.enabled", "on"}, {"relight.layers", "true"}}},
      {"relight.presets", {{"relight.presets", "day = "}}},
      {"relight.layers", {{"relight.layers", "true"}}},
      {"about", {{"about", "nothing"}}},
      {"camera", {{"camera", "above"}}},
      {"tracer", {{"tracer", "host"}}},
      {"path.batch", {{"path.batch", "4096"}}},
      {"lights.", {{"lights.sampling", "power"}, {"lights.portals", "marked"}}},
      {"path.classes", {{"path.classes", "off"}}},
      {"path.", {}},  // no other setting of paths
      {"path.roulette_depth", {{"path.roulette_depth", "7"}}},
      {"path.max_depth", {{"path.max_depth", "5"}}},
      {"seed", {{"seed", "3"}}},
      {"cache.rays", {{"cache.rays", "256"}, {"cache.max_rays", "1024"}}},
      {"cache.max_rays", {{"cache.max_rays", "1024"}}},
      {"cache.noise", {{"cache.noise", "0.2"}}},
      {"cache.environment_threshold",
       {{"cache.environment_threshold", "20"}, {"components.primary", "cache"}}},
      {"cache.passes", {{"cache.passes", "3"}}},
      {"cache.stop", {{"cache.stop", "0.01"}}},
      {"cache.max_records", {{"cache.max_records", "6000"}}},
      {"cache.smooth", {{"cache.smooth", "false"}}},
      {"cache.branches", {{"cache.branches", "1"}}},
      {"cache.pause", {{"cache.pause", "stage"}}},
      {"cache.", {{"cache.error", "0.4"}}},
  };
  for (const solvers::ChangeRow& row : solvers::changes_of(irradiance_cache::info())) {
    const auto* edit = std::get_if<Change>(&row.change);
    const auto* head = std::get_if<std::string_view>(&row.change);
    INFO((edit ? "edit " + std::to_string(int(*edit)) : "setting " + std::string(*head)) << ": " << row.why);
    if (edit && *edit == Change::shape) continue;  // see below
    if (edit && *edit == Change::place) continue;  // some places go: objects_test.cpp
    if (head && settings.contains(*head) && settings.at(*head).empty()) continue;
    bed.r.solver_load("cache", file);
    REQUIRE(test::cache(bed.r)->ready());
    REQUIRE(begins_with(bed.records(), base));

    const auto take_back = [&] {
      if (edit) return undo.contains(*edit) ? undo.at(*edit)() : void();
      Settings before;
      for (const auto& [key, value] : settings.at(*head))
        before[key] = k_base.contains(key) ? k_base.at(key)
                      : key == "camera"    ? "front"
                                           : plan::find_option(key)->fallback;
      bed.set(before);
    };
    if (head) {
      REQUIRE(settings.contains(*head));
      bed.set(settings.at(*head));
    } else {
      REQUIRE(edits.contains(*edit));
      edits.at (*edit)();
    }
    const solvers::Invalidation& s = row.invalidates;
    CHECK(test::cache(bed.r)->ready() == !s.any());
    if (s.places) {
      CHECK(test::cache(bed.r)->records().size() == 0);
      CHECK(bed.status().rays == 0);
      take_back();
      continue;
    }
    CHECK(bed.status().relighting.records == (s.light ? base.size() : 0));
    CHECK(bed.status().records == (s.light ? 0 : base.size()));
    bed.finish();
    CHECK(test::cache(bed.r)->ready());
    const RawRecords now = bed.records();
    INFO(now.size() << " records of " << base.size() << ", rays " << bed.status().rays << " of "
                    << base_rays);
    CHECK(same_places(now, base));
    CHECK(begins_with(test::lit(now).lights, test::lit(base).lights) == !s.light);
    if (!s.coverage) CHECK(now.size() == base.size());
    if (!s.light) CHECK(bed.status().rays >= base_rays);
    if (!s.light && !s.coverage) CHECK(bed.status().rays == base_rays);
    if (s.light) CHECK(bed.status().rays >= uint64_t{64} * base.size());
    CHECK(bed.status().relighting.records == 0);
    take_back();
  }
  // Another scene object, even with the same content.
  bed.r.set_scene(std::make_shared<scene::Scene>(room()));
  bed.set(k_base);
  CHECK(test::cache(bed.r)->records().size() == 0);
}

TEST_CASE("every edit and setting has a row; cache settings without a row invalidate everything") {
  using namespace solvers;
  const SolverInfo& cache = irradiance_cache::info();
  const std::vector<ChangeRow> rows = changes_of(cache);
  std::set<std::variant<Change, std::string_view>> named;
  for (const ChangeRow& row : rows) {
    CHECK(named.insert(row.change).second);
    CHECK_FALSE(row.why.empty());
    // Places without light or coverage are useless.
    if (row.invalidates.places) CHECK(row.invalidates == k_invalidates_all);
  }
  for (const Change edit : scene::k_all_changes) CHECK(named.contains(edit));
  for (const OptionInfo& o : plan::options()) {
    bool found = false;
    for (const ChangeRow& row : rows)
      if (const auto* head = std::get_if<std::string_view>(&row.change)) found |= o.key.starts_with(*head);
    INFO(o.key);
    const SolverInfo* owner = owner_of(o.key);
    if (!owner || owner == &cache) CHECK(found);  // otherwise nothing is invalidated
    // A setting that does not restart the picture cannot invalidate records.
    if (!o.restarts) CHECK_FALSE(invalidated_by_setting(cache, o.key).any());
  }
  CHECK(invalidated_by_setting(cache, "cache.of_tomorrow") == k_invalidates_all);
  CHECK(invalidated_by_setting(cache, "unheard.of") == k_invalidates_all);
}

TEST_CASE("a setting of one solver invalidates no other solver's work") {
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::SolverInfo* other : solvers::registered())
      for (const OptionInfo& o : other->options) {
        INFO(solver->name << ", " << o.key);
        if (other == solver)
          CHECK(solvers::owner_of(o.key) == solver);
        else
          CHECK_FALSE(solvers::invalidated_by_setting(*solver, o.key).any());
      }
}

TEST_CASE("a relit cache equals one built in that light, bit for bit") {
  Bed relit;
  relit.finish();
  const RawRecords before = relit.records();
  const auto compare = [&](const char* what, const std::function<void(Bed&)>& change) {
    INFO(what);
    change(relit);
    REQUIRE_FALSE(test::cache(relit.r)->ready());
    const film::Image picture = relit.finish();
    Bed fresh;
    change(fresh);
    const film::Image expected = fresh.finish();
    CHECK(same_places(relit.records(), before));
    CHECK_FALSE(begins_with(relit.records().lights, before.lights));
    CHECK(begins_with(relit.records(), fresh.records()));
    CHECK(relit.records().size() == fresh.records().size());
    CHECK(relit.status().stop == fresh.status().stop);
    CHECK(identical(picture, expected));
    // The relit cache spends the rays of its records only, not those that tested places.
    CHECK(relit.status().rays < fresh.status().rays);
  };
  compare("another colour of the lamp", [](Bed& b) { b.set_lamp({1, 4, 2}); });
  // Other kernels: no lamp is compiled in.
  compare("the lamp off", [](Bed& b) { b.set_lamp({1, 4, 2}, false); });
  compare("the sky brighter and turned", [](Bed& b) {
    b.set_lamp({1, 4, 2}, false);
    b.r.set_environment(3, 120);
  });
  // After the edits are undone it equals the original cache.
  relit.paint(1, vec3(room().materials[1].base_color));
  relit.r.set_environment(1, 0);
  relit.set_lamp(vec3(5));
  relit.finish();
  CHECK(begins_with(relit.records(), before));
}

TEST_CASE("a material that becomes emissive, a mirror or diffuse again changes light and records") {
  Bed bed;
  bed.finish();
  const RawRecords base = bed.records();
  // A mirror needs no records; existing records on it stay unused.
  bed.paint(1, {0.9f, 0.9f, 0.9f}, 1);
  const film::Image mirror = bed.finish();
  CHECK(same_places(bed.records(), base));
  CHECK(mean(mirror, 3) > 0);
  bed.paint(1, {0, 0, 0}, 0, {500, 0, 0});
  const film::Image lamp = bed.finish();
  CHECK(same_places(bed.records(), base));
  // The block's light is in the records of the walls.
  double red = 0, green = 0;
  for (const auto& r : test::cache(bed.r)->records().read())
    red += double(r.parts[1].value.x), green += double(r.parts[1].value.y);
  CHECK(red > 2 * green);
  // A surface that starts as a mirror has no records until it becomes diffuse.
  Bed second;
  second.paint(1, {0.9f, 0.9f, 0.9f}, 1);
  second.finish();
  const uint32_t without = second.records().size();
  second.paint(1, {0.2f, 0.5f, 0.8f});
  CHECK(second.status().relighting.records == without);
  second.finish();
  CHECK(second.records().size() > without);
  // An edit that is refused changes nothing.
  scene::Material glass = second.r.scene()->materials[1];
  glass.name = "block", glass.transmission = 1;
  CHECK_THROWS_WITH(second.r.set_material(7, glass), Catch::Contains("there is no material 7"));
  CHECK(test::cache(second.r)->ready());
  CHECK(second.r.scene()->materials[1].transmission == 0);
}

TEST_CASE("a change of colour updates the light of a cache") {
  // Russian roulette depends on the throughput, so a few records lie elsewhere.
  const Settings interpolated{{"cache.gather", "false"}};
  Bed relit(interpolated), fresh(interpolated);
  relit.finish();
  const RawRecords before = relit.records();
  relit.paint(1, {0.9f, 0.1f, 0.1f});
  fresh.paint(1, {0.9f, 0.1f, 0.1f});
  const film::Image picture = relit.finish(), expected = fresh.finish();
  CHECK(same_places(relit.records(), before));
  CHECK(std::abs(int(relit.records().size()) - int(fresh.records().size())) <= int(before.size() / 20));
  for (const int c : {1, 2}) CHECK(mean(picture, c) == Approx(mean(expected, c)).epsilon(0.03));
}

TEST_CASE("ellipses that shrink in other light leave no gaps") {
  // With this number of rays the means differ by about 1 % between seeds.
  const Settings ellipses{{"cache.metric", "hessian"},
                          {"cache.min_radius", "1"},
                          {"cache.gather", "false"},
                          {"cache.rays", "256"},
                          {"cache.max_rays", "1024"}};
  Bed relit(ellipses), fresh(ellipses);
  relit.finish();
  uint32_t records = relit.records().size();
  const auto move_lamp = [](Bed& b, vec3 to) {
    scene::Light lamp = b.r.scene()->lights[0];
    lamp.position = to;
    b.r.set_light(0, lamp);
  };
  move_lamp(fresh, {-1.4f, 0.3f, 0.8f});
  const film::Image expected = fresh.finish();
  // Back and forth several times: passes are counted from zero each time.
  for (int round = 0; round < 5; ++round) {
    move_lamp(relit, round % 2 ? vec3(1, 2, 1) : vec3(-1.4f, 0.3f, 0.8f));
    CHECK(relit.status().relighting.records == records);
    const film::Image picture = relit.finish();
    const irradiance_cache::CachePass& last = relit.status().passes.back();
    INFO("round " << round << ": " << records << " records, then " << relit.records().size() << "; of "
                  << last.paths << " paths in the end " << last.uncovered << " gaps");
    CHECK(relit.status().stop == StopReason::covered);
    CHECK(last.paths > 0);
    CHECK(double(last.uncovered) <= 0.002 * double(last.paths));
    CHECK(relit.records().size() >= records);
    CHECK(relit.records().size() < 2 * fresh.records().size());
    if (round % 2 == 0)
      for (const int c : {1, 2}) CHECK(mean(picture, c) == Approx(mean(expected, c)).epsilon(0.03));
    records = relit.records().size();
  }
}

TEST_CASE("light that was present before needs almost no new records") {
  // As with default settings: places are also chosen where irradiance changes across the picture.
  Bed bed({{"cache.metric", "hessian"}, {"cache.min_radius", "1"}, {"cache.irradiance_weight", "1"}});
  bed.finish();
  const auto move_lamp = [&](vec3 to) {
    scene::Light lamp = bed.r.scene()->lights[0];
    lamp.position = to;
    bed.r.set_light(0, lamp);
    bed.finish();
    return bed.records().size();
  };
  const vec3 here = bed.r.scene()->lights[0].position, there(-1.4f, 0.3f, 0.8f);
  const uint32_t built = bed.records().size();
  const uint32_t same = move_lamp(here), moved = move_lamp(there), back = move_lamp(here);
  INFO("built " << built << ", in the same light " << same);
  CHECK(same == built);
  // From here on neither the light nor the picture is new.
  uint32_t records = back;
  for (int round = 0; round < 3; ++round) {
    const uint32_t again = move_lamp(there), once_more = move_lamp(here);
    INFO("built " << built << ", moved " << moved << ", back " << back << "; then " << again << ", "
                  << once_more);
    CHECK(again <= records + records / 100);
    CHECK(once_more <= again + again / 100);
    records = once_more;
  }
}

TEST_CASE("relighting can be cancelled, restarted, moved and interrupted") {
  Bed uninterrupted, bed;
  const film::Image before = uninterrupted.finish();
  uninterrupted.set_lamp({9, 2, 1});
  const film::Image expected = uninterrupted.finish();
  bed.finish();
  // Another light while records are relit; every other work item is cancelled.
  bed.set_lamp({0, 0, 7});
  for (int i = 0; i < 3; ++i) bed.r.step();
  CHECK(bed.status().relighting.records > 0);
  // Relit records are used and counted; the picture waits.
  CHECK(bed.status().records <= bed.status().relighting.records);
  CHECK(bed.r.samples() == 0);
  bed.set_lamp({9, 2, 1});
  int cancelled = 0;
  uint32_t records = 0, grown = 0;
  float share = 0;
  for (int i = 0; !test::cache(bed.r)->ready(); ++i) {
    cancelled += !bed.r.step([&] { return i % 2 == 1; });
    if (bed.status().relighting.records > 0) {
      grown += bed.status().records > records;
      CHECK(bed.status().records >= records);
      records = bed.status().records;
      CHECK(bed.status().relighting.share >= share);
      share = bed.status().relighting.share;
    }
  }
  CHECK(cancelled > 2);
  CHECK(grown > 2);  // progress is reported
  CHECK(share > 0.9f);
  CHECK(identical(expected, bed.finish()));
  CHECK(begins_with(bed.records(), uninterrupted.records()));

  // The camera moves while records are relit: first they are relit, then more are placed.
  bed.set_lamp(vec3(5));
  bed.r.step();
  bed.r.choose_camera("above");
  CHECK(bed.status().relighting.records > 0);
  bed.finish();
  const RawRecords more = bed.records();
  CHECK(same_places(more, uninterrupted.records()));
  CHECK(more.size() > uninterrupted.records().size());
  // All have the new light: back at the first camera almost no records are missing.
  bed.r.choose_camera("front");
  bed.finish();
  CHECK(bed.records().size() <= more.size() + more.size() / 20);

  // During a build: placed records stay, and the rest is built in the new light.
  Bed building;
  while (test::cache(building.r)->records().size() == 0 || building.status().records < 20) building.r.step();
  building.set_lamp({9, 2, 1});
  CHECK_FALSE(test::cache(building.r)->ready());
  building.finish();
  CHECK(building.status().stop == StopReason::covered);
  for (const auto& record : test::cache(building.r)->records().read()) {
    CHECK(record.rays >= 64);
    CHECK(record.radius > 0);
  }

  // A build without interruption still gives the first picture.
  Bed again;
  CHECK(identical(before, again.finish()));
}

TEST_CASE("switched-off components keep records complete, and reuse them when switched on") {
  Bed bed;
  const film::Image both = bed.finish();
  const RawRecords base = bed.records();
  const uint64_t rays = bed.status().rays;
  for (const Settings& off : {Settings{{"components.tertiary", "off"}},
                              {{"components.secondary", "off"}},
                              {{"components.primary", "off"}, {"components.caustic", "off"}}}) {
    INFO(off.begin()->first);
    bed.set(off);
    CHECK(test::cache(bed.r)->ready());
    bed.finish();
    CHECK(begins_with(bed.records(), base));
    bed.set({{"components.primary", "path"},
             {"components.caustic", "path"},
             {"components.secondary", "cache"},
             {"components.tertiary", "cache"}});
    CHECK(test::cache(bed.r)->ready());
    CHECK(identical(both, bed.finish()));
    CHECK(bed.status().rays == rays);
  }
  // Records relit while tertiary light is off lack it: switching it on relights them again.
  bed.set({{"components.tertiary", "off"}});
  bed.set_lamp({9, 2, 1});
  bed.finish();
  bed.set({{"components.tertiary", "cache"}});
  CHECK(bed.status().relighting.records == base.size());
  const film::Image relit = bed.finish();
  Bed fresh;
  fresh.set_lamp({9, 2, 1});
  CHECK(identical(relit, fresh.finish()));
  // Tertiary light behind records is now path traced instead of read, so it must be gathered again.
  bed.set({{"components.tertiary", "path"}});
  CHECK(bed.status().relighting.records == base.size());
  bed.finish();
  CHECK(same_places(bed.records(), base));
  // A limit below the number of records discards them.
  bed.set({{"cache.max_records", std::to_string(base.size() - 1)}});
  CHECK(test::cache(bed.r)->records().size() == 0);
}

}  // namespace cache_invalidation_tests
