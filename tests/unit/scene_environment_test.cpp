// links: scene_io film_io
// Metadata of light files besides pixel values: orientation and exposure of Radiance pictures, windows of
// EXR, and the shape of an environment.
#include <cmath>

#include "base/primaries.h"
#include "base/radiance_hdr.h"
#include "film/io/image_file.h"
#include "scene/io/environment_file.h"
#include "unit/scene_support.h"

namespace scene_environment_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using scene::Scene;

namespace {

/// A scene of a triangle in the environment.
std::filesystem::path scene_in(const TempFolder& folder, const std::string& environment) {
  Asset asset;
  asset.triangle();
  asset.doc["scenes"][0]["extras"]["environment"] = {{"file", environment}};
  return asset.gltf(folder, "scene.gltf");
}

/// The environment's first channel, by all three ways of reading it.
std::vector<float> reds(const TempFolder& folder, const std::string& name) {
  const Scene scene = scene::load(scene_in(folder, name));
  const scene::Image& image = scene.images[scene.environment.image];
  std::vector<float> red;
  for (size_t i = 0; i < image.floats.size(); i += 4) red.push_back(image.floats[i]);
  CHECK(scene::load_environment(folder / name, scene::k_scene_bytes).floats == image.floats);
  const film::FilmImage picture = film::read_exr(folder / name);
  CHECK(picture.width == image.width);
  CHECK(picture.height == image.height);
  CHECK(picture.channels.at(0).second == red);
  return red;
}

constexpr int k_width = 4, k_height = 2;

/// 4 x 2 pixels in the order of the resolution line; the pixel in column x and row y of the picture is 1 + x
/// + 10 y in all channels.
std::vector<uint8_t> radiance(const std::string& header, char slow_sign, char slow, char fast_sign,
                              char fast) {
  const int lines = slow == 'Y' ? k_height : k_width, length = slow == 'Y' ? k_width : k_height;
  std::string text = fmt::format("#?RADIANCE\n{}FORMAT=32-bit_rle_rgbe\n\n{}{} {} {}{} {}\n", header,
                                 slow_sign, slow, lines, fast_sign, fast, length);
  std::vector<uint8_t> bytes(text.begin(), text.end());
  for (int i = 0; i < lines; ++i)
    for (int j = 0; j < length; ++j) {
      const int column = slow == 'X' ? i : j, row = slow == 'X' ? j : i;
      const char x_sign = slow == 'X' ? slow_sign : fast_sign, y_sign = slow == 'X' ? fast_sign : slow_sign;
      const int x = x_sign == '+' ? column : k_width - 1 - column;
      const int y = y_sign == '-' ? row : k_height - 1 - row;
      const auto mantissa = static_cast<uint8_t>(8 * (1 + x + 10 * y));
      bytes.insert(bytes.end(), {mantissa, mantissa, mantissa, 128 + 5});  // mantissa / 8
    }
  return bytes;
}

const std::vector<float> k_upright{1, 2, 3, 4, 11, 12, 13, 14};

}  // namespace

TEST_CASE("Radiance pictures of all eight orientations") {
  TempFolder folder;
  for (const char slow : {'Y', 'X'})
    for (const char slow_sign : {'-', '+'})
      for (const char fast_sign : {'-', '+'}) {
        const char fast = slow == 'Y' ? 'X' : 'Y';
        CAPTURE(slow_sign, slow, fast_sign, fast);
        const std::vector<uint8_t> bytes = radiance("", slow_sign, slow, fast_sign, fast);
        write(folder / "sky.hdr", bytes.data(), bytes.size());
        CHECK(reds(folder, "sky.hdr") == k_upright);
      }
}

