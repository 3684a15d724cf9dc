// links: session
// Objects moved, turned, mirrored and hidden by hand: the picture is, bit for bit, that of a scene with the
// objects there; going back gives the picture before. Not so with an irradiance cache, whose far records
// stay: there the same edits give the same picture.
#include <array>
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "images/cache_support.h"
#include "scene/object_place.h"
#include "session/renderer.h"
#include "support/device.h"
#include "support/render.h"
#include "support/rooms.h"

namespace objects_tests {

using namespace lucerna;
using session::ObjectEdit;
using test::Settings;

namespace {

using Changes = std::vector<session::SettingChange>;

struct Bench {
  session::Renderer r;
  explicit Bench(const scene::Scene& s, const Changes& more = {}) : r(test::renderer_options(true)) {
    r.set_size(40, 28);
    Changes all{{"samples", "4", ""}, {"path.batch", "2048", ""}, {"path.max_depth", "6", ""}};
    all.insert(all.end(), more.begin(), more.end());
    r.set_scene(std::make_shared<scene::Scene>(s), {}, all);
  }
  film::Image image() {
    film::Image image = test::finish(r);
    REQUIRE(r.done());
    return image;
  }
};

bool same(const film::Image& a, const film::Image& b) { return a.components == b.components; }

/// The object's matrix after a place.
mat4 put(const scene::Scene& s, uint32_t object, const scene::ObjectPlace& place) {
  return scene::placed(s.instances[object].to_world, scene::box_of(s.meshes[s.instances[object].mesh]),
                       place);
}

scene::Scene with(scene::Scene s, const std::vector<ObjectEdit>& edits) {
  for (const ObjectEdit& e : edits) {
    scene::Instance& instance = s.instances[e.index];
    instance.to_world = e.to_world, instance.hidden = e.hidden;
    instance.flipped = glm::determinant(mat3(e.to_world)) < 0;
  }
  return s;
}

const Changes k_photons{{"components.caustic", "photons", ""}, {"photons.per_round", "4000", ""}};

/// A long hall with a box of 40 cm at one end and the camera at the other.
scene::Scene long_hall() {
  scene::Scene s;
  s.name = "hall", s.file = "hall.gltf";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse({0.3f, 0.5f, 0.8f})};
  test::add_box(s, {-6, 0, -2}, {6, 3, 2}, 0);
  test::add_box(s, {-4.2f, 0, -0.2f}, {-3.8f, 0.4f, 0.2f}, 1);
  for (const float x : {-4.0f, 3.0f})
    s.lights.push_back({.name = "lamp", .intensity = vec3(6), .position = {x, 2.5f, 0.5f}});
  scene::Camera camera;
  camera.yfov = 1;
  camera.to_world = glm::inverse(glm::lookAt(vec3(5.5f, 1.6f, 0), vec3(-4, 0.6f, 0), vec3(0, 1, 0)));
  s.cameras = {camera};
  return s;
}

const Settings k_dense = test::dense_records({{"components.secondary", "cache"},
                                              {"components.tertiary", "cache"},
                                              {"cache.max_records", "12000"},
                                              {"cache.rays", "256"},
                                              {"cache.max_rays", "256"},
                                              {"cache.error", "0.5"},
                                              {"samples", "16"}});

std::vector<vec3> positions(const irradiance_cache::RawRecords& records) {
  std::vector<vec3> all;
  for (uint32_t r = 0; r < records.size(); ++r)
    all.push_back(vec3(records.places[size_t{r} * shared::k_record_texels]));
  return all;
}

}  // namespace

