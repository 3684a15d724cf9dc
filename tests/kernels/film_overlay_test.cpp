// links: film film_io
// Heat maps and the overlay of tiles through the real shaders: pixels have the ramp's colour of their value,
// and the legend draws the same ramp.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "film/error.h"
#include "film/film.h"
#include "film/overlay.h"
#include "film/tonemap.h"
#include "support/device_name.h"

namespace film_overlay_tests {

using namespace lucerna;
using shared::TileMark;

namespace {

/// Lightness L of CIE L*a*b* of an encoded colour.
double lightness(const vec3& encoded) {
  const auto linear = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
  const double y = 0.2126 * linear(encoded.x) + 0.7152 * linear(encoded.y) + 0.0722 * linear(encoded.z);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

vec3 pixel_of(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t x, uint32_t y) {
  const uint8_t* p = &rgba[(size_t(y) * width + x) * 4];
  return vec3(p[0], p[1], p[2]) / 255.0f;
}

float farthest(const vec3& a, const vec3& b) {
  const vec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

/// A film with sample counts, vertices and errors set by the test.
struct Stage {
  static constexpr uint32_t k_width = 44, k_height = 27;  // tiles are cut off on two sides
  gpu::Device device{{test::device_name(), true}};
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{device};
  film::Film film{device, k_width, k_height};
  gpu::Buffer counts{device, {.name = "counts", .bytes = k_width * k_height * 4}};
  gpu::Buffer vertices{device, {.name = "vertices", .bytes = k_width * k_height * 4}};
  gpu::Buffer errors{device, {.name = "errors", .bytes = film.blocks() * sizeof(shared::BlockError)}};
  gpu::Resources resources;

  Stage() {
    film.clear(stream);
    film.bind(resources);
    resources.set("FilmCount", counts);
    resources.set("FilmVertices", vertices);
    resources.set("BlockErrors", errors);
  }
  ~Stage() { CHECK(device.validation_messages() == 0); }

  std::vector<uint8_t> heat(uint32_t layer, const film::HeatScale& s) {
    const gpu::Kernel kernel(device, compiler, "film/heat.comp");
    stream.dispatch(kernel, resources,
                    shared::HeatPush{k_width, k_height, layer, s.ramp, s.logarithmic, s.lo, s.hi, s.unit},
                    gpu::groups_for(k_width * k_height, 64));
    stream.run();
    return film.read_picture();
  }
};

}  // namespace

TEST_CASE("the ramps match their names, and their lightness rises evenly") {
  for (const auto& [ramp, name] :
       {std::pair{shared::k_ramp_viridis, "viridis"}, {shared::k_ramp_magma, "magma"}}) {
    constexpr int k_steps = 101;
    OIIO::ImageBuf values(OIIO::ImageSpec(k_steps, 1, 1, OIIO::TypeDesc::FLOAT));
    for (int i = 0; i < k_steps; ++i) {
      const float t = static_cast<float>(i) / (k_steps - 1);
      values.setpixel(i, 0, &t);
    }
    const OIIO::ImageBuf colours = OIIO::ImageBufAlgo::color_map(values, 0, name);
    float worst = 0;
    for (int i = 0; i < k_steps; ++i) {
      float c[4] = {};
      colours.getpixel(i, 0, c);
      const vec3 known = film::tone_map({c[0], c[1], c[2]}, 0, film::ToneCurve::linear);
      worst =
          std::max(worst, farthest(known, shared::ramp_color(ramp, static_cast<float>(i) / (k_steps - 1))));
    }
    INFO(name << ' ' << worst);
    CHECK(worst < 0.015f);
  }
  for (const uint32_t ramp : {shared::k_ramp_viridis, shared::k_ramp_magma, shared::k_ramp_tiles}) {
    const double from = lightness(shared::ramp_color(ramp, 0)), to = lightness(shared::ramp_color(ramp, 1));
    CHECK(to - from > 40);  // readable in black and white
    for (int i = 1; i <= 16; ++i) {
      const double before = lightness(shared::ramp_color(ramp, static_cast<float>(i - 1) / 16));
      const double step = lightness(shared::ramp_color(ramp, static_cast<float>(i) / 16)) - before;
      INFO("ramp " << ramp << " step " << i);
      CHECK(step > 0.4 * (to - from) / 16);
      CHECK(step < 1.8 * (to - from) / 16);
    }
  }
  // Invalid values are clamped to the ends.
  for (const float odd : {-1.0f, NAN, -INFINITY})
    CHECK(shared::ramp_color(0, odd) == shared::ramp_color(0, 0));
  CHECK(shared::ramp_color(0, INFINITY) == shared::ramp_color(0, 1));
  CHECK(shared::ramp_position(NAN, 1, 10, 1) == 0);
  CHECK(shared::ramp_position(0, 1, 10, 1) == 0);
  CHECK(shared::ramp_position(100, 1, 10, 1) == 1);
  CHECK(shared::ramp_position(std::sqrt(10.0f), 1, 10, 1) == Approx(0.5f));
  CHECK(shared::ramp_position(5, 0, 10, 0) == 0.5f);
}

TEST_CASE("heat maps: each pixel has its value's colour of the ramp, and none is grey") {
  Stage s;
  std::vector<uint32_t> counts, vertices;
  for (uint32_t y = 0; y < Stage::k_height; ++y)
    for (uint32_t x = 0; x < Stage::k_width; ++x) {
      counts.push_back(x == 3 ? 0 : 16 + 11 * x + y);
      vertices.push_back(40 * x + 100 * y);
    }
  std::vector<shared::BlockError> errors(s.film.blocks());
  for (uint32_t b = 1; b < errors.size(); ++b)  // the first is unknown
    for (uint32_t q = 0; q < 4; ++q) {
      errors[b].pixels = 64;
      errors[b].quadrant_pixels[q] = q == 3 && b % 3 == 0 ? 0.0f : 16.0f;
      errors[b].relative[q] = errors[b].quadrant_pixels[q] * 0.004f * static_cast<float>(b + q * b);
    }
  s.counts.write(std::span<const uint32_t>(counts));
  s.vertices.write(std::span<const uint32_t>(vertices));
  s.errors.write(std::span<const shared::BlockError>(errors));

  const film::HeatScale scales[] = {film::sample_scale(16, 512), film::sample_scale(0, 400),
                                    film::error_scale(0.05),
                                    film::cost_scale(900, 1e6, Stage::k_width * Stage::k_height, true)};
  const uint32_t layers[] = {shared::k_layer_samples, shared::k_layer_samples, shared::k_layer_error,
                             shared::k_layer_cost};
  CHECK(scales[0].logarithmic);
  CHECK_FALSE(scales[1].logarithmic);
  for (int n = 0; n < 4; ++n) {
    const film::HeatScale& scale = scales[n];
    const std::vector<uint8_t> shown = s.heat(layers[n], scale);
    float worst = 0;
    std::set<uint32_t> colours;
    for (uint32_t y = 0; y < Stage::k_height; ++y)
      for (uint32_t x = 0; x < Stage::k_width; ++x) {
        const size_t i = size_t(y) * Stage::k_width + x;
        const uint32_t block = y / 8 * s.film.blocks_across() + x / 8;
        const bool known = layers[n] == shared::k_layer_error ? block > 0 : counts[i] > 0;
        float value = static_cast<float>(counts[i]);
        if (layers[n] == shared::k_layer_cost) value = scale.unit * static_cast<float>(vertices[i]);
        if (layers[n] == shared::k_layer_error)
          value = static_cast<float>(film::tile_error({&errors[block], 1}).relative);
        vec3 expected(0.13f);
        if (known)
          expected = shared::ramp_color(scale.ramp,
                                        shared::ramp_position(value, scale.lo, scale.hi, scale.logarithmic));
        const vec3 found = pixel_of(shown, Stage::k_width, x, y);
        worst = std::max(worst, farthest(found, expected));
        colours.insert(static_cast<uint32_t>(found.x * 255) << 16 | static_cast<uint32_t>(found.y * 255));
      }
    INFO("layer " << layers[n]);
    CHECK(worst < 0.006f);  // a step and a half of 8 bits
    CHECK(colours.size() > 12);
  }
}

TEST_CASE("a tile's position on its ramp is logarithmic, from eight times the target to the target") {
  CHECK(film::tile_position(0.05, 0.05) == 1);
  CHECK(film::tile_position(0.001, 0.05) == 1);
  CHECK(film::tile_position(0.1, 0.05) == Approx(2.0 / 3));
  CHECK(film::tile_position(0.2, 0.05) == Approx(1.0 / 3));
  CHECK(film::tile_position(0.4, 0.05) == Approx(0).margin(1e-6));
  CHECK(film::tile_position(9, 0.05) == 0);
  for (const double odd : {-1.0, double{NAN}}) CHECK(film::tile_position(odd, 0.05) < 0);
  CHECK(film::tile_position(0.1, 0) < 0);
}

TEST_CASE("the overlay outlines active tiles, dims finished ones, marks others, and keeps the rest") {
  Stage s;
  constexpr uint32_t k_side = 16, k_across = 3;
  const vec3 base(0.5f, 0.6f, 0.4f);
  std::vector<uint32_t> before(Stage::k_width * Stage::k_height, 0xff669980u);
  const gpu::Kernel kernel(s.device, s.compiler, "film/tiles.comp");
  const auto draw = [&](const std::vector<TileMark>& marks) {
    gpu::Buffer picture(s.device, {.name = "test picture", .bytes = before.size() * 4});
    picture.write(std::span<const uint32_t>(before));
    s.film.mark_tiles(marks);
    s.film.bind(s.resources);
    s.resources.set("Picture", picture);
    s.stream.dispatch(kernel, s.resources,
                      shared::TilesPush{Stage::k_width, Stage::k_height, k_side, k_across, 1},
                      gpu::groups_for(before.size(), 64));
    s.stream.run();
    std::vector<uint8_t> shown(before.size() * 4);
    picture.read(shown.data(), shown.size());
    return shown;
  };
  const auto at = [&](const std::vector<uint8_t>& shown, uint32_t x, uint32_t y) {
    return pixel_of(shown, Stage::k_width, x, y);
  };
  // Two rows of three tiles: active and far, active and near, finished; limited, heavy-tailed and finished,
  // waiting.
  const std::vector<uint8_t> shown = draw({{0.0f, shared::k_tile_active},
                                           {1.0f, shared::k_tile_active},
                                           {1.0f, shared::k_tile_done},
                                           {0.4f, shared::k_tile_capped},
                                           {1.0f, shared::k_tile_done | shared::k_tile_heavy},
                                           {-1.0f, shared::k_tile_waiting}});
  const vec3 far = shared::ramp_color(shared::k_ramp_tiles, 0),
             near = shared::ramp_color(shared::k_ramp_tiles, 1);
  CHECK(farthest(at(shown, 8, 0), glm::mix(base, far, 0.85f)) < 0.06f);  // outlines in the ramp's colours
  CHECK(farthest(at(shown, 24, 0), glm::mix(base, near, 0.85f)) < 0.06f);
  CHECK(farthest(at(shown, 16, 8), glm::mix(base, near, 0.85f)) < 0.06f);  // one line between neighbours
  CHECK(farthest(at(shown, 15, 8), at(shown, 8, 8)) < 0.01f);
  CHECK(farthest(at(shown, 31, 8), glm::mix(base, near, 0.85f)) < 0.06f);  // and one towards a finished tile
  CHECK(farthest(at(shown, 8, 8), base) < 0.12f);                          // the picture is visible inside
  CHECK(at(shown, 8, 8).x - at(shown, 24, 8).x > 0.01f);                   // tinted
  CHECK(luminance(at(shown, 38, 8)) < 0.5f * luminance(base));  // finished: dim, without an outline
  CHECK(farthest(at(shown, 38, 0), at(shown, 38, 8)) < 0.01f);
  // Limited: dim too, with hatching.
  uint32_t hatched = 0, dim = 0;
  for (uint32_t y = 16; y < Stage::k_height; ++y)
    for (uint32_t x = 0; x < 16; ++x) (luminance(at(shown, x, y)) > 0.35f ? hatched : dim) += 1;
  CHECK(hatched > 16);
  CHECK(dim > hatched);
  // Heavy-tailed: the upper right corner.
  CHECK(luminance(at(shown, 31, 16)) > 0.45f);
  CHECK(luminance(at(shown, 17, 25)) < 0.3f);
  // Waiting without an error: a faint grey outline at the picture's edge, and nothing inside.
  const vec3 edge = at(shown, Stage::k_width - 1, 20), inside = at(shown, 38, 21);
  CHECK(farthest(inside, base) < 0.01f);
  CHECK(farthest(edge, base) > 0.01f);
  CHECK(farthest(edge, glm::mix(base, vec3(0.62f), 0.25f)) < 0.02f);
}

}  // namespace film_overlay_tests
