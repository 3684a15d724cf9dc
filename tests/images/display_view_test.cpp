// links: session
// The picture by a display and view of an OpenColorIO configuration: close to the exact colours, in the
// window and in PNG files; nothing changes without one.
#include <catch2/catch.hpp>

#include "film/io/ocio.h"
#include "session/renderer.h"
#include "support/complaints.h"
#include "support/folder.h"
#include "support/ocio.h"
#include "support/render.h"

namespace display_view_tests {

using namespace lucerna;
using Catch::Contains;

namespace {

void open(session::Renderer& r, const test::Settings& settings = {}) {
  r.settings().set("path.batch", test::k_batch);
  r.set_size(48, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  test::set(r, {{"samples", "4"}, {"film.ev", "0.5"}});
  test::set(r, settings);
}

/// Difference of 8-bit pictures in levels: mean and maximum of the channels.
std::pair<double, int> difference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0;
  int most = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const int off = std::abs(int(a[i]) - int(b[i]));
    sum += off, most = std::max(most, off);
  }
  return {sum / double(a.size()), most};
}

/// The picture's light by the exact view.
std::vector<uint8_t> exact(session::Renderer& r, const std::string& display, const std::string& view) {
  const film::Image image = r.image();
  std::vector<vec3> colors;
  for (size_t i = 0; i < image.samples.size(); ++i)
    colors.push_back(std::exp2(0.5f) * test::sum_at(image, i));
  film::ocio_config()->show(display, view, colors);
  std::vector<uint8_t> rgba;
  for (const vec3& c : colors) {
    for (int k = 0; k < 3; ++k) rgba.push_back(uint8_t(std::clamp(c[k], 0.0f, 1.0f) * 255 + 0.5f));
    rgba.push_back(255);
  }
  return rgba;
}

}  // namespace

TEST_CASE("the shown picture is that of the view, within a level or two of 255") {
  const test::Folder f;
  const test::OcioVariable variable(test::write_ocio(f.path).string());
  session::RendererOptions options = test::renderer_options(true);
  options.interactive = true;
  session::Renderer r(options);
  open(r, {{"film.ocio", "Screen: sRGB: Film"}});
  // A display's name may have a colon; its view follows the last one.
  while (r.samples() == 0) REQUIRE(r.step());
  const std::vector<uint8_t> preview = r.output().shown_picture(true);
  test::finish(r);
  test::set(r, {{"preview.filter", "off"}});
  for (const char* view : {"Film", "Plain"}) {
    CAPTURE(view);
    test::set(r, {{"film.ocio", film::ocio_text("Screen: sRGB", view)}});
    const std::vector<uint8_t> wanted = exact(r, "Screen: sRGB", view);
    const auto [mean, most] = difference(r.output().picture(false), wanted);
    CAPTURE(mean, most);
    CHECK(mean < 0.5);
    CHECK(most <= 8);
    CHECK(difference(r.output().shown_picture(false), r.output().picture(false)).second == 0);
  }
  // The preview filters noise, so it is only near.
  CHECK(difference(preview, exact(r, "Screen: sRGB", "Film")).first < 30);
  const film::FilmImage png = [&] {
    r.output().save(f / "a.png");
    return film::read_exr(f / "a.png");
  }();
  CHECK_THAT(png.metadata.at("ocio"), Contains("config.ocio: Screen: sRGB: Plain"));
  test::set(r, {{"film.ocio", "Other"}});  // the display's default view
  CHECK(difference(r.output().picture(false), exact(r, "Other", "Plain")).second <= 8);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("errors as seen are those of the view: light that it shows as white has none") {
  const test::Folder f;
  const test::OcioVariable variable(test::write_ocio(f.path).string());
  session::Renderer r(test::renderer_options(true));
  open(r, {{"film.ev", "5"}, {"film.tone_curve", "linear"}});
  test::finish(r);
  const auto seen = [&](const std::string& ocio) {
    test::set(r, {{"film.ocio", ocio}});
    return r.image_error().seen(0);
  };
  const double linear = seen(""), plain = seen("Other: Plain"), film = seen("Screen: sRGB: Film");
  CAPTURE(linear, plain, film);
  CHECK(plain == Approx(linear));  // both end at 1
  CHECK(film > 1.15 * plain);      // it ends at several times that
  CHECK(seen("") == Approx(linear));
}

TEST_CASE("without a configuration, or with a bad choice, the picture keeps its tone curve") {
  const test::Folder f;
  const test::OcioVariable none("");
  session::Renderer r(test::renderer_options(true));
  open(r);
  test::finish(r);
  const std::vector<uint8_t> standard = r.output().picture(false);
  const auto refused = [&](const char* value, const std::string& why) {
    r.settings().set("film.ocio", value);
    CHECK_THROWS_WITH(r.apply_settings(), Contains(why));
    CHECK(r.settings().text("film.ocio").empty());
    CHECK(r.output().picture(false) == standard);
  };
  refused("Other", "film.ocio: 'Other': the environment variable OCIO names no configuration");
  {
    const test::OcioVariable bad((f / "none.ocio").string());
    refused("Other", "OCIO: " + (f / "none.ocio").string() + ": there is no such file");
  }
  const test::OcioVariable variable(test::write_ocio(f.path).string());
  refused("None", "there is no display 'None'");
  refused("Other: None", "the display 'Other' has no view 'None'");
  CHECK(r.output().picture(false) == standard);
  const uint64_t begun = r.restarts();
  test::set(r, {{"film.ocio", "Other: Plain"}});
  CHECK(r.restarts() == begun);
  CHECK(r.output().picture(false) != standard);
  // It is a setting of the machine: another scene keeps it.
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/ring/ring.gltf");
  CHECK(r.settings().text("film.ocio") == "Other: Plain");
  open(r, {{"film.ocio", ""}});
  test::finish(r);
  CHECK(r.output().picture(false) == standard);
  // A choice that a command line makes is refused; one that a scene makes is reported.
  CHECK_THROWS_WITH(r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/ring/ring.gltf", {},
                           {{"film.ocio", "None", "--set"}}),
                    Contains("there is no display 'None'"));
  auto scene = std::make_shared<scene::Scene>(*r.scene());
  scene->settings.emplace_back("film.ocio", "None");
  const test::Complaints complaints;
  r.set_scene(scene);
  CHECK(r.settings().text("film.ocio").empty());
  CHECK(r.device().validation_messages() == 0);
}

}  // namespace display_view_tests
