// links: session
// The placement of records, observed: building waits after each stage and gives the same cache, and its state
// is drawn at the right positions, hidden by nearer surfaces.
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <thread>

#include "session/pick.h"
#include "session/renderer.h"
#include "session/session.h"
#include "shaders/shared/irradiance_cache/placement_view.h"
#include "support/device.h"
#include "support/device_name.h"
#include "support/records.h"
#include "support/solver.h"

namespace cache_placement_tests {

using namespace lucerna;
using irradiance_cache::BuildStage;
using irradiance_cache::PlacementShow;

namespace {

constexpr uint32_t k_size = 128;

/// A Cornell box with secondary and tertiary light cached, before its build.
session::Renderer& bed() {
  static const std::unique_ptr<session::Renderer> renderer = [] {
    auto r = std::make_unique<session::Renderer>(session::RendererOptions{.device = test::device_name(),
                                                                          .validation = true,
                                                                          .shaders = {},
                                                                          .defines = {},
                                                                          .interactive = true});
    r->set_size(k_size, k_size);
    r->load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
    for (const auto& [key, value] : {std::pair{"components.secondary", "cache"},
                                     {"components.tertiary", "cache"},
                                     {"cache.rays", "64"},
                                     {"cache.max_rays", "256"},
                                     {"cache.passes", "2"},
                                     {"samples", "1"}})
      r->settings().set(key, value);
    r->apply_settings();
    return r;
  }();
  return *renderer;
}

void set(session::Renderer& r, const char* key, const char* value) {
  r.settings().set(key, value);
  r.apply_settings();
}

/// Works until there is nothing to do; returns the number of work items.
int work(session::Renderer& r) {
  int pieces = 0;
  while (r.step()) ++pieces;
  return pieces;
}

const irradiance_cache::CacheStatus& status(session::Renderer& r) { return test::cache(r)->status(); }

/// Restarts the build, with a pause after every stage, up to a stage.
void build_to(session::Renderer& r, BuildStage stage) {
  set(r, "cache.pause", "stage");
  r.restart();
  REQUIRE(r.previews().draw());
  for (work(r); !status(r).last || status(r).last->stage != stage; work(r)) {
    REQUIRE(r.waits());
    r.solvers().command("cache", "step");
  }
}

/// The position of a point in the picture, and its depth.
vec3 project(const session::Renderer& r, const vec3& x) {
  const vec3 c(glm::inverse(r.camera().to_world) * vec4(x, 1));
  const float half = std::tan(0.5f * r.camera().yfov);
  return vec3((0.5f + 0.5f * vec2(c.x, -c.y) / (-c.z * half)) * float(k_size), -c.z);
}

/// Size of a pixel at a depth [m].
float pixel_size(const session::Renderer& r, float depth) {
  return 2 * std::tan(0.5f * r.camera().yfov) * depth / k_size;
}

/// Distance in pixels between a point of the picture and the surface behind it: negative if a surface is in
/// front of it.
float room(const session::Renderer& r, const vec3& at) {
  const auto hit = session::pick(*r.scene(), r.camera(), at.x / k_size, at.y / k_size, 1);
  if (!hit) return 1e9f;
  return (project(r, hit->position).z - at.z) / pixel_size(r, at.z);
}

/// Pixels with a colour: before the first sample the picture below the marks is grey.
std::vector<bool> coloured(const std::vector<uint8_t>& drawn) {
  std::vector<bool> list(size_t{k_size} * k_size);
  for (size_t p = 0; p < list.size(); ++p) {
    const auto [lo, hi] = std::minmax({drawn[4 * p], drawn[4 * p + 1], drawn[4 * p + 2]});
    list[p] = hi - lo > 10;
  }
  return list;
}

/// Pixels with a mark: all others are the plain picture, dimmed as by overlay/lay.comp.
std::vector<bool> marked(const std::vector<uint8_t>& plain, const std::vector<uint8_t>& drawn) {
  std::vector<bool> list(size_t{k_size} * k_size);
  for (size_t p = 0; p < list.size(); ++p) {
    const vec3 c(plain[4 * p], plain[4 * p + 1], plain[4 * p + 2]);
    const vec3 dim = 0.6f * (0.4f * c + 0.6f * vec3(dot(c, vec3(0.2126f, 0.7152f, 0.0722f))));
    for (int k = 0; k < 3; ++k)
      list[p] = list[p] || std::abs(float(drawn[4 * p + size_t(k)]) - dim[k]) > 1.5f;
  }
  return list;
}

bool inside(const vec3& at) {
  return at.z > 0 && at.x > 2 && at.y > 2 && at.x < k_size - 2 && at.y < k_size - 2;
}

bool near(const std::vector<bool>& list, const vec3& at, int reach) {
  for (int y = int(at.y) - reach; y <= int(at.y) + reach; ++y)
    for (int x = int(at.x) - reach; x <= int(at.x) + reach; ++x)
      if (x >= 0 && y >= 0 && x < int(k_size) && y < int(k_size) && list[size_t(y) * k_size + size_t(x)])
        return true;
  return false;
}

}  // namespace

TEST_CASE("building waits after each stage and gives the same cache, bit for bit") {
  session::Renderer& r = bed();
  set(r, "cache.pause", "off");
  r.restart();
  work(r);
  REQUIRE(test::cache(r)->ready());
  REQUIRE(r.done());
  const auto count = test::cache(r)->records().size();
  const irradiance_cache::RawRecords all = test::cache(r)->records().raw(count);
  const std::vector<uint8_t> picture = r.output().picture(false);
  REQUIRE(count > 100);

  set(r, "cache.pause", "stage");
  CHECK(r.done());  // changing it restarts nothing
  r.restart();
  CHECK_FALSE(status(r).last.has_value());
  std::vector<std::pair<BuildStage, uint32_t>> stages;  // and passes
  while (work(r), r.waits()) {
    CHECK(work(r) == 0);
    CHECK(r.samples() == 0);
    const auto& last = *status(r).last;
    stages.emplace_back(last.stage, last.pass);
    const irradiance_cache::PlacementShown p = test::cache(r)->placement();
    const irradiance_cache::CachePass& pass = status(r).passes.back();
    INFO(stage_words(last));
    CHECK(p.candidates.size() == pass.candidates);
    CHECK(p.tried.size() == pass.tried);
    CHECK(p.cluster.empty() == (last.stage == BuildStage::probe));
    CHECK(p.radii.empty() == (last.stage <= BuildStage::choose));
    CHECK(p.kept.empty() == (last.stage <= BuildStage::measure));
    if (!p.kept.empty()) CHECK(p.kept.size() == pass.records);
    if (last.stage == BuildStage::measure) CHECK(last.rays == 64 * pass.tried);
    if (last.stage == BuildStage::evaluate) CHECK(last.rays > 0);
    CHECK(last.ms >= 0);
    r.solvers().command("cache", "step");
  }
  REQUIRE(test::cache(r)->ready());
  // Every stage of both passes in order, with one evaluation per level; the last end is no pause, because the
  // cache is complete.
  REQUIRE(stages.size() >= 11);
  for (size_t i = 0; i < stages.size(); ++i) {
    INFO(i);
    const uint32_t pass = stages[i].second;
    if (i > 0 && pass != stages[i - 1].second) CHECK(stages[i].first == BuildStage::probe);
    const BuildStage before =
        i > 0 && pass == stages[i - 1].second ? stages[i - 1].first : BuildStage::octree;
    switch (stages[i].first) {
      case BuildStage::probe:
        CHECK((before == BuildStage::octree || before == BuildStage::evaluate));
        break;
      case BuildStage::octree:
        CHECK(before == BuildStage::evaluate);
        break;
      case BuildStage::evaluate:
        CHECK((before == BuildStage::thin || before == BuildStage::octree || before == BuildStage::evaluate));
        break;
      default:
        CHECK(int(stages[i].first) == int(before) + 1);
    }
  }
  CHECK(r.done());
  REQUIRE(test::cache(r)->records().size() == count);
  CHECK(test::identical(test::cache(r)->records().raw(count), all));
  CHECK(r.output().picture(false) == picture);

  // After a pass only; then on to the end.
  set(r, "cache.pause", "pass");
  r.restart();
  work(r);
  REQUIRE(r.waits());
  CHECK(status(r).pass == 1);
  CHECK(test::cache(r)->placement().kept.size() == status(r).passes[0].records);
  r.solvers().command("cache", "run");
  work(r);
  CHECK(r.done());
  CHECK(test::identical(test::cache(r)->records().raw(count), all));

  // A step without a pause setting; and a change of the setting ends a pause.
  set(r, "cache.pause", "off");
  r.solvers().command("cache", "step");  // complete: nothing to wait for
  r.restart();
  r.solvers().command("cache", "step");
  work(r);
  REQUIRE(r.waits());
  CHECK(status(r).last->stage == BuildStage::probe);
  set(r, "overlay.placement", "stage");  // the overlay does not matter
  CHECK(r.waits());
  set(r, "overlay.placement", "off");
  set(r, "cache.pause", "stage");
  CHECK(r.waits());
  set(r, "cache.pause", "off");
  CHECK_FALSE(r.waits());
  work(r);
  CHECK(test::identical(test::cache(r)->records().raw(count), all));
}

TEST_CASE("batch rendering never pauses") {
  session::Renderer r(test::renderer_options(false));
  r.set_size(32, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  for (const auto& [key, value] : {std::pair{"components.secondary", "cache"},
                                   {"cache.pause", "stage"},
                                   {"cache.rays", "64"},
                                   {"cache.max_rays", "64"},
                                   {"samples", "1"}})
    r.settings().set(key, value);
  r.apply_settings();
  work(r);
  CHECK(r.done());
}

TEST_CASE("candidates on visible surfaces are drawn at their positions") {
  session::Renderer& r = bed();
  build_to(r, BuildStage::probe);
  set(r, "overlay.placement", "off");
  const std::vector<uint8_t> plain = r.output().picture(true);
  CHECK(test::cache_report(r)->placement == PlacementShow::off);
  set(r, "overlay.placement", "stage");
  const std::vector<uint8_t> drawn = r.output().picture(true);
  CHECK(r.output().picture(true) == drawn);
  CHECK(test::cache_report(r)->placement == PlacementShow::candidates);
  REQUIRE(r.waits());
  const std::vector<bool> list = coloured(drawn);
  size_t seen = 0, unmarked = 0;
  for (const irradiance_cache::Place& p : test::cache(r)->placement().candidates) {
    const vec3 at = project(r, p.position);
    if (!inside(at) || room(r, at) < -1) continue;
    ++seen, unmarked += !near(list, at, 1);
  }
  INFO(seen << " seen, " << unmarked << " of them not drawn");
  CHECK(seen > 1000);
  // At edges, where the coarse film shows another surface than the candidate's, it may be hidden.
  CHECK(unmarked < seen / 50);
  set(r, "overlay.placement", "off");
  CHECK(r.output().picture(true) == plain);
}

TEST_CASE("the inspected point stays while building waits, also after a camera move") {
  session::Renderer& r = bed();
  build_to(r, BuildStage::thin);
  set(r, "overlay.placement", "chosen");
  const auto ink = [&] {
    const std::vector<bool> list = coloured(r.output().picture(true));
    return std::count(list.begin(), list.end(), true);
  };
  const auto before = ink();
  CHECK(before > 200);
  const size_t kept = test::cache(r)->placement().kept.size();
  const scene::Camera camera = r.camera();
  scene::Camera moved = camera;
  moved.to_world[3] += vec4(-2, 1.2f, 0, 0);
  r.set_camera(moved);
  REQUIRE(r.previews().draw());
  CHECK(r.waits());
  CHECK(r.step() == false);
  CHECK(test::cache(r)->placement().kept.size() == kept);
  CHECK(ink() > before / 4);
  // Continuing finishes that pass, and adds the records missing from here.
  r.solvers().command("cache", "run");
  work(r);
  CHECK(r.done());
  CHECK(status(r).passes.size() > 1);
  CHECK(status(r).passes[0].records == kept);
  set(r, "overlay.placement", "off");
  r.set_camera(camera);
}

TEST_CASE("chosen candidates are drawn with their radius, and hidden by nearer surfaces") {
  session::Renderer& r = bed();
  set(r, "cache.pause", "off");
  set(r, "cache.passes", "1");       // whose data is complete at the end
  set(r, "cache.min_radius", "16");  // few places, far apart
  // With rings; and with radii so small that none is drawn, so hidden places are isolated.
  const bool wide = GENERATE(true, false);
  set(r, "cache.max_radius", wide ? "0.25" : "0.01");
  work(r);
  REQUIRE(r.done());
  set(r, "overlay.placement", "off");
  const std::vector<uint8_t> plain = r.output().picture(false);
  set(r, "overlay.placement", "stage");
  const std::vector<uint8_t> drawn = r.output().picture(false);
  CHECK(test::cache_report(r)->placement == PlacementShow::chosen);
  const std::vector<bool> list = marked(plain, drawn);

  const irradiance_cache::PlacementShown p = test::cache(r)->placement();
  REQUIRE(p.kept.size() > 50);
  std::vector<vec3> shown, hidden, edges;  // edges: visible or hidden
  for (const irradiance_cache::Place& place : p.tried) {
    const vec3 at = project(r, place.position);
    if (!inside(at)) continue;
    const float free = room(r, at);
    if (free > -1) shown.push_back(at);
    // Dots are several pixels wide: hidden means hidden all around.
    else if (free < -20 && room(r, at + vec3(3, 0, 0)) < -20 && room(r, at - vec3(3, 0, 0)) < -20 &&
             room(r, at + vec3(0, 3, 0)) < -20 && room(r, at - vec3(0, 3, 0)) < -20)
      hidden.push_back(at);
    else
      edges.push_back(at);
  }
  size_t unmarked = 0;
  for (const vec3& at : shown) unmarked += !near(list, at, 1);
  INFO(shown.size() << " to be seen, " << unmarked << " of them not drawn, " << hidden.size() << " hidden");
  CHECK(shown.size() > 100);
  CHECK(unmarked <= shown.size() / 25);
  // All rings of chosen candidates are drawn where they lie on visible surfaces; small ones fade.
  size_t points = 0, bare = 0;
  std::vector<vec3> rings;
  for (const uint32_t i : p.kept) {
    const irradiance_cache::Place& place = p.tried[i];
    const vec3 any = std::abs(place.normal.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 side = normalize(cross(place.normal, any)), other = cross(place.normal, side);
    const vec3 away = normalize(place.position - vec3(r.camera().to_world[3]));
    for (int a = 0; a < 24; ++a) {
      const float angle = float(a) * 0.2618f;
      const vec3 at =
          project(r, place.position + p.radii[i] * (std::cos(angle) * side + std::sin(angle) * other));
      if (!inside(at)) continue;
      const float free = room(r, at);
      if (wide && free > -3) rings.push_back(at);
      if (std::abs(free) > 0.5f || p.radii[i] * std::abs(dot(away, place.normal)) < 10 * pixel_size(r, at.z))
        continue;
      ++points, bare += !near(list, at, 0);
    }
  }
  INFO(points << " points of rings, " << bare << " bare");
  CHECK((points > 60) == wide);
  CHECK(bare <= points / 10);
  // Nothing is drawn away from dots and rings: neither behind the blocks nor elsewhere.
  size_t strays = 0, inked = 0;
  for (uint32_t y = 0; y < k_size; ++y)
    for (uint32_t x = 0; x < k_size; ++x) {
      if (!list[size_t{y} * k_size + x]) continue;
      ++inked;
      const vec2 here(float(x) + 0.5f, float(y) + 0.5f);
      const auto close = [&](const vec3& at) { return length(vec2(at) - here) < 4; };
      strays +=
          std::none_of(shown.begin(), shown.end(), close) && std::none_of(rings.begin(), rings.end(), close);
    }
  INFO(inked << " pixels with ink, " << strays << " away from all places and rings");
  CHECK(inked > 300);
  CHECK(strays <= inked / 50);
  size_t lone = 0;
  for (const vec3& at : hidden) {
    const auto close = [&](const vec3& o) { return length(vec2(o) - vec2(at)) < 4.5f; };
    if (std::any_of(shown.begin(), shown.end(), close) || std::any_of(edges.begin(), edges.end(), close) ||
        std::any_of(rings.begin(), rings.end(), close))
      continue;
    ++lone;
    INFO("hidden at " << at.x << " " << at.y);
    CHECK_FALSE(near(list, at, 1));
  }
  INFO(lone << " of those hidden alone");
  if (!wide) CHECK(lone > 3);
  set(r, "overlay.placement", "off");
  set(r, "cache.passes", "2");
  set(r, "cache.min_radius", "3");
  set(r, "cache.max_radius", "0.1");
}

TEST_CASE("a session with a paused cache is idle, responds, and continues on command") {
  const auto made = session::start_session({.device = test::device_name()});
  session::Session& session = *made;
  session.set_size(48, 48);
  session.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  for (const auto& [key, value] : {std::pair{"components.secondary", "cache"},
                                   {"cache.rays", "64"},
                                   {"cache.max_rays", "64"},
                                   {"cache.pause", "pass"},
                                   {"samples", "2"}})
    session.set(key, value);
  using Snapshot = std::shared_ptr<const session::Snapshot>;
  const auto wait = [&](auto&& until) {
    for (int i = 0; i < 3000; ++i) {
      if (const Snapshot s = session.snapshot(); s && s->commands >= session.commands() && until(*s))
        return s;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    FAIL("waited too long");
    return Snapshot();
  };
  const auto waits = [](const session::Snapshot& s) { return !s.reports.empty() && s.reports[0]->waits; };
  const Snapshot before = wait(waits);
  CHECK(before->reports[0]->figure("pass") == 1);
  CHECK(before->preparing.find("cache waits") == 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const std::clock_t cpu = std::clock();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  CHECK(double(std::clock() - cpu) / CLOCKS_PER_SEC < 0.2);
  CHECK(session.snapshot()->id == before->id);
  // Overlays and the camera respond.
  session.set("overlay.placement", "stage");
  CHECK(wait(waits)->rgba != before->rgba);
  scene::Camera camera = before->camera;
  camera.to_world[3] += vec4(0.1f, 0, 0, 0);
  session.set_camera(camera);
  const Snapshot moved = wait(waits);
  CHECK(moved->camera.to_world == camera.to_world);
  CHECK(moved->samples == 0);
  session.solver_command("cache", "step");
  CHECK(wait(waits)->reports[0]->figure("stage") == double(BuildStage::probe));
  session.solver_command("cache", "run");
  wait([](const session::Snapshot& s) { return s.finished; });
}

}  // namespace cache_placement_tests