TEST_CASE("exposures and colour corrections of Radiance pictures are divided out") {
  TempFolder folder;
  const auto first = [&](const std::string& header) {
    const std::vector<uint8_t> bytes = radiance(header, '-', 'Y', '+', 'X');
    write(folder / "sky.hdr", bytes.data(), bytes.size());
    reds(folder, "sky.hdr");
    const std::vector<float> floats = scene::load_environment(folder / "sky.hdr", 1 << 20).floats;
    return vec3(floats[0], floats[1], floats[2]);
  };
  CHECK(first("EXPOSURE=0.25\n") == vec3(4));
  CHECK(first("EXPOSURE= 2.000000e+00\nSOFTWARE=x\nEXPOSURE=4\n") == vec3(0.125f));
  CHECK(first("COLORCORR=1 2 4\nEXPOSURE=0.5\nCOLORCORR= 1 1 0.5\n") == vec3(2, 1, 1));
  // Inherited from another picture, or invalid.
  CHECK(first("pcomb\n\tEXPOSURE=0.25\nEXPOSURE=0\nEXPOSURE=much\nEXPOSURE=-1\n") == vec3(1));
}

TEST_CASE("Radiance pictures in XYZ become RGB with the same white") {
  RadianceHeader header;
  header.lines = header.length = 1;
  header.xyz = true;
  const std::vector<float> white = upright_radiance({3, 3, 3}, 3, header);
  for (const float value : white) CHECK(value == Approx(3).epsilon(1e-5));
  const std::vector<float> red = upright_radiance({0.514f, 0.2651f, 0.0241f}, 3, header);  // red's column
  CHECK(red[0] == Approx(1).margin(0.002));
  CHECK(red[1] == Approx(0).margin(0.002));
  CHECK(red[2] == Approx(0).margin(0.002));
  const std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n12345678";
  const auto read = read_radiance_header({text.begin(), text.end()});
  REQUIRE(read);
  CHECK(read->xyz);
  CHECK(read->end == text.size() - 8);
  for (const char* broken : {"#?RADIANCE\n", "#?RADIANCE\n\n-Y 1 -Y 2\n", "#?RADIANCE\n\n-Y 0 +X 2\n",
                             "P6\n\n-Y 1 +X 1\n", "#?RADIANCE\nEXPOSURE=1e-300\n\n-Y 1 +X 2\n"})
    CHECK_FALSE(read_radiance_header({broken, broken + std::strlen(broken)}));
}

TEST_CASE("colours of other primaries are converted to Rec.709") {
  const Chromaticities rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  const Chromaticities acescg{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  CHECK_FALSE(rec709_from(rec709));
  CHECK_FALSE(rec709_from(Chromaticities{}));
  const auto matrix = rec709_from(acescg);
  REQUIRE(matrix);
  // The matrix that ACES gives, by rows.
  const double aces[3][3] = {
      {1.70505, -0.62179, -0.08326}, {-0.13026, 1.14080, -0.01055}, {-0.02400, -0.12897, 1.15297}};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) CHECK((*matrix)[c][r] == Approx(aces[r][c]).margin(0.002));

  TempFolder folder;
  OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), acescg.data());
  auto out = OIIO::ImageOutput::create((folder / "sky.exr").string());
  REQUIRE(out->open((folder / "sky.exr").string(), spec));
  const float pixels[6] = {2, 2, 2, 1, 0.5f, 0.5f};
  REQUIRE(out->write_image(OIIO::TypeDesc::FLOAT, pixels));
  out->close();
  const std::vector<float> floats = scene::load_environment(folder / "sky.exr", 1 << 20).floats;
  for (size_t k = 0; k < 3; ++k) CHECK(floats[k] == Approx(2).margin(0.002));
  CHECK(floats[4] == Approx(1.3525).margin(0.002));
  CHECK(floats[5] == Approx(0.4349).margin(0.002));

  const std::vector<uint8_t> radiance_of_it =
      radiance("PRIMARIES= 0.713 0.293 0.165 0.83 0.128 0.044 0.32168 0.33767\n", '-', 'Y', '+', 'X');
  const auto header = read_radiance_header(radiance_of_it);
  REQUIRE(header);
  CHECK(header->primaries == acescg);
  const auto own = radiance("PRIMARIES= .64 .33 .29 .6 .15 .06 .3333 .3333\n", '-', 'Y', '+', 'X');
  CHECK_FALSE(read_radiance_header(own)->primaries);
}