TEST_CASE("a moved or hidden object takes the records around it away, and the others are relit") {
  const scene::Scene s = long_hall();
  const auto above_floor_in = [](const Box& box, const vec3& p) {
    return p.x > box.lo.x && p.x < box.hi.x && p.z > box.lo.z && p.z < box.hi.z && p.y > 0.02f && p.y < 0.42f;
  };
  const Box stood{{-4.21f, 0, -0.21f}, {-3.79f, 0.41f, 0.21f}};
  for (const char* metric : {"split-sphere", "hessian"})
    for (const bool hidden : {false, true}) {
      INFO(metric << (hidden ? ", hidden" : ", moved"));
      Settings settings = k_dense;
      settings["cache.metric"] = metric;
      test::CacheRenderer edited(s, 48, !hidden);
      edited.set(settings);
      edited.finish();
      const std::vector<vec3> before = positions(edited.records());
      REQUIRE(
          std::any_of(before.begin(), before.end(), [&](const vec3& p) { return above_floor_in(stood, p); }));

      const std::vector<ObjectEdit> edits{{1, put(s, 1, {.moved = {0.2f, 0, 1}}), hidden}};
      edited.r.set_instances(edits);
      CHECK(edited.status().relighting.records > 0);
      const film::Image image = edited.finish();
      const std::vector<vec3> after = positions(edited.records());
      test::CacheRenderer again(s, 48, false);
      again.set(settings);
      again.finish();
      again.r.set_instances(edits);
      CHECK(same(again.finish(), image));
      CHECK(test::identical(again.records(), edited.records()));
      CHECK_FALSE(
          std::any_of(after.begin(), after.end(), [&](const vec3& p) { return above_floor_in(stood, p); }));
      const Box stands{{-4.01f, 0, 0.79f}, {-3.59f, 0.41f, 1.21f}};
      CHECK(std::any_of(after.begin(), after.end(),
                        [&](const vec3& p) { return above_floor_in(stands, p); }) == !hidden);
      const auto bits = [](const vec3& p) { return std::array{p.x, p.y, p.z}; };
      std::set<std::array<float, 3>> places;
      for (const vec3& p : after) places.insert(bits(p));
      size_t far = 0, kept = 0;
      for (const vec3& p : before)
        if (p.x > -1) ++far, kept += places.contains(bits(p));
      CHECK(far > before.size() / 4);
      CHECK(kept == far);

      test::CacheRenderer made(with(s, edits), 48, false);
      made.set(settings);
      made.finish();
      INFO(before.size() << " records, then " << after.size() << ", built " << made.records().size());
      CHECK(double(after.size()) < 1.3 * double(made.records().size()));
      test::CacheRenderer traced(with(s, edits), 48, false);
      traced.set({{"samples", "256"}});
      const film::Image truth = traced.finish();
      // Built from scratch, the means of 256 rays a record scatter by about 1 %.
      for (const int component : {1, 2}) {
        const double ratio =
            test::mean(image.components[component]) / test::mean(truth.components[component]);
        INFO("component " << component << ": " << ratio);
        CHECK(std::abs(ratio - 1) < 0.04);
      }
    }
}

TEST_CASE("a moved object lights and shades as if its scene had it there, without records from before") {
  const scene::Scene s = test::block_room(true);
  const std::vector<ObjectEdit> edits{
      {1, put(s, 1, {.moved = {0.7f, 0.2f, 0.4f}, .turned = {10, 40, 5}, .scaled = {1.5f, -0.5f, 1}})}};
  for (const Changes& changes : {Changes{}, k_photons, Changes{{"tracer", "compute-bvh", ""}}}) {
    INFO(changes.size() << (changes.empty() ? "" : changes[0].value));
    Bench edited(s, changes), made(with(s, edits), changes);
    const film::Image old = edited.image();
    edited.r.set_instances(edits);
    CHECK(edited.r.scene()->instances[1].flipped);
    const film::Image image = edited.image();
    CHECK(same(image, made.image()));
    CHECK_FALSE(same(image, old));
    edited.r.set_instances({{1, s.instances[1].to_world}});
    CHECK(same(edited.image(), old));
  }
}

