// links: session
// Difficult cases for an irradiance cache: walls between light and dark, corners, normal maps, coordinates
// far from the origin, a low record limit, empty scenes. The picture agrees with path tracing within a stated
// bias, because points that no record covers are path traced.
#include <catch2/catch.hpp>
#include <cmath>

#include "base/log.h"
#include "support/complaints.h"
#include "support/render.h"
#include "support/rooms.h"

namespace cache_robust_tests {

using namespace lucerna;
using irradiance_cache::StopReason;
using test::block_mean, test::Mean, test::Result, test::Settings;

namespace {

constexpr uint32_t k_size = 32;

/// Without the training rays of learned lights, which are a large share of few samples and would distort ray
/// counts.
const Settings k_paths{{"lights.sampling", "power"}};
/// One branch, so ray counts show where records are used.
const Settings k_both = test::dense_records({{"components.secondary", "cache"},
                                             {"lights.sampling", "power"},
                                             {"components.tertiary", "cache"},
                                             {"cache.max_records", "20000"},
                                             {"cache.branches", "1"}});
/// Maximum radii, so only the other limits stop records from reaching too far.
const Settings k_wide = test::dense_records({{"components.secondary", "cache"},
                                             {"lights.sampling", "power"},
                                             {"components.tertiary", "cache"},
                                             {"cache.max_records", "20000"},
                                             {"cache.error", "1"},
                                             {"cache.max_radius", "1"},
                                             {"cache.min_radius", "0.5"},
                                             {"cache.rays", "1024"},
                                             {"cache.max_rays", "1024"}});

using Room = test::PanelRoom;

Result render(const scene::Scene& scene, const Settings& settings, uint32_t samples) {
  return test::render(scene, settings, samples, k_size);
}

/// Rays per path of the picture, without preparation.
double rays_a_path(const Result& r) { return double(r.stats.rays - r.prepared_rays) / double(r.stats.paths); }

/// Every block of secondary and tertiary light agrees with path tracing within `bias` of it and the noise of
/// both: 4.5 standard errors, 3e-4 for all 32 together. Returns the root mean square error of the blocks
/// without noise, relative to the layers' means.
double compare(const Result& path, const Result& cached, double bias, uint32_t middle = 0) {
  double sum = 0;
  for (const int c : {1, 2}) {
    double squares = 0, mean = 0;
    for (uint32_t down = 0; down < k_size / 8; ++down)
      for (uint32_t across = 0; across < k_size / 8; ++across) {
        const Mean truth = block_mean(path.image, c, across, down, middle),
                   value = block_mean(cached.image, c, across, down, middle);
        const double noise = std::hypot(truth.noise, value.noise), off = value.value - truth.value;
        INFO("component " << c << ", block " << across << ", " << down << ": " << value.value << " of "
                          << truth.value << ", noise " << noise);
        CHECK(std::abs(off) <= bias * truth.value + 4.5 * noise);
        CHECK(truth.value > 0);
        squares += (off * off - noise * noise) / 16, mean += truth.value / 16;
      }
    sum += std::sqrt(std::max(0.0, squares)) / mean / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("light does not leak through walls, around their ends, or far from the origin") {
  struct Place {
    const char* what;
    vec3 at;
    float z0, z1, height, thickness;
  };
  for (const Place& p :
       {Place{"a sheet", {0, 0, 0}, -1, 1, 0.9f, 0},
        Place{"a millimetre, with a door", {0, 0, 0}, -1, 0.5f, 0.9f, 0.001f},
        Place{"five centimetres, ten kilometres away", {1e4f, 1e4f, -1e4f}, -1, 0.5f, 0.9f, 0.05f}}) {
    INFO(p.what);
    Room room(p.at);
    room.wall(p.z0, p.z1, p.height, p.thickness);
    Settings wide = k_wide;
    wide["lights.sampling"] = "power";  // no training rays of learned lights
    const Result path = render(room.s, {{"lights.sampling", "power"}}, 128),
                 cached = render(room.s, wide, 16);
    // A record covers at least half a pixel around it (cache.min_radius), whatever is in between: the columns
    // at the wall are excluded.
    const double off = compare(path, cached, 0.2, 1);
    INFO("off by " << off);
    CHECK(off < 0.06);
    CHECK(cached.cache.records > 50);
    // The left half is dark, so leaked light would show.
    CHECK(block_mean(path.image, 1, 1, 1).value < 0.5 * block_mean(path.image, 1, 2, 1).value);
    // Records are used: not all of it is path traced.
    CHECK(rays_a_path(cached) < 0.7 * rays_a_path(path));
  }
}

TEST_CASE("records in a medium see through it and cover nothing outside") {
  // An absorbing block of glass with index of refraction 1 covers half of the floor: inside it a corner of
  // two walls and an emissive panel.
  Room room;
  scene::Material glass;
  glass.metallic = 0, glass.roughness = 0, glass.transmission = 1, glass.ior = 1, glass.thickness = 1;
  glass.attenuation_color = vec3(0.2f, 0.6f, 0.9f), glass.attenuation_distance = 0.4f;
  room.s.materials.push_back(glass);
  const vec3 lo = room.at + vec3(-0.7f, 0.1f, -0.6f), x(1.2f, 0, 0), y(0, 0.7f, 0), z(0, 0, 1.2f);
  for (const auto& [a, u, v] : {std::array{lo, x, z}, std::array{lo + y, z, x}, std::array{lo, y, x},
                                std::array{lo + z, x, y}, std::array{lo, z, y}, std::array{lo + x, y, z}})
    test::add_quad(room.s, a, u, v, 2);
  test::add_quad(room.s, lo + vec3(0.1f, 0.05f, 0.1f), {0, 0, 1}, {1, 0, 0});
  test::add_quad(room.s, lo + vec3(0.1f, 0.05f, 0.1f), {0, 0.3f, 0}, {0, 0, 1});
  room.s.materials[0].double_sided = true;
  test::add_quad(room.s, lo + vec3(0.9f, 0.4f, 0.4f), {0.1f, 0, 0}, {0, 0, 0.1f}, 1);
  Settings settings = k_both;
  settings["cache.error"] = "0.15", settings["cache.noise"] = "0.02";
  settings["cache.min_radius"] = "1";  // otherwise all pixels of so small a picture are edges
  const Result path = render(room.s, k_paths, 512), cached = render(room.s, settings, 64);
  for (const int c : {1, 2})
    for (int channel = 0; channel < 3; ++channel) {
      double truth = 0, value = 0, squares = 0;
      for (size_t i = 0; i < path.image.samples.size(); ++i) {
        const double t = double(path.image.components[c][i][channel]),
                     v = double(cached.image.components[c][i][channel]);
        truth += t, value += v;
        squares += std::pow(t - double(path.image.odd_half[c][i][channel]), 2) +
                   std::pow(v - double(cached.image.odd_half[c][i][channel]), 2);
      }
      INFO("component " << c << ", channel " << channel << ": " << value / truth << ", noise "
                        << std::sqrt(squares) / truth);
      CHECK(std::abs(value - truth) <= 0.02 * truth + 4 * std::sqrt(squares));
      UNSCOPED_INFO("component " << c << ", channel " << channel << ": " << value / truth << ", noise "
                                 << std::sqrt(squares) / truth);
    }
  CHECK(rays_a_path(cached) < 0.8 * rays_a_path(path));
}

TEST_CASE("normal maps tilt record lookups up to a limit, and beyond it light is path traced") {
  double rays[3];
  int i = 0;
  for (const float degrees : {0.0f, 12.0f, 45.0f}) {
    INFO(degrees << " degrees");
    const scene::Scene room = test::mapped_room(degrees);
    const Result path = render(room, k_paths, 128), cached = render(room, k_both, 32);
    const double off = compare(path, cached, 0.08);
    INFO("off by " << off);
    CHECK(off < 0.05);
    rays[i++] = rays_a_path(cached) / rays_a_path(path);
  }
  INFO("rays per path over those of the path tracer: " << rays[0] << ", " << rays[1] << ", " << rays[2]);
  // Within the records' limit only lookups on the untilted wall are path traced; three quarters of the
  // strongly tilted one are.
  CHECK(rays[1] < rays[0] + 0.05);
  CHECK(rays[2] > rays[0] + 0.3);
}

TEST_CASE("the smaller the error bound, the closer the picture is to path tracing") {
  Room room;
  room.wall(-1, 0.5f, 0.6f, 0.1f);
  const Result path = render(room.s, k_paths, 512);
  double before = 1;
  // The bounds of radii, and the allowed error of records in a block and in total.
  struct Bound {
    const char *error, *least, *most;
    double block, all;
  };
  for (const auto& [error, least, most, block, all] : {Bound{"1", "16", "0.5", 4, 0.4},
                                                       {"0.4", "2", "0.1", 0.1, 0.02},
                                                       {"0.15", "0.5", "0.1", 0.05, 0.015}}) {
    INFO("error bound " << error);
    Settings settings = k_both;
    settings["cache.error"] = error, settings["cache.min_radius"] = least;
    settings["cache.max_radius"] = most;
    settings["cache.noise"] = "0.02", settings["cache.max_rays"] = "1024";
    settings["cache.gather"] = "false";  // tests interpolation only
    const Result cached = render(room.s, settings, 16);
    const double off = compare(path, cached, block);
    UNSCOPED_INFO("error bound " << error << ": " << cached.cache.records << " records, off by " << off);
    CHECK(off < all);
    // Remaining noise of the records.
    CHECK(off < std::max(0.015, 0.3 * before));
    before = off;
  }
}

TEST_CASE("a cache at its record limit reports it once, and light without records is path traced") {
  Room room;
  room.wall(-1, 0.5f, 0.6f, 0.1f);
  Settings settings = k_both;
  settings["cache.max_records"] = "40";
  const test::Complaints complaints;
  const Result path = render(room.s, k_paths, 128), cached = render(room.s, settings, 64);
  CHECK(cached.cache.stop == StopReason::records);
  CHECK(cached.cache.records == 40);
  CHECK(compare(path, cached, 0.1) < 0.04);
  REQUIRE(complaints.lines.size() == 1);
  CHECK_THAT(complaints.lines[0], Catch::Contains("the irradiance cache is full (40 records)") &&
                                      Catch::Contains("path traced") && Catch::Contains("cache.max_records"));
}

TEST_CASE("without diffuse surfaces or without lights a cache costs nothing and reports nothing") {
  const test::Complaints complaints;
  Room mirrors;
  mirrors.s.materials[0].metallic = 1, mirrors.s.materials[0].roughness = 0.2f;
  const Result none = render(mirrors.s, k_both, 4), same = render(mirrors.s, k_paths, 4);
  CHECK(none.cache.records == 0);
  CHECK(none.cache.rays == 0);
  CHECK(none.cache.stop == StopReason::covered);
  CHECK(none.image.components[0] == same.image.components[0]);

  const Result dark = render(Room(vec3(0), false).s, k_both, 4);
  CHECK(dark.cache.records == 0);
  CHECK(dark.cache.rays == 0);
  CHECK(dark.cache.stop == StopReason::dark);
  CHECK(dark.prepared_rays == 0);
  for (const auto& component : dark.image.components)
    for (const vec3& v : component) REQUIRE(v == vec3(0));

  // A lamp that is switched off: its records are relit when it is on again, wherever the camera is.
  session::Renderer r(test::renderer_options(true));
  r.set_size(24, 24);
  Room room(vec3(0), false);
  room.s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {0.5f, 0.8f, 0.5f}});
  r.set_scene(std::make_shared<scene::Scene>(room.s));
  r.settings().set("samples", "32");  // each reads one record; pixels are compared
  test::set(r, k_wide);
  test::set(r, {{"cache.gather", "false"}});
  const film::Image lit = test::finish(r);
  const uint32_t records = test::cache(r)->status().records;
  REQUIRE(records > 20);
  scene::Light lamp = room.s.lights[0];
  lamp.enabled = false;
  r.set_light(0, lamp);
  for (int move = 0; move < 2; ++move) {
    const film::Image off = test::finish(r);
    CHECK(test::cache(r)->ready());
    CHECK(test::cache(r)->status().rays == 0);
    CHECK(test::cache(r)->status().passes.size() <= 1);
    for (const auto& component : off.components)
      for (const vec3& v : component) REQUIRE(v == vec3(0));
    r.set_camera(room.s.cameras[0]);
  }
  test::finish(r);
  lamp.enabled = true;
  r.set_light(0, lamp);
  CHECK(test::cache(r)->status().relighting.records == records);
  const film::Image again = test::finish(r);
  for (size_t c = 0; c < 4; ++c)
    for (size_t i = 0; i < lit.samples.size(); ++i)
      CHECK(luminance(again.components[c][i]) ==
            Approx(luminance(lit.components[c][i])).epsilon(0.2).margin(0.01));
  CHECK(complaints.lines.empty());
}

}  // namespace cache_robust_tests
