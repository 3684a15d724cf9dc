// links: session
// Where an irradiance cache could go wrong: walls between light and dark, corners, normal maps, coordinates
// far from the origin, too little room, nothing to do. Everywhere the picture is that of the path tracer
// within a stated bias, because what no record can serve is path traced.
#include <catch2/catch.hpp>
#include <cmath>

#include "base/log.h"
#include "support/complaints.h"
#include "support/render.h"
#include "support/rooms.h"

using namespace lucerna;
using irradiance_cache::StopReason;
using test::block_mean, test::Mean, test::Result, test::Settings;

namespace {

constexpr uint32_t k_size = 32;

/// Without the rays that lights are learned from, which few samples have many of, whoever computes what.
const Settings k_paths{{"lights.sampling", "power"}};
/// One branch, so that rays tell where records serve.
const Settings k_both = test::dense_records({{"components.secondary", "cache"},
                                             {"lights.sampling", "power"},
                                             {"components.tertiary", "cache"},
                                             {"cache.max_records", "20000"},
                                             {"cache.branches", "1"}});
/// Radii as wide as they may be, so that only what limits them keeps records from reaching where they must
/// not.
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

/// Of the picture's.
double rays_a_path(const Result& r) { return double(r.stats.rays - r.prepared_rays) / double(r.stats.paths); }

/// Every block of secondary and tertiary light is the path tracer's within `bias` of it and the noise of
/// both: 4.5 standard errors, 3e-4 for all 32 of them together. Returns the root mean square of what blocks
/// are off by, the noise taken off, over the layers' means.
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
    wide["lights.sampling"] = "power";  // pilots take the same rays from either, of few samples a large share
    const Result path = render(room.s, {{"lights.sampling", "power"}}, 128),
                 cached = render(room.s, wide, 16);
    // A record serves half a pixel around it at least (cache.min_radius), through whatever stands there: what
    // the columns at the wall show is left out.
    const double off = compare(path, cached, 0.2, 1);
    INFO("off by " << off);
    CHECK(off < 0.06);
    CHECK(cached.cache.records > 50);
    // The left half is dark, so that light would be seen there.
    CHECK(block_mean(path.image, 1, 1, 1).value < 0.5 * block_mean(path.image, 1, 2, 1).value);
    // And it is looked up: not all of it is path traced.
    CHECK(rays_a_path(cached) < 0.7 * rays_a_path(path));
  }
}

TEST_CASE("records in a medium see through it, and serve nobody outside") {
  // An absorbing block of glass that refracts nothing, half in the floor's way: inside it a corner of two
  // walls and a panel that shines.
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
  settings["cache.min_radius"] = "1";  // else all of so small a picture is edges
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

TEST_CASE("normal maps tilt what records bring as far as they can, and beyond that light is path traced") {
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
  INFO("rays a path over those of the path tracer: " << rays[0] << ", " << rays[1] << ", " << rays[2]);
  // Within the records' reach nothing is traced that is not on the straight wall; three quarters of the steep
  // one are.
  CHECK(rays[1] < rays[0] + 0.05);
  CHECK(rays[2] > rays[0] + 0.3);
}

TEST_CASE("the smaller the error bound, the nearer the picture comes to the path tracer's") {
  Room room;
  room.wall(-1, 0.5f, 0.6f, 0.1f);
  const Result path = render(room.s, k_paths, 512);
  double before = 1;
  // Radii in all their bounds; what records may be off by in a block, and in all.
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
    settings["cache.gather"] = "false";  // what is interpolated is meant
    const Result cached = render(room.s, settings, 16);
    const double off = compare(path, cached, block);
    UNSCOPED_INFO("error bound " << error << ": " << cached.cache.records << " records, off by " << off);
    CHECK(off < all);
    // So much is left of records' noise.
    CHECK(off < std::max(0.015, 0.3 * before));
    before = off;
  }
}

TEST_CASE("a cache with too little room says so once, and what it cannot hold is path traced") {
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

TEST_CASE("with nothing diffuse, or nothing that shines, a cache costs nothing and says nothing") {
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

  // A lamp that goes off leaves records to be relit when it is back, wherever the camera has gone.
  session::Renderer r(test::renderer_options(true));
  r.set_size(24, 24);
  Room room(vec3(0), false);
  room.s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {0.5f, 0.8f, 0.5f}});
  r.set_scene(std::make_shared<scene::Scene>(room.s));
  r.settings().set("samples", "32");  // each reads one of the records that serve, and pixels are compared
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
