// links: session
// Pictures with the irradiance cache compared with path-traced ones, for each component.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/rooms.h"

namespace cache_tests {

using namespace lucerna;
using test::identical, test::k_cached, test::mean, test::Settings;

namespace {

/// Root mean square difference of the means of 8x8 blocks, relative to the mean.
double block_error(const test::Result& a, const test::Result& b, int component, uint32_t width) {
  const auto& x = a.image.components[component];
  const auto& y = b.image.components[component];
  const uint32_t across = width / 8, down = static_cast<uint32_t>(x.size()) / width / 8;
  double squares = 0;
  for (uint32_t v = 0; v < down; ++v)
    for (uint32_t u = 0; u < across; ++u) {
      double difference = 0;
      for (uint32_t i = 0; i < 64; ++i) {
        const size_t at = size_t{v * 8 + i / 8} * width + u * 8 + i % 8;
        difference += (luminance(x[at]) - luminance(y[at])) / 64;
      }
      squares += difference * difference;
    }
  return std::sqrt(squares / (across * down)) / mean(y);
}

/// A closed room, 2 m wide, divided by a wall 1 mm thick that ends 10 cm below the ceiling; a panel lights
/// one half. The camera is on the wall's edge and looks down at both floors.
scene::Scene divided_room() {
  test::PanelRoom room(vec3(0), true, 0.001f);
  room.wall(-1, 1, 0.9f, 0.001f);
  return room.s;
}

/// The same room without the wall; its left and right sides are rough metal, so much of the light on a
/// surface has been reflected by metal.
scene::Scene metal_room() {
  scene::Scene s = test::PanelRoom(vec3(0), true, 0.001f).s;
  s.materials.push_back(s.materials[0]);
  s.materials[2].base_color = vec4(0.9f, 0.9f, 0.9f, 1);
  s.materials[2].metallic = 1, s.materials[2].roughness = 0.4f;
  for (const int side : {4, 5}) s.meshes[side].primitives[0].material = 2;
  return s;
}

/// The same with a block of rough glass between floor and ceiling, which transmits much of the light.
scene::Scene glass_room() {
  test::PanelRoom room(vec3(0), true, 0.001f);
  scene::Material glass;
  glass.metallic = 0, glass.roughness = 0.3f, glass.transmission = 1, glass.thickness = 1;
  room.s.materials.push_back(glass);
  const vec3 lo(-0.6f, 0.2f, -0.5f), x(0.9f, 0, 0), y(0, 0.3f, 0), z(0, 0, 1);
  room.quad(lo, x, z, 2), room.quad(lo + y, z, x, 2);
  room.quad(lo, y, x, 2), room.quad(lo + z, x, y, 2);
  room.quad(lo, z, y, 2), room.quad(lo + x, y, z, 2);
  return room.s;
}

const test::Render k_cornell{
    .scene = "cornell", .width = 64, .height = 64, .samples = 16, .settings = {{"seed", "3"}}};
const test::Result& cornell_by_paths() {
  static const test::Result path = [] {
    test::Render r = k_cornell;
    r.samples = 512;
    return test::render(r);
  }();
  return path;
}

}  // namespace

TEST_CASE("the cache computes the light of its components and changes no other") {
  const test::Result& path = cornell_by_paths();
  test::Render r = k_cornell;
  const test::Result few = test::render(r);
  r.settings.insert(k_cached.begin(), k_cached.end());
  r.settings["cache.gather"] = "false";  // gathering uses other paths
  const test::Result cached = test::render(r);
  CHECK(cached.validation_messages == 0);
  CHECK(cached.stats.dropped == 0);
  CHECK(identical(few.image.components[0], cached.image.components[0]));
  CHECK(identical(few.image.components[3], cached.image.components[3]));
  for (const int c : {1, 2}) {
    INFO("component " << c << ": " << mean(cached.image.components[c]) << " of "
                      << mean(path.image.components[c]) << ", blocks " << block_error(cached, path, c, 64)
                      << ", path traced with as many samples " << block_error(few, path, c, 64));
    CHECK(mean(cached.image.components[c]) == Approx(mean(path.image.components[c])).epsilon(0.03));
    CHECK(block_error(cached, path, c, 64) < 0.08);
  }
}

TEST_CASE(
    "tertiary light alone is looked up at the second diffuse vertex, behind path-traced secondary light") {
  // The noise of either is below 0.5 % of the mean; without the light reflected by metal it would be 11 %
  // less.
  for (const bool glass : {false, true}) {
    const scene::Scene room = glass ? glass_room() : metal_room();
    const film::Image
        path = test::render(room, {}, 256, 32).image,
        cached =
            test::render(room, {{"components.tertiary", "cache"}, {"cache.gather", "false"}}, 256, 32).image;
    for (const int c : {0, 1, 3}) {
      INFO((glass ? "glass" : "metal") << ", component " << c);
      CHECK(identical(path.components[c], cached.components[c]));
    }
    INFO((glass ? "glass: " : "metal: ") << mean(cached.components[2]) << " of " << mean(path.components[2]));
    CHECK(mean(cached.components[2]) == Approx(mean(path.components[2])).epsilon(0.03));
  }
}

TEST_CASE("records are looked up in mirrors too, whatever other component is off") {
  // The blurred mirror of the floor shows walls whose light comes from records only; paths to them carry
  // nothing.
  const Settings off{{"components.primary", "off"}, {"components.caustic", "off"}, {"seed", "4"}};
  test::Render r{.scene = "teapot", .width = 64, .height = 64, .samples = 512, .settings = off};
  const test::Result path = test::render(r);
  r.samples = 64;
  r.settings.insert(k_cached.begin(), k_cached.end());
  const test::Result cached = test::render(r);
  for (const int c : {1, 2}) {
    // The lowest quarter is almost only floor.
    const auto floor = [&](const test::Result& result) {
      const auto& layer = result.image.components[c];
      return mean({layer.begin() + 48 * 64, layer.end()});
    };
    INFO("component " << c << ": " << floor(cached) << " of " << floor(path) << ", blocks "
                      << block_error(cached, path, c, 64));
    CHECK(floor(cached) == Approx(floor(path)).epsilon(0.03));
    CHECK(block_error(cached, path, c, 64) < 0.12);
  }
}

TEST_CASE("records that read records compute the same light as records with full-length paths") {
  test::Render r{.scene = "teapot",
                 .width = 64,
                 .height = 64,
                 .samples = 16,
                 .settings = {{"seed", "5"},
                              {"components.secondary", "cache"},
                              {"cache.noise", "0.03"},
                              {"cache.min_radius", "1"}}};
  const test::Result traced = test::render(r);
  r.settings["components.tertiary"] = "cache";
  r.validated = false;
  const test::Result recursive = test::render(r);
  CHECK(recursive.stats.rays < traced.stats.rays);
  for (const int c : {1, 2}) {
    INFO("component " << c << ": " << mean(recursive.image.components[c]) << " of "
                      << mean(traced.image.components[c]) << ", blocks "
                      << block_error(recursive, traced, c, 64));
    CHECK(mean(recursive.image.components[c]) == Approx(mean(traced.image.components[c])).epsilon(0.02));
    CHECK(block_error(recursive, traced, c, 64) < 0.05);
  }
}

TEST_CASE("components that are off stay off") {
  test::Render r{.scene = "cornell", .width = 32, .height = 32, .samples = 4, .settings = k_cached};
  r.settings["components.tertiary"] = "off";
  const test::Result no_tertiary = test::render(r);
  CHECK(mean(no_tertiary.image.components[1]) > 0);
  CHECK(mean(no_tertiary.image.components[2]) == 0);
  r.settings["components.tertiary"] = "cache";
  r.settings["components.primary"] = "off";
  const test::Result no_primary = test::render(r);
  CHECK(mean(no_primary.image.components[0]) == 0);
  CHECK(mean(no_primary.image.components[2]) > 0);
}

TEST_CASE("a cached picture does not depend on the size of work items") {
  test::Render r{.scene = "cornell", .width = 28, .height = 28, .samples = 4, .settings = k_cached};
  // Records get all levels, and those of the last level more rays than the smaller batch has paths.
  r.settings["cache.rays"] = "64", r.settings["cache.noise"] = "0.005";
  const test::Result whole = test::render(r);
  r.validated = false;
  r.settings["path.batch"] = "2048";
  const test::Result cut = test::render(r);
  for (int c = 0; c < 4; ++c) CHECK(identical(whole.image.components[c], cut.image.components[c]));
  r.settings["seed"] = "9";
  const test::Result other = test::render(r);
  CHECK_FALSE(identical(whole.image.components[1], other.image.components[1]));
}

TEST_CASE("records do not depend on how many blocks are probed at once, with several passes per pixel") {
  test::Render r{.scene = "cornell", .width = 24, .height = 24, .samples = 1, .settings = k_cached};
  r.settings.insert(
      {{"cache.rays", "64"}, {"cache.error", "0.1"}, {"cache.min_radius", "0.5"}, {"cache.stop", "0.0001"}});
  const test::Result whole = test::render(r);
  r.settings["path.batch"] = "2048";
  const test::Result cut = test::render(r);
  for (int c = 0; c < 4; ++c) CHECK(identical(whole.image.components[c], cut.image.components[c]));
}

TEST_CASE("records with split-sphere radii compute the same light, independent of work items") {
  const test::Result& path = cornell_by_paths();
  test::Render r = k_cornell;
  r.settings.insert(k_cached.begin(), k_cached.end());
  r.settings["cache.metric"] = "split-sphere";
  const test::Result cached = test::render(r);
  CHECK(cached.validation_messages == 0);
  for (const int c : {1, 2}) {
    INFO("component " << c << ": " << mean(cached.image.components[c]) << " of "
                      << mean(path.image.components[c]) << ", blocks " << block_error(cached, path, c, 64));
    CHECK(mean(cached.image.components[c]) == Approx(mean(path.image.components[c])).epsilon(0.03));
    CHECK(block_error(cached, path, c, 64) < 0.08);
  }
  r.validated = false;
  r.width = r.height = 32, r.samples = 4;
  const test::Result whole = test::render(r);
  r.settings["path.batch"] = "2048";
  const test::Result cut = test::render(r);
  for (int c = 0; c < 4; ++c) CHECK(identical(whole.image.components[c], cut.image.components[c]));
  // They differ from records with elliptical areas.
  r.settings.erase("cache.metric"), r.settings.erase("path.batch");
  CHECK_FALSE(identical(whole.image.components[2], test::render(r).image.components[2]));
}

TEST_CASE("smoothed records are nearer to the truth; switched off, they are as gathered") {
  const scene::Scene room = test::PanelRoom(vec3(0), true, 0.001f).s;
  // Few rays and no further ones: 14 % noise.
  Settings few = k_cached;
  few["cache.rays"] = few["cache.max_rays"] = "64", few["cache.smooth"] = "true";
  Settings raw = few;
  raw["cache.smooth"] = "false";
  test::CacheRenderer bed(room, 48);
  bed.set(few), bed.set({{"samples", "64"}});
  const film::Image smooth = bed.finish();
  const irradiance_cache::RawRecords records = bed.records();
  const uint64_t rays = bed.status().rays;
  bed.set(raw);
  CHECK(test::cache(bed.r)->ready());
  const film::Image gathered = bed.finish();
  CHECK(bed.status().rays == rays);
  CHECK(test::identical(bed.records(), records));
  CHECK_FALSE(identical(gathered.components[2], smooth.components[2]));
  bed.set(few);
  const film::Image again = bed.finish();
  for (int c = 0; c < 4; ++c) CHECK(identical(again.components[c], smooth.components[c]));
  // The same as without a change.
  test::CacheRenderer fresh(room, 48);
  fresh.set(raw), fresh.set({{"samples", "64"}});
  const film::Image alone = fresh.finish();
  for (int c = 0; c < 4; ++c) CHECK(identical(alone.components[c], gathered.components[c]));

  const film::Image truth = test::render(room, {}, 1024, 48).image;
  const auto error = [&](const film::Image& image, int c) {
    return block_error({.image = image}, {.image = truth}, c, 48);
  };
  for (const int c : {1, 2}) {
    INFO("component " << c << ": " << error(smooth, c) << ", as gathered " << error(gathered, c));
    CHECK(error(smooth, c) < 0.8 * error(gathered, c));
    CHECK(std::abs(mean(smooth.components[c]) / mean(truth.components[c]) - 1) < 0.03);
  }
}

TEST_CASE("light does not leak through a wall of one millimetre") {
  // Maximum radii, so only the other limits stop records from reaching through.
  Settings wide = k_cached;
  wide["cache.error"] = "1", wide["cache.max_radius"] = "1";
  const film::Image path = test::render(divided_room(), {}, 512, 64).image;
  // Columns of the picture by their distance from the wall in the middle: the floor on its left (dark) and on
  // its right.
  const auto column_mean = [](const film::Image& image, int component, uint32_t from, uint32_t to) {
    test::Mean mean;
    for (uint32_t y = 16; y < 48; ++y)
      for (uint32_t x = from; x < to; ++x) {
        const size_t at = size_t{y} * 64 + x;
        const double all = luminance(image.components[component][at]),
                     odd = luminance(image.odd_half[component][at]);
        mean.value += all, mean.noise += (all - odd) * (all - odd);
      }
    const double pixels = 32.0 * (to - from);
    return test::Mean{mean.value / pixels, std::sqrt(mean.noise) / pixels};
  };
  for (const char* metric : {"split-sphere", "hessian"}) {
    wide["cache.metric"] = metric;
    const film::Image cached = test::render(divided_room(), wide, 16, 64, false).image;
    for (const int c : {1, 2})
      for (const auto& [from, to] : {std::pair{8u, 20u}, {20u, 26u}, {26u, 30u}, {34u, 38u}, {38u, 44u}}) {
        const test::Mean truth = column_mean(path, c, from, to);
        const test::Mean found = column_mean(cached, c, from, to);
        const double value = found.value, noise = std::hypot(truth.noise, found.noise);
        INFO(metric << ", component " << c << ", columns " << from << " to " << to << ": " << value << " of "
                    << truth.value << " +- " << noise);
        CHECK(truth.value > 0);
        // Noise of the paths, the error of few and wide records, and the leak allowed from the light on the
        // other side.
        const double leak = 0.0015 * column_mean(path, c, 38, 44).value;
        CHECK(std::abs(value - truth.value) < 4 * noise + 0.03 * truth.value + leak);
      }
  }
  // The dark half is dark, so leaked light would show.
  CHECK(column_mean(path, 1, 20, 26).value < 0.02 * column_mean(path, 1, 38, 44).value);
}

}  // namespace cache_tests
