// links: session
// Edits that the window's panels make through the renderer: moved lamps, emissive surfaces, an environment
// from a file, a hidden background. Each gives, bit for bit, the picture of a scene built that way.
#include <catch2/catch.hpp>
#include <fstream>

#include "film/io/image_file.h"
#include "session/renderer.h"
#include "support/device.h"
#include "support/folder.h"
#include "support/render.h"
#include "support/rooms.h"

namespace hand_edits_tests {

using namespace lucerna;

namespace {

struct Bench {
  session::Renderer r;
  explicit Bench(const scene::Scene& s, bool interactive = false)
      : r(test::renderer_options(true, {}, interactive)) {
    r.set_size(48, 32);
    r.set_scene(std::make_shared<scene::Scene>(s), {},
                {{"samples", "4", ""}, {"path.batch", "2048", ""}, {"path.max_depth", "6", ""}});
  }
  film::Image image() {
    film::Image image = test::finish(r);
    REQUIRE(r.done());
    return image;
  }
};

bool same(const film::Image& a, const film::Image& b) { return a.components == b.components; }

/// Writes an environment of 8 x 4 texels.
void write_sky(const std::filesystem::path& file, const std::vector<vec3>& texels, uint32_t width = 8) {
  film::FilmImage image;
  image.width = width, image.height = uint32_t(texels.size()) / width;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> channel;
    for (const vec3& t : texels) channel.push_back(t[c]);
    image.channels.emplace_back(std::string(1, "RGB"[c]), channel);
  }
  film::write_exr(file, image);
}

}  // namespace

TEST_CASE("automatic exposure measures the light that is shown") {
  Bench b(test::block_room(true));
  const film::Image image = b.image();
  const vec2 at(0.5f, 0.7f);
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (const auto& component : image.components)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += component[i];
  const auto check = [&](const std::vector<vec3>& shown) {
    CHECK(b.r.output().measure(at).ev == film::measure_point(shown, image.width, image.height, at).ev);
    CHECK(b.r.output().measure(std::nullopt).ev ==
          film::measure_picture(shown, image.width, image.height).ev);
  };
  const auto set = [&](const char* key, const char* value) {
    b.r.settings().set(key, value);
    b.r.apply_settings();
  };
  check(sum);
  set("film.layer", "secondary");
  check(image.components[1]);
  set("film.layer", "normal");
  check(sum);
  set("film.layer", "beauty");
  for (const char* hidden : {"show.primary", "show.secondary", "show.caustic"}) set(hidden, "false");
  check(image.components[2]);
  set("show.tertiary", "false");
  CHECK_FALSE(b.r.output().measure(at).ev);
}

TEST_CASE("a moved lamp and a surface made emissive light the scene as if built that way") {
  const scene::Scene before = test::block_room(true);
  scene::Scene after = before;
  after.lights[0].position = {-1, 2, 0.5f};
  after.lights[0].intensity = {1, 4, 2};
  after.materials[1].emission = {3, 2, 1};
  Bench edited(before), made(after);
  const film::Image old = edited.image();
  edited.r.set_light(0, after.lights[0]);
  edited.r.set_material(1, after.materials[1]);
  const film::Image image = edited.image();
  CHECK(same(image, made.image()));
  CHECK_FALSE(same(image, old));
  edited.r.set_material(1, before.materials[1]);
  edited.r.set_light(0, before.lights[0]);
  CHECK(same(edited.image(), old));
}

