// links: session film_io
// The window filters its picture between samples: what it shows then, and when the filtered picture is
// discarded.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace window_filter_tests {

using namespace lucerna;
using test::Settings;

namespace {

constexpr uint32_t k_size = 48;

struct Window {
  session::Renderer r;
  explicit Window(const char* samples, bool interactive = true)
      : r([&] {
          session::RendererOptions o = test::renderer_options(true);
          o.interactive = interactive;
          return o;
        }()) {
    r.set_size(k_size, k_size);
    r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    test::set(r, {{"components.secondary", "path"}, {"components.tertiary", "path"}, {"samples", samples}});
  }
  ~Window() { CHECK(r.device().validation_messages() == 0); }
};

double mean_square(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return sum / double(a.size());
}

/// Of many samples, independent of those of the window.
std::vector<uint8_t> converged_picture() {
  Window truth("1024", false);
  test::set(truth.r, {{"seed", "9"}});
  test::finish(truth.r);
  return truth.r.output().picture(false);
}

}  // namespace

TEST_CASE("the window shows a filtered picture from some samples on and when it is finished") {
  const std::vector<uint8_t> converged = converged_picture();

  Window window("16");
  session::Renderer& r = window.r;
  // Up to the first filtered picture, without an edit or a request.
  for (int i = 0; i < 10000 && !r.output().filter_news(); ++i) REQUIRE(r.step());
  CHECK(r.samples() >= 8);
  CHECK(r.samples() < 16);
  CHECK(r.output().preview_shares().filtered == 1);
  CHECK(r.output().preview_shares().stale == 0);
  const std::vector<uint8_t> first = r.output().shown_picture(false);
  CHECK(mean_square(first, converged) < mean_square(r.output().picture(false), converged) / 2);

  test::finish(r);
  CHECK(r.output().filter_news());
  CHECK_FALSE(r.output().filter_due());
  const std::vector<uint8_t> shown = r.output().shown_picture(false), samples = r.output().picture(false);
  CHECK(shown != first);
  CHECK(mean_square(shown, converged) < mean_square(samples, converged) / 2);
  CHECK(r.output().preview_shares().error.value_or(film::ShownError{}).median > 0);

  // As shown, or the samples: by name.
  const test::Folder f;
  r.output().save(f / "shown.png", true);
  r.output().save(f / "samples.png", false);
  CHECK(film::read_metadata(f / "shown.png").count("filter") == 1);
  CHECK(film::read_metadata(f / "samples.png").count("filter") == 0);
  CHECK(r.output().shown_picture(false) == shown);
  // Other light discards it, and the previous light gives the same picture again.
  scene::Light lamp = r.scene()->lights[0];
  const scene::Light before = lamp;
  lamp.position.x += 0.2f;
  r.set_light(0, lamp);
  CHECK(r.output().preview_shares().filtered < 1);
  r.set_light(0, before);
  test::finish(r);
  CHECK(r.output().shown_picture(false) == shown);
  // With the filter off, no filtering.
  test::set(r, {{"preview.filter", "off"}});
  CHECK(r.output().shown_picture(false) == samples);
  CHECK_FALSE(r.output().filter_due());
}

TEST_CASE("light from before an edit is not replaced by a filtered picture with a larger error") {
  const std::vector<uint8_t> converged = converged_picture();

  Window window("256");
  session::Renderer& r = window.r;
  test::finish(r);
  const double before = mean_square(r.output().shown_picture(false), converged);
  r.set_camera(r.camera());  // the same view and light, from the beginning
  r.output().shown_picture(false);
  while (r.samples() < 12) {
    REQUIRE(r.step());
    r.output().shown_picture(false);
  }
  INFO("mean square " << before << " before");
  CHECK(r.output().preview_shares().filtered < 1);
  CHECK(r.output().preview_shares().stale > 0.3);
  CHECK(mean_square(r.output().shown_picture(false), converged) < 2 * before);
  // It can be tinted.
  const std::vector<uint8_t> untinted = r.output().shown_picture(false);
  test::set(r, {{"overlay.former", "true"}});
  CHECK(mean_square(r.output().shown_picture(false), untinted) > 10);
  test::set(r, {{"overlay.former", "false"}});
  CHECK(mean_square(r.output().shown_picture(false), untinted) < 1);
  // At the end it is the filtered picture in any case.
  test::finish(r);
  CHECK(r.output().preview_shares().filtered == 1);
  CHECK(r.output().preview_shares().stale == 0);
}

TEST_CASE("in batch mode only requested filtering runs") {
  Window batch("16", false);
  test::finish(batch.r);
  CHECK_FALSE(batch.r.output().filter_due());
  CHECK(batch.r.output().filtered() == nullptr);
  const std::vector<uint8_t> samples = batch.r.output().picture(false);
  batch.r.output().filter();
  CHECK(batch.r.output().picture(false) != samples);
}

}  // namespace window_filter_tests
