// links: film_io
// OpenColorIO configurations: displays and views, exact colours, the table for the device, bad files.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <random>

#include "base/error.h"
#include "film/io/ocio.h"
#include "shaders/shared/display_lut.h"
#include "support/folder.h"
#include "support/ocio.h"

namespace film_io_ocio_tests {

using namespace lucerna;
using Catch::Contains;

namespace {

/// The table as lib/display.glsl reads it.
vec3 read_table(const std::vector<vec4>& table, const vec3& color) {
  constexpr uint32_t k_last = shared::k_display_lut_size - 1;
  uint32_t at[3];
  float f[3];
  for (int c = 0; c < 3; ++c) {
    const float place = shared::display_lut_place(color[c]);
    at[c] = uint32_t(place), f[c] = place - float(at[c]);
  }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return f[a] > f[b]; });
  const auto node = [&] {
    const auto n = [&](int c) { return std::min(at[c], k_last); };
    return vec3(table[(n(2) * shared::k_display_lut_size + n(1)) * shared::k_display_lut_size + n(0)]);
  };
  vec3 sum = (1 - f[order[0]]) * node();
  for (int i = 0; i < 3; ++i) {
    ++at[order[size_t(i)]];
    sum += (f[order[size_t(i)]] - (i < 2 ? f[order[size_t(i) + 1]] : 0)) * node();
  }
  return sum;
}

}  // namespace

TEST_CASE("displays and views of a configuration, the default ones first") {
  const test::Folder f;
  const auto file = test::write_ocio(f.path);
  const film::OcioConfig config(file);
  REQUIRE(config.displays().size() == 2);
  CHECK(config.displays()[0].name == "Screen: sRGB");
  CHECK(config.displays()[0].views == std::vector<std::string>{"Film", "Plain"});
  CHECK(config.displays()[1].name == "Other");
  CHECK(config.source() == "lin_rec709");
  CHECK(config.source_is_rec709());
  std::vector<vec3> colors{vec3(0), vec3(0.25f), vec3(1), vec3(0.5f, 0, 4)};
  const std::vector<vec3> before = colors;
  config.show("Screen: sRGB", "Plain", colors);
  for (size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c) CHECK(colors[i][c] == Approx(std::pow(before[i][c], 1 / 2.2f)).margin(1e-3));
  CHECK_THROWS_WITH(
      config.show("Screen", "", {}),
      Contains(file.string() + ": there is no display 'Screen'; there are: Screen: sRGB, Other"));
  CHECK_THROWS_WITH(config.show("Other", "Film", {}), Contains("has no view 'Film'; it has: Plain"));
  for (const auto& [display, view] : {std::pair<std::string, std::string>{"Screen: sRGB", "Film"},
                                      {"Screen: sRGB", ""},
                                      {"Other", "Plain"},
                                      {"Other", ""},
                                      {"No such", "View"}})
    CHECK(config.split(film::ocio_text(display, view)) == std::pair(display, view));
}

TEST_CASE("the luminance from which a view shows white") {
  const test::Folder f;
  const film::OcioConfig config(test::write_ocio(f.path));
  CHECK(config.white("Other", "Plain") == Approx(1));
  CHECK(config.white("Screen: sRGB", "Film") == Approx(64).epsilon(0.1));
  CHECK_THROWS_WITH(config.white("Other", "Film"), Contains("has no view 'Film'"));
}

TEST_CASE("the table is close to the exact view: within a level of 255 on average, a few at a clipped edge") {
  const test::Folder f;
  const film::OcioConfig config(test::write_ocio(f.path));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> stops(-12, 5), tint(0, 1);
  for (const char* view : {"Film", "Plain"}) {
    CAPTURE(view);
    const std::vector<vec4> table = config.table("Screen: sRGB", view);
    REQUIRE(table.size() == 65 * 65 * 65);
    std::vector<vec3> colors{vec3(0), vec3(0.18f), vec3(1e6f)};
    for (int i = 0; i < 20000; ++i)
      colors.push_back(std::exp2(stops(random)) * vec3(tint(random), tint(random), tint(random)));
    std::vector<vec3> exact = colors;
    config.show("Screen: sRGB", view, exact);
    double sum = 0, most = 0;
    for (size_t i = 0; i < colors.size(); ++i) {
      const vec3 off = glm::abs(read_table(table, colors[i]) - glm::clamp(exact[i], vec3(0), vec3(1)));
      const double largest = 255 * double(std::max({off.x, off.y, off.z}));
      sum += largest, most = std::max(most, largest);
    }
    const double mean = sum / double(colors.size());
    CAPTURE(mean, most);
    CHECK(mean < (std::string(view) == "Film" ? 0.2 : 0.5));
    CHECK(most < (std::string(view) == "Film" ? 2.5 : 8));
    CHECK(read_table(table, vec3(0)) == glm::clamp(exact[0], vec3(0), vec3(1)));
    CHECK(read_table(table, vec3(NAN)) == read_table(table, vec3(0)));
    CHECK(read_table(table, vec3(INFINITY)) == vec3(1));
  }
}

TEST_CASE("a configuration without linear Rec.709 is read by its scene_linear; without both it is refused") {
  const test::Folder f;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = test::k_ocio;
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    const auto file = f / "other.ocio";
    std::ofstream(file) << text;
    return file;
  };
  const film::OcioConfig named(replaced("lin_rec709", "house_linear"));
  CHECK(named.source() == "house_linear");
  CHECK_FALSE(named.source_is_rec709());
}

TEST_CASE("bad configurations are refused with their file and the reason") {
  const test::Folder f;
  const auto refuse = [&](const std::string& name, const std::string& text, const std::string& why) {
    const auto file = f / name;
    if (!text.empty()) std::ofstream(file) << text;
    CHECK_THROWS_WITH(film::OcioConfig(file), Catch::StartsWith(file.string() + ": ") && Contains(why));
  };
  refuse("missing.ocio", "", "there is no such file");
  refuse("text.ocio", "no configuration\n", "cannot be read");
  refuse("cut.ocio", test::k_ocio.substr(0, test::k_ocio.size() / 2), "");
  refuse("picture.ocio", std::string("\x89PNG\r\n\x1a\n\0\0", 10), "cannot be read");
  CHECK_THROWS_WITH(film::OcioConfig(f.path), Contains("is no file"));
  // A view whose table is missing is found when it is used.
  std::string text = test::k_ocio;
  text.replace(text.find("!<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}"), 48,
               "!<FileTransform> {src: none.spi1d}");
  const auto file = f / "table.ocio";
  std::ofstream(file) << text;
  const film::OcioConfig config(file);
  std::vector<vec3> colors{vec3(0.5f)};
  CHECK_THROWS_WITH(config.show("Other", "Plain", colors),
                    Catch::StartsWith(file.string() + ": the view 'Plain' of 'Other' cannot be used: "));
}

TEST_CASE("the configuration of the environment is read once, and again if the variable changes") {
  const test::Folder f;
  const test::OcioVariable none("");
  CHECK(film::ocio_config() == nullptr);
  {
    const test::OcioVariable set(test::write_ocio(f.path).string());
    const auto config = film::ocio_config();
    REQUIRE(config);
    CHECK(film::ocio_config() == config);
  }
  const test::OcioVariable bad((f / "none.ocio").string());
  CHECK_THROWS_WITH(film::ocio_config(),
                    Catch::StartsWith("OCIO: " + (f / "none.ocio").string() + ": there is no"));
}

}  // namespace film_io_ocio_tests
