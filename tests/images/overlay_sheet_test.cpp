// links: session
// Overlays at the window's resolution: records are drawn as thin rings on the surfaces of the window's
// pixels, before the picture has samples and where it is shown enlarged.
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "film/io/image_file.h"
#include "session/renderer.h"
#include "shaders/shared/film.h"
#include "support/render.h"

namespace overlay_sheet_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 96;

/// A Cornell box whose secondary light is cached; the cache is complete, the picture has no sample.
std::unique_ptr<session::Renderer> prepared(uint32_t size, bool interactive = false) {
  auto r = std::make_unique<session::Renderer>(test::renderer_options(false, {}, interactive));
  r->set_size(size, size);
  r->load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  for (const auto& [key, value] : {std::pair{"components.secondary", "cache"},
                                   {"cache.rays", "64"},
                                   {"cache.max_rays", "64"},
                                   {"cache.error", "0.8"},
                                   {"cache.min_radius", "8"},
                                   {"preview.filter", "off"},
                                   {"samples", "8"}})
    r->settings().set(key, value);
  r->apply_settings();
  if (interactive) REQUIRE(r->previews().draw());
  while (r->preparing()) REQUIRE(r->step());
  REQUIRE(r->samples() == 0);
  return r;
}

void show(session::Renderer& r, const char* view, bool on) {
  r.settings().set(view, on ? "true" : "false");
  r.apply_settings();
}

/// How much each pixel of the records' view differs from the picture without it.
std::vector<int> records_alone(session::Renderer& r) {
  show(r, "overlay.records", true);
  r.output().picture(true);
  r.overlays().trace({});
  const std::vector<uint8_t> with = r.output().picture(true);
  show(r, "overlay.records", false);
  const std::vector<uint8_t> plain = r.output().picture(true);
  const uint32_t scale = uint32_t(std::lround(std::sqrt(double(with.size()) / double(plain.size()))));
  const uint32_t across = r.film().width();
  std::vector<int> differ(with.size() / 4);
  for (uint32_t p = 0; p < differ.size(); ++p) {
    const uint32_t x = p % (across * scale), y = p / (across * scale);
    const size_t below = size_t{y / scale} * across + x / scale;
    for (int c = 0; c < 3; ++c)
      differ[p] = std::max(differ[p], std::abs(int(with[4 * p + c]) - int(plain[4 * below + c])));
  }
  return differ;
}

constexpr int k_drawn = 60;  // of 255: a rim, no fill

/// Of the squares of `side` pixels in which something is drawn, how many are drawn all over.
double full_squares(const std::vector<int>& differ, uint32_t across, uint32_t side) {
  size_t full = 0, some = 0;
  for (uint32_t y = 0; y + side <= differ.size() / across; y += side)
    for (uint32_t x = 0; x + side <= across; x += side) {
      uint32_t drawn = 0;
      for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) drawn += differ[(y + j) * across + x + i] > k_drawn;
      some += drawn > 0, full += drawn == side * side;
    }
  REQUIRE(some > 20);
  return double(full) / double(some);
}

double drawn_share(const std::vector<int>& differ) {
  return double(std::count_if(differ.begin(), differ.end(), [](int d) { return d > k_drawn; })) /
         double(differ.size());
}

}  // namespace

TEST_CASE("before the first sample records are rings, not the squares of the coarse picture") {
  const auto r = prepared(k_size, true);
  const std::vector<int> before = records_alone(*r);
  CHECK(full_squares(before, k_size, shared::k_coarse_step) < 0.2);
  // They lie where they lie in the picture that has samples.
  while (r->step()) {
  }
  const std::vector<int> after = records_alone(*r);
  size_t moved = 0, drawn = 0;
  for (size_t p = 0; p < before.size(); ++p) {
    drawn += after[p] > k_drawn;
    moved += after[p] > k_drawn && before[p] < k_drawn / 6;
  }
  REQUIRE(drawn > 200);
  CHECK(moved < drawn / 20);
}

TEST_CASE("records over a picture that is shown enlarged are as thin as over a large one") {
  const auto small = prepared(k_size / 4);
  small->overlays().set_window_scale(4);
  while (small->step()) {
  }
  const std::vector<int> enlarged = records_alone(*small);
  CHECK(small->overlays().scale() == 1);  // without an overlay the picture comes as it is
  REQUIRE(enlarged.size() == size_t{k_size} * k_size);
  CHECK(full_squares(enlarged, k_size, 4) < 0.3);
  CHECK(drawn_share(enlarged) > 0.01);
  // The same state gives the same pixels.
  CHECK(records_alone(*small) == enlarged);

  // What is saved has the size of the picture, with its overlays.
  const std::string file = "/tmp/lucerna-overlay-sheet-" + std::to_string(getpid()) + ".png";
  show(*small, "overlay.records", true);
  small->output().save(file);
  const film::FilmImage saved = film::read_exr(file);
  std::filesystem::remove(file);
  CHECK(saved.width == k_size / 4);
  CHECK(small->output().picture(false).size() == size_t{k_size} * k_size * 4);
}

TEST_CASE("in the window a moved camera does not wait for the surfaces of overlays; one at rest has them") {
  const auto r = prepared(k_size, true);
  show(*r, "overlay.records", true);
  CHECK(r->overlays().waits());
  const std::vector<uint8_t> at_once = r->output().shown_picture(true);
  CHECK(r->overlays().waits());
  r->overlays().trace([] { return true; });  // another command came
  CHECK(r->overlays().waits());
  r->overlays().trace({});
  CHECK_FALSE(r->overlays().waits());
  const std::vector<uint8_t> traced = r->output().shown_picture(true);
  CHECK(traced != at_once);
  CHECK(r->output().shown_picture(true) == traced);
  scene::Camera camera = r->camera();
  camera.to_world[3] += vec4(0.05f, 0, 0, 0);
  r->set_camera(camera);
  r->output().shown_picture(true);
  CHECK(r->overlays().waits());
  show(*r, "overlay.records", false);
  CHECK_FALSE(r->overlays().waits());
}

}  // namespace overlay_sheet_tests
