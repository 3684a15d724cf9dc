// links: session
// Inspection of the irradiance cache: which records a pixel reads, how many the picture reads, what is drawn
// over it, and the log of its build; compared with all records read back and weighted on the host.
#include <unistd.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "film/io/image_file.h"
#include "session/pick.h"
#include "session/renderer.h"
#include "support/records.h"
#include "support/render.h"
#include "support/rooms.h"

namespace cache_inspect_tests {

using namespace lucerna;
using irradiance_cache::Inspection;
using irradiance_cache::Record;

namespace {

constexpr uint32_t k_size = 192;
// Of the cache: 1 - cos 20 degrees; of the radius, and of the minimum radius, which is in pixels.
constexpr float k_tolerance = 0.06f, k_off_plane = 0.03f, k_off_plane_least = 0.16f, k_least_pixels = 3;

/// Tabellion and Lamorlette's weight, as in shaders/irradiance_cache/lookup.glsl.
float weight(const Record& record, const vec3& x, const vec3& n, const session::Renderer& r) {
  const vec3 away = x - record.place.position, eye(r.camera().to_world[3]);
  const float least = k_least_pixels * 2 * std::tan(0.5f * r.camera().yfov) / float(r.film().height()) *
                      distance(record.place.position, eye);
  const float off_plane = record.lesser_radius <= 1.001f * least ? k_off_plane_least : k_off_plane;
  if (record.radius <= 0 ||
      std::abs(dot(away, n + record.place.normal)) > 2 * off_plane * record.lesser_radius)
    return 0;
  const float far = test::far_of(record, x);
  const float turned = std::sqrt(std::max(0.0f, 1 - dot(n, record.place.normal)) / k_tolerance);
  return std::max(0.0f, 1 - std::max(far, turned));
}

/// Weights of all records; all zero where the nearest record whose disc contains the point has no light, so
/// that paths gather.
std::vector<float> weights(const std::vector<Record>& all, const vec3& x, const vec3& n,
                           const session::Renderer& r) {
  std::vector<float> found;
  float lit = INFINITY, crowded = INFINITY;
  for (const Record& record : all) {
    const float w = weight(record, x, n, r);
    float& nearest = record.crowded ? crowded : lit;
    if (w > 0) nearest = std::min(nearest, distance(x, record.place.position));
    found.push_back(record.crowded ? 0 : w);
  }
  if (crowded < lit) found.assign(all.size(), 0);
  return found;
}

/// One renderer for all cases: a Cornell box with secondary and tertiary light cached, finished.
session::Renderer& bed() {
  static const std::unique_ptr<session::Renderer> renderer = [] {
    auto r = std::make_unique<session::Renderer>(test::renderer_options(true));
    r->set_size(k_size, k_size);
    r->load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
    for (const auto& [key, value] : {std::pair{"components.secondary", "cache"},
                                     {"components.tertiary", "cache"},
                                     {"cache.min_radius", "3"},
                                     {"cache.gather", "true"},
                                     {"cache.rays", "64"},
                                     {"cache.max_rays", "64"},
                                     {"cache.error", "0.6"},
                                     {"samples", "4"}})
      r->settings().set(key, value);
    r->apply_settings();
    return r;
  }();
  renderer->overlays().inspect({});
  for (const char* key : {"overlay.records", "overlay.normals", "overlay.overlap"})
    renderer->settings().set(key, "false");
  renderer->apply_settings();
  while (renderer->step()) {
  }
  return *renderer;
}

Inspection inspect_pixel(session::Renderer& r, uint32_t x, uint32_t y) {
  r.overlays().inspect(vec2((float(x) + 0.5f) / k_size, (float(y) + 0.5f) / k_size));
  r.output().picture(false);
  return test::cache_report(r)->inspection;
}

/// Changed pixels of a picture, in raster order.
std::vector<uint32_t> changed(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  std::vector<uint32_t> list;
  for (uint32_t p = 0; p < k_size * k_size; ++p)
    if (!std::equal(a.begin() + 4 * p, a.begin() + 4 * p + 4, b.begin() + 4 * p)) list.push_back(p);
  return list;
}

vec2 place_of(uint32_t pixel) { return {float(pixel % k_size) + 0.5f, float(pixel / k_size) + 0.5f}; }

}  // namespace

TEST_CASE("an unused cache has no report, and an inspection before the first sample finds no surface") {
  session::Renderer r(test::renderer_options(false, {}, true));
  CHECK(test::cache_report(r) == nullptr);
  r.set_size(32, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  r.overlays().inspect(vec2(0.5f, 0.5f));
  r.output().picture(false);
  CHECK(test::cache_report(r) == nullptr);
  r.settings().set("components.tertiary", "cache");
  r.settings().set("overlay.normals", "true");
  r.apply_settings();
  r.output().picture(false);
  const auto report = test::cache_report(r);
  REQUIRE(report);
  CHECK(report->looked_at == vec2(0.5f, 0.5f));
  CHECK_FALSE(report->inspection.solid);
  CHECK_FALSE(report->overlap.has_value());
  CHECK(report->status.passes.empty());

  // During the build the coarse film provides the surfaces.
  REQUIRE(r.previews().draw());
  while (test::cache(r)->status().records == 0) REQUIRE(r.step());
  REQUIRE_FALSE(test::cache(r)->ready());
  REQUIRE(r.samples() == 0);
  size_t served = 0;
  const std::vector<Record> all = test::cache(r)->records().read();
  for (const float down : {0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 0.7f, 0.8f, 0.9f})
    for (const float right : {0.1f, 0.2f, 0.4f, 0.5f, 0.6f, 0.8f, 0.9f}) {
      r.overlays().inspect(vec2(right, down));
      r.output().picture(true);
      const Inspection found = test::cache_report(r)->inspection;
      if (!found.solid) continue;
      uint32_t expected = 0;
      const std::vector<Record> placed(all.begin(), all.begin() + test::cache(r)->status().records);
      for (const float w : weights(placed, found.surface.position, found.surface.normal, r))
        expected += w > 0;
      CHECK(found.count == expected);
      served += found.count > 0;
    }
  CHECK(served > 4);
  CHECK_FALSE(test::cache_report(r)->overlap.has_value());
}

TEST_CASE("the inspected records of a pixel are those with a weight computed on the host") {
  session::Renderer& r = bed();
  const std::vector<Record> all = test::cache(r)->records().read();
  REQUIRE(all.size() > 100);
  const scene::Camera camera = r.camera();
  size_t solid = 0, listed = 0, unders = 0;
  for (uint32_t y = 3; y < k_size; y += 18)
    for (uint32_t x = 4; x < k_size; x += 22) {
      const Inspection found = inspect_pixel(r, x, y);
      INFO("pixel " << x << " " << y);
      REQUIRE(found.x == x);
      REQUIRE(found.y == y);
      // Picking in the scene gives the true surface; pixels on edges are means.
      const auto hit =
          session::pick(*r.scene(), camera, (float(x) + 0.5f) / k_size, (float(y) + 0.5f) / k_size, 1);
      if (!found.solid) continue;
      ++solid;
      if (hit && length(hit->position - found.surface.position) > 3 * found.surface.size) continue;
      CHECK(length(found.surface.normal) == Approx(1).margin(1e-4));
      double sum = 0;
      const std::vector<float> expected = weights(all, found.surface.position, found.surface.normal, r);
      for (const float w : expected) sum += double(w);
      // At the very border of all records rounding decides.
      if (found.count > 0 && sum < 1e-4) continue;
      size_t serve = 0;
      for (const auto& s : found.serving) {
        REQUIRE(s.record < all.size());
        CHECK(s.weight == Approx(expected[s.record] / sum).margin(1e-4));
        if (expected[s.record] > 0) ++serve;
        // Its centre in the picture, picked, gives the same ray.
        const auto there = session::pick(*r.scene(), camera, s.at.x / k_size, s.at.y / k_size, 1);
        const vec3 centre = all[s.record].place.position;
        if (there && s.at.x > 0 && s.at.x < k_size && s.at.y > 0 && s.at.y < k_size) {
          // On the ray: at its depth the ray is at the centre.
          const vec3 eye(camera.to_world[3]), to_hit = normalize(there->position - eye);
          CHECK(length(cross(to_hit, centre - eye)) < 2e-3f * length(centre - eye));
        }
        ++listed;
      }
      // No record is missing, except at the border of validity, where rounding decides.
      for (size_t i = 0; i < all.size(); ++i)
        if (expected[i] > 1e-5f)
          CHECK(std::any_of(found.serving.begin(), found.serving.end(),
                            [&](const auto& s) { return s.record == i; }));
      CHECK(found.count == found.serving.size());
      CHECK(serve + 1 >= found.count);
      CHECK(std::is_sorted(found.serving.begin(), found.serving.end(),
                           [](const auto& a, const auto& b) { return a.weight > b.weight; }));
      if (found.under) {
        ++unders;
        const Record& u = found.under->record;
        CHECK(u.place.position == all[found.under->index].place.position);
        CHECK(u.rays == all[found.under->index].rays);
        CHECK(u.radius == all[found.under->index].radius);
        const float from = length(u.place.position - found.surface.position);
        CHECK(from <= u.radius);
        for (const Record& other : all)
          if (dot(other.place.normal, found.surface.normal) > 0.99f &&
              test::far_of(other, found.surface.position) < 1)
            CHECK(from <= length(other.place.position - found.surface.position) + 1e-5f);
      }
    }
  CHECK(solid > 80);
  CHECK(listed > 80);
  CHECK(unders > 40);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("the reported overlap of the picture equals that of its pixels, counted on the host") {
  session::Renderer& r = bed();
  r.output().picture(false);
  const auto report = test::cache_report(r);
  REQUIRE(report->overlap);
  const irradiance_cache::Overlap& reported = *report->overlap;
  const std::vector<Record> all = test::cache(r)->records().read();
  const film::Image image = r.image();
  uint64_t pixels = 0, served = 0, sum = 0;
  uint32_t most = 0;
  std::vector<uint32_t> histogram(reported.histogram.size(), 0);
  for (uint32_t p = 0; p < k_size * k_size; ++p) {
    const vec2 at = place_of(p) / float(k_size);
    const auto hit = session::pick(*r.scene(), r.camera(), at.x, at.y, 1);
    // Normals are means; at edges they belong to no surface.
    if (!hit || image.normal[p] == vec3(0)) continue;
    uint32_t count = 0;
    for (const float w : weights(all, hit->position, image.normal[p], r)) count += w > 0;
    ++pixels, served += count > 0, sum += count, most = std::max(most, count);
    ++histogram[std::min<size_t>(count, histogram.size() - 1)];
  }
  INFO(reported.pixels << " pixels, " << reported.served << " covered by " << reported.mean << ", "
                       << reported.most << " at most; by hand " << pixels << ", " << served << ", "
                       << double(sum) / double(served) << ", " << most);
  CHECK(served > 1000);
  CHECK(double(reported.pixels) == Approx(double(pixels)).epsilon(0.003));
  CHECK(double(reported.served) == Approx(double(served)).epsilon(0.01));
  CHECK(reported.mean == Approx(double(sum) / double(served)).epsilon(0.01));
  CHECK(std::abs(int(reported.most) - int(most)) <= 1);
  CHECK(std::accumulate(reported.histogram.begin(), reported.histogram.end(), 0ull) == reported.pixels);
  for (size_t i = 0; i < histogram.size(); ++i)
    CHECK(std::abs(int(reported.histogram[i]) - int(histogram[i])) < int(pixels / 100));
}

TEST_CASE("on a normal map inspection reports lookups on the smooth surface, and those without records") {
  for (const float degrees : {12.0f, 45.0f}) {
    INFO(degrees << " degrees");
    session::Renderer r(test::renderer_options(true));
    r.set_size(64, 64);
    scene::Scene room = test::mapped_room(degrees);
    r.set_scene(std::make_shared<scene::Scene>(room));
    test::set(r, {{"components.secondary", "cache"}, {"components.tertiary", "cache"}, {"samples", "2"}});
    test::finish(r);
    const irradiance_cache::Overlap reported = *test::cache_report(r)->overlap;
    CHECK(reported.pixels == 64 * 64);
    // Three quarters of the texels are tilted; records bridge 12 degrees, not 45.
    const double unserved = double(reported.histogram[0] - reported.gathered) / double(reported.pixels);
    INFO(unserved << " without records");
    if (degrees < 20)
      CHECK(unserved < 0.01);
    else
      CHECK(unserved == Approx(0.75).margin(0.03));
    size_t in_vain = 0, inspected = 0;
    for (const float x : {0.13f, 0.31f, 0.44f, 0.58f, 0.71f, 0.9f})
      for (const float y : {0.11f, 0.27f, 0.4f, 0.63f, 0.77f, 0.92f}) {
        r.overlays().inspect(vec2(x, y));
        r.output().picture(false);
        const Inspection found = test::cache_report(r)->inspection;
        REQUIRE(found.solid);
        CHECK(found.lookup != shared::k_lookup_none);
        CHECK(found.surface.normal == vec3(0, 0, 1));
        CHECK(found.surface.position.z == Approx(-0.98).margin(1e-5));
        CHECK((found.count > 0) == (found.lookup == shared::k_lookup_possible));
        in_vain += found.lookup == shared::k_lookup_too_steep, ++inspected;
      }
    if (degrees < 20)
      CHECK(in_vain == 0);
    else
      CHECK(in_vain > inspected / 2);
    // A metal has no lookups, and does not count.
    scene::Material metal = room.materials[2];
    metal.metallic = 1;
    r.set_material(2, metal);
    test::finish(r);
    r.overlays().inspect(vec2(0.5f, 0.5f));
    r.output().picture(false);
    CHECK(test::cache_report(r)->inspection.lookup == shared::k_lookup_none);
    CHECK(test::cache_report(r)->inspection.count == 0);
    CHECK(test::cache_report(r)->overlap->pixels == 0);
    CHECK(r.device().validation_messages() == 0);
  }
}

TEST_CASE(
    "records of directly visible points are reported even if only later vertices read them, also after "
    "loading") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(48, 48);
  r.set_scene(std::make_shared<scene::Scene>(test::PanelRoom().s));
  test::set(r, {{"components.tertiary", "cache"}, {"samples", "2"}});
  test::finish(r);
  const irradiance_cache::Overlap reported = *test::cache_report(r)->overlap;
  CHECK(reported.pixels == 48 * 48);
  CHECK(reported.served > reported.pixels / 2);
  // A loaded cache measures the picture on request, without a build pass.
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("lucerna-overlap-{}.cache", getpid());
  r.solvers().save("cache", file);
  r.restart();
  r.solver_load("cache", file);
  std::filesystem::remove(file);
  test::finish(r);
  REQUIRE(test::cache(r)->status().loaded > 0);
  const uint64_t rays = r.stats().rays;
  CHECK(test::cache_report(r)->overlap->histogram == reported.histogram);
  CHECK(r.stats().rays == rays);
}

TEST_CASE("lines lead from the pixel to the records that it reads, and nowhere else") {
  session::Renderer& r = bed();
  const std::vector<uint8_t> plain = r.output().picture(false);
  // Distance of a point from the line to a record, in pixels.
  const auto from_line = [](const vec2& p, const vec2& a, const vec2& b) {
    const vec2 along = b - a;
    const float t = std::clamp(dot(p - a, along) / std::max(dot(along, along), 1e-9f), 0.0f, 1.0f);
    return length(p - a - t * along);
  };
  // A pixel with a record whose centre is some distance away, with nothing else drawn near the middle of the
  // line: neither the ring nor other lines.
  Inspection found;
  vec2 here(0), centre(0);
  for (uint32_t y = k_size - 5; y > k_size / 3 && centre == vec2(0); y -= 5)
    for (uint32_t x = 10; x < k_size - 10 && centre == vec2(0); x += 5) {
      found = inspect_pixel(r, x, y);
      here = vec2(float(x), float(y)) + 0.5f;
      if (!found.solid || !found.under) continue;
      for (const auto& s : found.serving) {
        const vec2 middle = 0.5f * (here + s.at);
        const bool alone = std::all_of(found.serving.begin(), found.serving.end(), [&](const auto& o) {
          return o.record == s.record || from_line(middle, here, o.at) > 3.5f;
        });
        const bool inside = s.at.x > 2 && s.at.y > 2 && s.at.x < k_size - 2 && s.at.y < k_size - 2;
        const bool off_ring =
            std::abs(length(middle - found.under->at) - found.under->record.radius / found.surface.size) > 5;
        if (inside && alone && off_ring && s.weight > 0.02f && length(s.at - here) > 12) centre = s.at;
      }
    }
  REQUIRE(centre != vec2(0));
  const std::vector<uint8_t> lined = r.output().picture(false);
  CHECK(r.output().picture(false) == lined);
  // Inspection is not saved in a file, and saving does not end it.
  const auto png = std::filesystem::temp_directory_path() / fmt::format("lucerna-inspect-{}.png", getpid());
  r.output().save(png);
  const film::FilmImage kept = film::read_exr(png);
  std::filesystem::remove(png);
  size_t other = 0;
  for (uint32_t p = 0; p < k_size * k_size; ++p)
    other += std::abs(kept.channels[0].second[p] - float(plain[4 * p]) / 255) > 0.004f;
  CHECK(other == 0);
  CHECK(r.output().picture(false) == lined);
  const auto off = [&](const vec2& p) {  // pixels from the nearest line
    float nearest = length(p - here);
    for (const auto& s : found.serving) nearest = std::min(nearest, from_line(p, here, s.at));
    return nearest;
  };
  const float ring = found.under ? 1.5f * found.under->record.radius / found.surface.size : 0;
  const std::vector<uint32_t> list = changed(plain, lined);
  CHECK(list.size() > 8);
  for (const uint32_t p : list) {
    INFO("pixel " << p % k_size << " " << p / k_size);
    CHECK((off(place_of(p)) < 6 || length(place_of(p) - found.under->at) < ring + 4));
  }
  // The picture has changed everywhere along the line.
  for (const float t : {0.0f, 0.25f, 0.5f, 0.6f, 0.75f, 1.0f}) {
    const vec2 at = glm::floor(here + t * (centre - here));
    const uint32_t p = uint32_t(at.y) * k_size + uint32_t(at.x);
    INFO("at " << t << ": pixel " << at.x << " " << at.y);
    CHECK(std::find(list.begin(), list.end(), p) != list.end());
  }
  r.overlays().inspect({});
  CHECK(r.output().picture(false) == plain);
  CHECK_FALSE(test::cache_report(r)->looked_at.has_value());
}

TEST_CASE("normals are drawn as short lines at the centres of visible records") {
  session::Renderer& r = bed();
  // From another position, so the blocks hide some of the records placed for the first camera.
  const scene::Camera kept = r.camera();
  scene::Camera moved = kept;
  moved.to_world[3] += vec4(-2, 1.2f, 0, 0);
  r.set_camera(moved);
  while (r.step()) {
  }
  const std::vector<uint8_t> plain = r.output().picture(false);
  r.settings().set("overlay.normals", "true");
  r.apply_settings();
  const std::vector<uint8_t> ticked = r.output().picture(false);
  CHECK(r.output().picture(false) == ticked);
  CHECK(test::cache(r)->ready());
  const std::vector<uint32_t> list = changed(plain, ticked);
  CHECK(list.size() > 100);
  // Centres of unhidden records, and the tips of their normals.
  const mat4 to_camera = glm::inverse(r.camera().to_world);
  const float half = std::tan(0.5f * r.camera().yfov);
  const auto project = [&](const vec3& x) {
    const vec3 c(to_camera * vec4(x, 1));
    return vec3((0.5f + 0.5f * vec2(c.x, -c.y) / (-c.z * half)) * float(k_size), -c.z);
  };
  const film::Image image = r.image();
  // From foot to tip; outside the picture their visibility is unknown.
  std::vector<std::pair<vec2, vec2>> seen, beyond;
  std::vector<vec2> hidden;  // feet
  for (const Record& record : test::cache(r)->records().read()) {
    const vec3 foot = project(record.place.position);
    if (foot.z <= 0) continue;
    const std::pair line(vec2(foot),
                         vec2(project(record.place.position + 0.6f * record.radius * record.place.normal)));
    if (foot.x < 0 || foot.y < 0 || foot.x >= k_size || foot.y >= k_size) {
      beyond.push_back(line);
      continue;
    }
    const float depth = image.depth[size_t(foot.y) * k_size + size_t(foot.x)];
    if (foot.z > 1.1f * depth) {
      hidden.emplace_back(foot);
      continue;
    }
    seen.push_back(line);
  }
  CHECK(seen.size() > 50);
  const auto off = [](const vec2& p, const auto& lines) {  // pixels from the nearest
    float nearest = 1e9f;
    for (const auto& [foot, tip] : lines) {
      const vec2 along = tip - foot;
      const float t = std::clamp(dot(p - foot, along) / std::max(dot(along, along), 1e-9f), 0.0f, 1.0f);
      nearest = std::min(nearest, length(p - foot - t * along));
    }
    return nearest;
  };
  size_t strays = 0, lone = 0;
  for (const uint32_t p : list) strays += off(place_of(p), seen) > 3;
  INFO(strays << " of " << list.size() << " pixels away from every normal");
  CHECK(strays <= list.size() / 100);
  for (const vec2& foot : hidden) {
    if (std::min(off(foot, seen), off(foot, beyond)) < 3.5f) continue;
    ++lone;
    const uint32_t p = uint32_t(foot.y) * k_size + uint32_t(foot.x);
    INFO("pixel " << p % k_size << " " << p / k_size);
    CHECK(std::find(list.begin(), list.end(), p) == list.end());
  }
  INFO(hidden.size() << " records hidden, " << lone << " away from other normals");
  CHECK(lone > 1);
  r.set_camera(kept);
}

TEST_CASE("the log of a build sums to the contents of the cache") {
  session::Renderer& r = bed();
  r.restart();
  while (r.step()) {
  }
  const auto report = test::cache_report(r);
  const irradiance_cache::CacheStatus& s = report->status;
  REQUIRE(s.passes.size() > 1);
  uint64_t records = 0, rays = 0;
  std::array<double, irradiance_cache::k_build_steps.size()> ms{};
  for (const irradiance_cache::CachePass& p : s.passes) {
    CHECK(p.complete);
    CHECK(p.paths > 0);
    CHECK(p.uncovered <= p.paths);
    CHECK(p.uncovered_world <= p.uncovered);
    records += p.records, rays += p.rays;
    for (size_t k = 0; k < ms.size(); ++k) ms[k] += p.ms[k];
  }
  CHECK(records == s.records);
  CHECK(records == test::cache(r)->records().size());
  CHECK(rays == s.rays);
  CHECK(report->room == test::cache(r)->records().capacity());
  for (size_t k = 0; k < ms.size(); ++k) {
    INFO(irradiance_cache::k_build_steps[k]);
    CHECK(ms[k] > 0);
  }
  // Steps are parts of the time of all stages.
  double stages = 0;
  for (const auto& stage : r.stats().stages) stages += stage.ms;
  CHECK(std::accumulate(ms.begin(), ms.end(), 0.0) - ms[size_t(irradiance_cache::BuildStep::choose)] <=
        stages);
  if (s.stop == irradiance_cache::StopReason::covered)
    CHECK(double(s.passes.back().uncovered) <=
          r.settings().real("cache.stop") * double(s.passes.back().paths));

  // Another view adds passes; a restart clears them.
  const size_t before = s.passes.size();
  scene::Camera moved = r.camera();
  const scene::Camera kept = moved;
  moved.to_world[3] += vec4(0.1f, 0, 0, 0);
  r.set_camera(moved);
  while (r.step()) {
  }
  CHECK(test::cache(r)->status().passes.size() > before);
  CHECK(test::cache(r)->status().passes[before].number == 0);
  r.set_camera(kept);
  r.restart();
  CHECK(test::cache(r)->status().passes.empty());
}

TEST_CASE("detail of the geometry is dark on walls and bright at edges, and wider at coarser levels") {
  session::Renderer& r = bed();
  r.settings().set("overlay.discontinuity", "off");
  r.apply_settings();
  const std::vector<uint8_t> plain = r.output().picture(false);
  const auto bright_share = [&](const char* of, const char* level) {
    r.settings().set("overlay.discontinuity", of);
    r.settings().set("overlay.discontinuity_level", level);
    r.apply_settings();
    const std::vector<uint8_t> seen = r.output().picture(false);
    CHECK(seen != plain);
    uint32_t bright = 0;
    for (uint32_t p = 0; p < k_size * k_size; ++p) bright += seen[4 * p] > 150;
    return double(bright) / (k_size * k_size);
  };
  const double fine = bright_share("geometry", "0"), coarse = bright_share("geometry", "4");
  const double light = bright_share("irradiance", "0");
  INFO(fine << " of the picture bright, " << coarse << " of it at level 4, " << light << " by irradiance");
  CHECK(fine > 0.01);
  CHECK(fine < 0.1);
  CHECK(coarse > 4 * fine);
  CHECK(light < fine);
  r.settings().set("overlay.discontinuity", "off");
  r.apply_settings();
  CHECK(r.output().picture(false) == plain);
}

TEST_CASE("the candidates chosen in a pass can be read until the next pass") {
  session::Renderer& r = bed();
  r.restart();
  while (test::cache(r)->placement().tried.empty()) REQUIRE(r.step());
  const irradiance_cache::PlacementShown all = test::cache(r)->placement();
  const irradiance_cache::CachePass& pass = test::cache(r)->status().passes.back();
  CHECK(all.candidates.size() == pass.candidates);
  CHECK(all.cluster.size() == pass.candidates);
  CHECK(all.tried.size() == pass.tried);
  CHECK(std::is_sorted(all.cluster.begin(), all.cluster.end()));
  // The picture proposes candidates by dithering: a small share of its pixels, all on visible surfaces.
  size_t screen = 0;
  for (const irradiance_cache::Place& p : all.candidates) screen += p.origin == shared::k_origin_screen;
  CHECK(screen == pass.screen);
  CHECK(screen > 100);
  CHECK(screen < k_size * k_size / 8);
  while (r.step()) {
  }
}

}  // namespace cache_inspect_tests
