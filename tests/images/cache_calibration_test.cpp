// links: session
// Calibration of the error estimate of cached pictures: pictures of many seeds, each with its own records,
// are compared with a path-traced reference. The 90 % interval of a tile, which combines path noise, record
// noise and interpolation error, must contain the reference in 85 to 95 of 100 tiles.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "support/calibration.h"

namespace cache_calibration_tests {

using namespace lucerna;

namespace {

using test::Shot, test::shot_of;

struct Case {
  const char* scene;
  uint32_t width, height, samples, shots, reference;
};

struct Figures {
  size_t tested = 0, by_paths = 0, by_noise = 0, by_sum = 0;
  double estimated_paths = 0, estimated_records = 0, estimated_interpolation = 0, estimated = 0, truth = 0;
};

Figures measure(const Case& c) {
  session::Renderer renderer(test::renderer_options(false));
  renderer.set_size(c.width, c.height);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + c.scene + "/" + c.scene + ".gltf");
  test::Settings settings;
  settings["sampling.tile"] = "8", settings["cache.max_records"] = test::k_room;
  settings = test::dense_records(std::move(settings));
  settings["components.secondary"] = settings["components.tertiary"] = "path";
  // Components without a cache would hide the records' error under their noise, which has its own calibration
  // test.
  settings["components.primary"] = settings["components.caustic"] = "off";
  settings["seed"] = "4096";
  settings["samples"] = std::to_string(c.reference);
  settings["sampling.mode"] = "uniform";
  test::set(renderer, settings);
  const Shot reference = shot_of(renderer);
  const double own = reference.error.rms[0] * reference.error.rms[0];
  Figures f;
  settings["components.secondary"] = settings["components.tertiary"] = "cache";
  settings["samples"] = std::to_string(c.samples);
  for (uint32_t s = 0; s < c.shots; ++s) {
    settings["seed"] = std::to_string(s + 1);
    test::set(renderer, settings);
    const Shot shot = shot_of(renderer);
    const double mean = reference.error.luminance[0];
    double squares = 0;
    for (size_t i = 0; i < shot.luminance.size(); ++i)
      squares += std::pow(double{shot.luminance[i]} - reference.luminance[i], 2);
    f.truth += std::sqrt(squares / double(shot.luminance.size()) - own) / mean;
    f.estimated += shot.error.relative_sum();
    f.estimated_paths += shot.error.relative(0), f.estimated_records += shot.error.relative_lookup_noise();
    f.estimated_interpolation += shot.error.relative_interpolation();
    for (size_t t = 0; t < shot.tiles.size(); ++t) {
      film::TileError a = shot.tiles[t];
      const film::TileError& r = reference.tiles[t];
      if (a.heavy_tailed) continue;
      a = test::with_noise_of(a, r);
      const double off = std::abs(a.luminance - r.luminance);
      ++f.tested;
      f.by_paths += off <= film::student_90(a.degrees) * a.standard_error;
      f.by_sum += off <= a.half_width_90();
      a.lookups.interpolation = 0;
      f.by_noise += off <= a.half_width_90();
    }
  }
  return f;
}

}  // namespace

TEST_CASE("the estimated error of a cached picture is its true error") {
  // LUCERNA_CALIBRATION selects all scenes or one by name, which takes minutes. Default: the fastest one.
  const char* const wanted = std::getenv("LUCERNA_CALIBRATION");
  const std::string only = wanted ? wanted : "cornell";
  for (const Case& c : {Case{"cornell", 48, 48, 32, 6, 1024}, Case{"teapot", 48, 40, 32, 6, 4096},
                        Case{"studio", 64, 32, 32, 6, 4096}, Case{"sun-patch", 48, 40, 32, 6, 8192},
                        Case{"hall", 48, 32, 32, 6, 4096}, Case{"ajar", 48, 32, 32, 6, 16384}}) {
    if (only != "all" && only != c.scene) continue;
    const Figures f = measure(c);
    std::printf(
        "%-9s covered: paths %.1f %%, with records %.1f %%, sum %.1f %% of %zu tiles; rms estimated %.4f "
        "(paths "
        "%.4f, records %.4f, interpolation %.4f), true %.4f\n",
        c.scene, 100. * f.by_paths / f.tested, 100. * f.by_noise / f.tested, 100. * f.by_sum / f.tested,
        f.tested, f.estimated / c.shots, f.estimated_paths / c.shots, f.estimated_records / c.shots,
        f.estimated_interpolation / c.shots, f.truth / c.shots);
    INFO(c.scene);
    // 85 to 95 %, plus two standard errors for this number of independent tiles.
    const double tiles = double(f.tested), chance = 2 * std::sqrt(0.9 * 0.1 * tiles);
    CHECK(std::abs(double(f.by_sum) - 0.9 * tiles) < 0.05 * tiles + chance);
    CHECK(f.estimated > 0.8 * f.truth);
    CHECK(f.estimated < 1.25 * f.truth);
    CHECK(f.by_paths < f.by_sum);
  }
}

