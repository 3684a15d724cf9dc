// links: session
// A region of the picture: its pixels are those of the whole picture with as many samples, the rest is kept.
#include <catch2/catch.hpp>
#include <cmath>

#include "session/accuracy.h"
#include "session/renderer.h"
#include "session/session.h"
#include "support/render.h"

namespace region_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_width = 64, k_height = 48;
// In pixels 20 to 37 and 11 to 29; in blocks 16 to 40 and 8 to 32.
const std::string k_region = schedule::region_text({20.0 / 64, 11.0 / 48, 17.0 / 64, 18.0 / 48});
constexpr schedule::Rectangle k_blocks{16, 8, 40, 32};

void open(session::Renderer& r, const test::Settings& settings) {
  r.settings().set("path.batch", test::k_batch);
  r.set_size(k_width, k_height);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/ring/ring.gltf");
  test::set(r, settings);
}

/// True if these pixels are bit for bit those of the other picture.
bool same_inside(const film::Image& a, const film::Image& b, const schedule::Rectangle& pixels) {
  for (uint32_t i = 0; i < a.samples.size(); ++i) {
    if (!pixels.contains(i % a.width, i / a.width)) continue;
    bool same = a.samples[i] == b.samples[i];
    for (size_t c = 0; c < a.components.size(); ++c)
      same = same && a.components[c][i] == b.components[c][i] && a.odd_half[c][i] == b.odd_half[c][i];
    if (!same) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("pixels of a region are bit for bit those of the whole picture, by each way of computing them") {
  const std::map<std::string, test::Settings> ways{
      {"path", {}},
      {"adaptive",
       {{"sampling.mode", "adaptive"},
        {"sampling.target_error", "0.0001"},
        {"sampling.min_samples", "2"},
        {"sampling.max_samples", "6"}}},
      {"photons", {{"components.caustic", "photons"}, {"photons.per_round", "20000"}}},
      {"light", {{"components.caustic", "light"}}}};
  for (const auto& [name, way] : ways) {
    CAPTURE(name);
    test::Settings settings = way;
    settings["samples"] = "6";
    session::Renderer whole(test::renderer_options(false)), part(test::renderer_options(false));
    open(whole, settings);
    const film::Image all = test::finish(whole);
    settings["sampling.region"] = k_region;
    open(part, settings);
    const film::Image region = test::finish(part);
    CHECK(part.done());
    CHECK(part.samples() == 6);
    CHECK(same_inside(region, all, k_blocks));
    const schedule::Rectangle sampled =
        name == "adaptive" ? schedule::Rectangle{16, 0, 48, 32} : k_blocks;  // whole tiles
    uint32_t others = 0;
    for (uint32_t i = 0; i < region.samples.size(); ++i)
      others += !sampled.contains(i % k_width, i / k_width) && region.samples[i] > 0;
    CHECK(others == 0);
    // The figures are those of the region.
    const film::ImageError error = part.image_error();
    CHECK(error.pixels == double(k_blocks.right - k_blocks.left) * (k_blocks.bottom - k_blocks.top));
    CHECK(error.seen(0) > 0);
    const film::FilmImage file = part.output().film_image();
    REQUIRE(file.window);
    CHECK(file.window->left == 20);
    CHECK(file.window->bottom == 29);
  }
}

TEST_CASE("a region set and cleared during rendering loses and repeats no sample") {
  for (const char* mode : {"uniform", "adaptive", "balanced"}) {
    CAPTURE(mode);
    // Learned lights depend on when they were learned; then the rest is not bit for bit the same.
    const test::Settings settings{{"sampling.mode", mode},
                                  {"lights.sampling", "power"},
                                  {"samples", "8"},
                                  {"sampling.target_error", "0.0001"},
                                  {"sampling.min_samples", "2"},
                                  {"sampling.max_samples", "8"}};
    session::Renderer whole(test::renderer_options(false)), r(test::renderer_options(false));
    open(whole, settings);
    const film::Image all = test::finish(whole);
    open(r, settings);
    const uint64_t begun = r.restarts();
    while (r.samples() < 2) REQUIRE(r.step());
    const film::Image before = r.image();
    test::set(r, {{"sampling.region", k_region}});
    const film::Image during = test::finish(r);
    CHECK(r.samples() == 8);
    CHECK(same_inside(during, all, k_blocks));
    const auto corner = size_t{k_width} * k_height - 1;
    CHECK(during.samples[corner] == before.samples[corner]);
    CHECK(during.components[0][corner] == before.components[0][corner]);
    test::set(r, {{"sampling.region", "0,0.5,1,0.5"}});
    CHECK_FALSE(r.done());
    CHECK(test::finish(r).samples[corner] == 8);
    CHECK(r.image().samples[0] == before.samples[0]);
    test::set(r, {{"sampling.region", ""}});
    CHECK(r.samples() < 8);
    const film::Image after = test::finish(r);
    CHECK(test::identical(after, all));
    CHECK(r.restarts() == begun);
  }
}

TEST_CASE("a region that cannot be read changes nothing") {
  session::Renderer r(test::renderer_options(true));
  open(r, {{"samples", "2"}});
  REQUIRE(r.step());
  r.settings().set("sampling.region", "0,0,0,0");
  r.settings().set("seed", "5");
  CHECK_THROWS_WITH(r.apply_settings(), Catch::Contains("sampling.region: '0,0,0,0': nothing of it"));
  CHECK(r.settings().text("sampling.region").empty());
  CHECK(r.settings().text("seed") == "0");
  CHECK_THROWS_WITH(r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf", {},
                           {{"sampling.region", "half", "--set"}}),
                    Catch::Contains("expected LEFT,TOP,WIDTH,HEIGHT"));
  CHECK(r.scene()->name == "ring");
  test::finish(r);
  CHECK(r.samples() == 2);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("in the window every pixel gets its first samples before the region gets all others") {
  session::RendererOptions options = test::renderer_options(false);
  options.interactive = true;
  session::Renderer r(options);
  open(r, {{"samples", "8"}, {"sampling.region", k_region}, {"preview.filter", "off"}});
  test::finish(r);
  const film::Image image = r.image();
  CHECK(r.samples() == 8);
  for (uint32_t i = 0; i < image.samples.size(); ++i)
    REQUIRE(image.samples[i] == (k_blocks.contains(i % k_width, i / k_width) ? 8 : 2));
  CHECK_FALSE(r.output().film_image().window);
  // Another view begins like this one.
  scene::Camera moved = r.camera();
  moved.to_world[3][1] += 0.01f;
  r.set_camera(moved);
  test::finish(r);
  CHECK(r.image().samples[0] == 2);
}

TEST_CASE("the ledger of a region predicts no time") {
  session::Accuracy a;
  a.max_samples = 64;
  for (int i = 1; i <= 4; ++i) {
    stats::Entry e;
    e.wall_s = e.render_s = i, e.paths = uint64_t(1000 * i), e.rays = uint64_t(5000 * i), e.samples = i;
    e.has_error = true, e.error[0] = 0.2 / std::sqrt(i);
    a.ledger.add(e);
  }
  REQUIRE(session::seconds_to_end(a));
  a.settings["sampling.region"] = k_region;
  CHECK_FALSE(session::seconds_to_end(a));
  a.settings["sampling.region"] = "";
  CHECK(session::seconds_to_end(a));
}

}  // namespace region_tests
