// links: session
// Hits shaded by one kernel per class give bit for bit the picture of one kernel for all, for all lookups and
// for per-group light.
#include <catch2/catch.hpp>

#include "images/shafts_support.h"
#include "support/render.h"

namespace hit_classes_tests {

using namespace lucerna;

namespace {

/// Renders by class and by one kernel, in small batches.
void check_same(const scene::Scene& s, test::Settings settings, uint32_t samples = 8, uint32_t size = 48) {
  settings["path.batch"] = "4096";
  settings["path.classes"] = "off";
  const test::Result all = test::render(s, settings, samples, size, false);
  settings["path.classes"] = "always";
  const test::Result by_class = test::render(s, settings, samples, size);
  const auto sorts = [](const test::Result& r) {
    return std::any_of(r.stats.stages.begin(), r.stats.stages.end(),
                       [](const transport::StageSum& stage) { return stage.name == "sort hits"; });
  };
  CHECK(!sorts(all));
  CHECK(sorts(by_class));
  CHECK(test::identical(all.image, by_class.image));
  CHECK(all.stats.rays == by_class.stats.rays);
  CHECK(all.stats.shadow_rays == by_class.stats.shadow_rays);
  CHECK(all.stats.roulette == by_class.stats.roulette);
  CHECK(all.stats.depth == by_class.stats.depth);
}

scene::Scene all_kinds(bool lamps) {
  const auto kinds = test::shafts::kinds();
  return test::shafts::shafts_with(kinds, std::vector<bool>(kinds.size(), true), lamps);
}

}  // namespace

TEST_CASE("hits of every kind are shaded by class as by one kernel") {
  const bool lamps = GENERATE(false, true);
  INFO((lamps ? "lamps" : "sky"));
  check_same(all_kinds(lamps), {});
}

TEST_CASE("shading by class equals shading by one kernel with the other tracer") {
  check_same(all_kinds(false), {{"tracer", "compute-bvh"}});
}

TEST_CASE("shading by class equals shading by one kernel where few paths continue") {
  check_same(all_kinds(true), {{"path.max_depth", "3"}, {"path.roulette_depth", "1"}});
}

TEST_CASE("shading by class equals shading by one kernel with per-group light") {
  check_same(all_kinds(true), {{"relight.enabled", GENERATE("on", "compact")}});
}

TEST_CASE("shading by class equals shading by one kernel with lookups") {
  test::PanelRoom room(vec3(0.5f));
  room.s.materials.push_back(test::shafts::metal(0.3f));
  test::add_quad(room.s, {-0.5f, -0.9f, -0.5f}, {0, 0.2f, 0.5f}, {0.5f, 0, 0},
                 scene::Id(room.s.materials.size() - 1));
  const char* solver = GENERATE("cache", "photons");
  // Without caustics, paths behind lookups end at surfaces of all kinds.
  const char* caustic = GENERATE("path", "off");
  INFO(solver << ", caustics " << caustic);
  check_same(room.s,
             {{"components.secondary", solver},
              {"components.tertiary", solver},
              {"components.caustic", caustic},
              {"cache.max_rays", "64"}},
             4, 24);
}

}  // namespace hit_classes_tests