TEST_CASE("an EXR's data window is placed in its display window") {
  TempFolder folder;
  // Pixels of the picture as in k_upright, others 99.
  const auto write_window = [&](int x, int y, int width, int height, int full_x, int full_y) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
    spec.x = x, spec.y = y;
    spec.full_x = full_x, spec.full_y = full_y, spec.full_width = k_width, spec.full_height = k_height;
    std::vector<float> pixels;
    for (int row = y - full_y; row < y - full_y + height; ++row)
      for (int column = x - full_x; column < x - full_x + width; ++column) {
        const bool inside = row >= 0 && row < k_height && column >= 0 && column < k_width;
        for (int c = 0; c < 3; ++c)
          pixels.push_back(inside ? k_upright[static_cast<size_t>(row * k_width + column)] : 99);
      }
    auto out = OIIO::ImageOutput::create((folder / "sky.exr").string());
    REQUIRE(out->open((folder / "sky.exr").string(), spec));
    REQUIRE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    out->close();
    return reds(folder, "sky.exr");
  };
  CHECK(write_window(0, 0, 4, 2, 0, 0) == k_upright);
  CHECK(write_window(0, 0, 4, 1, 0, 0) == std::vector<float>{1, 2, 3, 4, 0, 0, 0, 0});    // cropped
  CHECK(write_window(1, 1, 2, 1, 0, 0) == std::vector<float>{0, 0, 0, 0, 0, 12, 13, 0});  // inside
  CHECK(write_window(-1, -2, 7, 6, 0, 0) == k_upright);                                   // overscan
  CHECK(write_window(2, -1, 5, 2, 0, 0) == std::vector<float>{0, 0, 3, 4, 0, 0, 0, 0});   // both
  CHECK(write_window(100, -50, 4, 2, 100, -50) == k_upright);                             // offset
  CHECK(write_window(9, 9, 3, 3, 0, 0) == std::vector<float>(8, 0.f));                    // disjoint
}

TEST_CASE("a fourth EXR channel that is no alpha is ignored") {
  TempFolder folder;
  OIIO::ImageSpec spec(2, 1, 4, OIIO::TypeDesc::FLOAT);
  const auto alpha = [&](const char* name) {
    spec.channelnames = {"R", "G", "B", name};
    spec.alpha_channel = spec.z_channel = -1;
    (*name == 'A' ? spec.alpha_channel : spec.z_channel) = 3;
    auto out = OIIO::ImageOutput::create((folder / "sky.exr").string());
    REQUIRE(out->open((folder / "sky.exr").string(), spec));
    const float pixels[8] = {0.5f, 0.5f, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0.25f};
    REQUIRE(out->write_image(OIIO::TypeDesc::FLOAT, pixels));
    out->close();
    return scene::load_environment(folder / "sky.exr", 1 << 20).floats.at(3);
  };
  CHECK(alpha("A") == 0.25f);
  CHECK(alpha("Z") == 1);
}

TEST_CASE("one rule for the shape of environments, in scenes and as single files") {
  TempFolder folder;
  const auto complaint = [&](int width, int height) {
    write_image<float>(folder / "sky.exr", width, height, 3,
                       std::vector<float>(static_cast<size_t>(3 * width * height), 1));
    std::string alone;
    try {
      scene::load_environment(folder / "sky.exr", scene::k_scene_bytes);
    } catch (const Error& error) {
      alone = error.what();
    }
    const std::string named = failure(scene_in(folder, "sky.exr"));
    CHECK(alone.empty() == named.empty());
    return named;
  };
  CHECK_THAT(complaint(8, 8), Contains("extras.environment.file: 8 x 8 pixels: a latitude-longitude image is "
                                       "twice as wide as high"));
  CHECK_THAT(complaint(24, 4), Contains("24 x 4 pixels"));
  CHECK(complaint(200, 101).empty());
  CHECK(complaint(1, 1).empty());
}

}  // namespace scene_environment_tests