TEST_CASE("a hidden object is as if its scene did not have it, also if it shines") {
  scene::Scene s = test::PanelRoom().s;
  const auto panel = static_cast<uint32_t>(s.instances.size() - 1);
  s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {-0.5f, 0.5f, 0.5f}});
  for (const uint32_t object : {1u, panel}) {
    INFO("object " << object);
    scene::Scene without = s;
    std::vector<scene::Instance> rest = s.instances;
    rest.erase(rest.begin() + object);
    without.instances = rest;
    Bench edited(s), made(without);
    const film::Image old = edited.image();
    edited.r.set_instances({{object, s.instances[object].to_world, true}});
    CHECK(same(edited.image(), made.image()));
    edited.r.set_instances({{object, s.instances[object].to_world, false}});
    CHECK(same(edited.image(), old));
  }
}

TEST_CASE("an object that shines takes its light with it, and other edits stay") {
  const scene::Scene s = test::PanelRoom().s;
  const auto panel = static_cast<uint32_t>(s.instances.size() - 1);
  const std::vector<ObjectEdit> edits{
      {panel, put(s, panel, {.moved = {-0.8f, -0.1f, 0}, .scaled = {0.5f, 1, 2}})}};
  scene::Scene after = with(s, edits);
  after.materials[0].base_color = {0.2f, 0.7f, 0.3f, 1};
  Bench edited(s), made(after);
  edited.r.set_material(0, after.materials[0]);
  edited.r.set_instances(edits);
  CHECK(same(edited.image(), made.image()));
  CHECK(edited.r.scene()->materials[0].base_color.y == 0.7f);
}

TEST_CASE("openings are searched again when what stands in them moves") {
  scene::Scene s = test::block_room(true);
  // A lid over the open room.
  test::add_quad(s, {-2, 2.5f, -2}, {0, 0, 4}, {4, 0, 0});
  const Changes found{{"lights.portals", "found", ""}};
  const std::vector<ObjectEdit> away{{2, put(s, 2, {.moved = {9, 0, 0}})}};
  Bench edited(s, found), made(with(s, away), found);
  CHECK(edited.r.scene()->portals.empty());
  edited.r.set_instances(away);
  CHECK(edited.r.scene()->portals == made.r.scene()->portals);
  CHECK_FALSE(edited.r.scene()->portals.empty());
  CHECK(same(edited.image(), made.image()));
}

TEST_CASE("a refused or cancelled edit leaves the picture, which goes on bit for bit") {
  const scene::Scene s = test::block_room(true);
  Bench undisturbed(s), b(s);
  const film::Image wanted = undisturbed.image();
  while (b.r.samples() < 2) REQUIRE(b.r.step());
  const auto scene = b.r.scene();
  const uint64_t restarts = b.r.restarts();
  const auto failure = [&](const std::vector<ObjectEdit>& edits, const session::Progress& progress = {}) {
    try {
      b.r.set_instances(edits, progress);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const mat4 here = s.instances[1].to_world;
  CHECK_THAT(failure({{7, here}}), Catch::Contains("there is no object 8"));
  CHECK_THAT(failure({{1, mat4(std::numeric_limits<float>::quiet_NaN())}}),
             Catch::Contains("object 'box': its matrix is not finite"));
  CHECK_THAT(failure({{1, glm::scale(mat4(1), vec3(0, 1, 1))}}), Catch::Contains("cannot be inverted"));
  CHECK_THAT(failure({{0, here, true}, {1, glm::translate(mat4(1), vec3(1e10f, 0, 0))}}),
             Catch::Contains("beyond"));
  const mat4 there = glm::translate(here, vec3(1, 0, 0));
  for (const float until : {0.0f, 0.2f, 0.8f, 0.9f})
    CHECK_THAT(failure({{1, there}}, [&](float fraction, const std::string&) { return fraction < until; }),
               Catch::Contains("cancelled"));
  CHECK(failure({{1, here}}).empty());  // no change
  CHECK(b.r.scene() == scene);
  CHECK(b.r.restarts() == restarts);
  CHECK(same(b.image(), wanted));
}

}  // namespace objects_tests