namespace {

/// A small cached picture that shows cached components only.
void make_small(session::Renderer& renderer, const test::Settings& more) {
  renderer.settings().set("path.batch", more.contains("path.batch") ? more.at("path.batch") : "131072");
  renderer.set_size(40, 32);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  test::Settings settings = test::dense_records({{"samples", "4"},
                                                 {"cache.max_records", test::k_room},
                                                 {"components.primary", "off"},
                                                 {"components.caustic", "off"},
                                                 {"components.secondary", "cache"},
                                                 {"components.tertiary", "cache"}});
  for (const auto& [key, value] : more) settings[key] = value;
  test::set(renderer, settings);
}

}  // namespace

TEST_CASE(
    "the records' error estimate does not depend on work items or interruptions, and does not change the "
    "picture") {
  session::Renderer one(test::renderer_options()), other(test::renderer_options());
  make_small(one, {});
  make_small(other, {{"path.batch", "4096"}});
  const film::Image image = test::finish(one);
  int calls = 0, refused = 0;
  while (!other.done())
    if (!other.step([&] { return ++calls % 149 == 0; })) REQUIRE(++refused < 10000);
  CHECK(refused > 0);
  CHECK(test::identical(image, other.image()));
  REQUIRE(one.film().lookup_errors_complete());
  REQUIRE(other.film().lookup_errors_complete());
  const auto a = one.film().lookup_errors(), b = other.film().lookup_errors();
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
  const film::ImageError ea = one.image_error(), eb = other.image_error();
  CHECK(ea.lookup_noise_rms > 0);
  CHECK(ea.interpolation_rms > 0);
  CHECK(ea.relative_sum() == eb.relative_sum());
  CHECK(ea.relative_sum() > ea.relative(0));
  CHECK(one.device().validation_messages() == 0);
  CHECK(other.device().validation_messages() == 0);
  // The estimate starts again for another view.
  other.set_size(32, 32);
  CHECK_FALSE(other.film().lookup_errors_complete());
  test::finish(other);
  CHECK(other.film().lookup_errors_complete());
  // Without cached components no record error is reported.
  test::set(one, {{"components.secondary", "path"}, {"components.tertiary", "path"}});
  test::finish(one);
  const film::ImageError plain = one.image_error();
  CHECK_FALSE(one.film().lookup_errors_complete());
  CHECK(plain.relative_sum() == plain.relative(0));
}

TEST_CASE("a target that record errors prevent is not reported as reached and costs no further samples") {
  session::Renderer r(test::renderer_options());
  constexpr double k_target = 0.01;
  make_small(r, {{"cache.gather", "false"},
                 {"sampling.mode", "adaptive"},
                 {"sampling.target_error", "0.01"},
                 {"sampling.min_samples", "16"},
                 {"sampling.max_samples", "65536"},
                 {"sampling.tile", "8"}});
  test::finish(r);
  r.finish_ledger();
  size_t limited = 0;
  const std::vector<film::TileError> estimated = r.progress().tile_errors();
  for (size_t t = 0; t < estimated.size(); ++t) {
    const schedule::Tile& tile = r.sampling().adaptive()->tiles()[t];
    limited += tile.limited(k_target);
    CHECK(tile.samples < 65536);
    if (tile.state == schedule::TileState::done) CHECK(estimated[t].relative_sum() < 1.01 * k_target);
    if (tile.limited(k_target)) CHECK(estimated[t].relative_sum() > k_target);
  }
  CHECK(limited > 0);
  CHECK(r.progress().ledger().entries().back().floor() > 0);
  // The records' error falls with their noise as the number of rays grows.
  const double before = r.image_error().lookup_noise_rms;
  test::set(r, {{"cache.rays", "1024"}, {"cache.noise", "0.01"}});
  test::finish(r);
  CHECK(r.image_error().lookup_noise_rms < 0.8 * before);
}

}  // namespace cache_calibration_tests