TEST_CASE(
    "an environment file lights the scene as if the scene named it; the scene's own one can be restored") {
  const test::Folder folder;
  const scene::Scene own = test::block_room(true);
  std::vector<vec3> texels;
  for (int i = 0; i < 32; ++i)
    texels.emplace_back(0.5f + float(i % 5), 0.25f * float(i % 3), i == 9 ? 40.0f : 0.5f);
  const auto file = folder / "sky.exr";
  write_sky(file, texels);
  scene::Scene named = own;
  named.images[0].floats.clear();
  for (const vec3& t : texels)
    named.images[0].floats.insert(named.images[0].floats.end(), {t.x, t.y, t.z, 1});

  Bench dropped(own), made(named);
  const film::Image old = dropped.image();
  dropped.r.set_environment_file(file);
  CHECK(same(dropped.image(), made.image()));
  CHECK(dropped.r.scene()->environment.file == file.string());
  dropped.r.set_environment(2, 90), made.r.set_environment(2, 90);
  CHECK(same(dropped.image(), made.image()));
  dropped.r.set_environment_file(file);  // again: the earlier one is dropped
  CHECK(dropped.r.scene()->images.size() == own.images.size() + 1);
  dropped.r.set_environment_file("");
  dropped.r.set_environment(1, 0);
  CHECK(same(dropped.image(), old));

  // A file that cannot be read changes nothing.
  const auto failure = [&](const std::filesystem::path& bad) -> std::string {
    try {
      dropped.r.set_environment_file(bad);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto cut = folder / "cut.exr", square = folder / "square.exr", text = folder / "text.hdr";
  std::filesystem::copy_file(file, cut);
  std::filesystem::resize_file(cut, std::filesystem::file_size(file) / 2);
  write_sky(square, texels, 4);
  std::ofstream(text) << "#?RADIANCE\nnothing more";
  CHECK_THAT(failure(folder / "none.hdr"), Catch::Contains("none.hdr: cannot be read: No such file"));
  CHECK_THAT(failure(cut), Catch::Contains("cut.exr"));
  CHECK_THAT(failure(text), Catch::Contains("text.hdr"));
  CHECK_THAT(failure(square),
             Catch::Contains("square.exr: 4 x 8 pixels: a latitude-longitude image is twice"));
  CHECK(same(dropped.image(), old));
}

TEST_CASE("a hidden background hides the directly visible environment only, not the light it gives") {
  Bench b(test::block_room(true));
  const film::Image shown = b.image();
  b.r.settings().set("film.background", "hidden");
  b.r.apply_settings();
  const film::Image hidden = b.image();
  int sky = 0, surfaces = 0;
  for (size_t i = 0; i < shown.depth.size(); ++i) {
    for (size_t c = 1; c < 4; ++c) REQUIRE(hidden.components[c][i] == shown.components[c][i]);
    if (shown.depth[i] == 0) {
      ++sky;
      CHECK(luminance(shown.components[0][i]) > 0);
      CHECK(hidden.components[0][i] == vec3(0));
    } else if (i / 48 > 20) {  // below the environment
      ++surfaces;
      REQUIRE(hidden.components[0][i] == shown.components[0][i]);
    }
  }
  CHECK(sky > 100);
  CHECK(surfaces > 300);
  b.r.settings().set("film.background", "shown");
  b.r.apply_settings();
  CHECK(same(b.image(), shown));
}

TEST_CASE("the picture is measured as a whole and at a point, first on the coarse level") {
  Bench b(test::block_room(true), true);
  CHECK_THROWS_WITH(b.r.output().measure(std::nullopt), Catch::Contains("no picture to measure yet"));
  REQUIRE(b.r.previews().draw());
  const auto coarse = b.r.output().measure(std::nullopt);
  b.image();
  const auto whole = b.r.output().measure(std::nullopt);
  REQUIRE((coarse.ev && whole.ev));
  CHECK(std::abs(*coarse.ev - *whole.ev) < 1);
  const auto sky = b.r.output().measure(vec2(0.5f, 0.02f)), floor = b.r.output().measure(vec2(0.5f, 0.95f));
  REQUIRE((sky.ev && floor.ev));
  CHECK(luminance(sky.color) * std::exp2(*sky.ev) == Approx(0.18));
  CHECK(sky.color.z == Approx(1.5f * sky.color.x).epsilon(0.01));  // the environment's blue
}

}  // namespace hand_edits_tests
