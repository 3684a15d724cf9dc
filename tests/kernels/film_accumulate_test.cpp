// links: film
// The film's sums through the real kernel: a million samples of mixed magnitude sum without drift.
#include <catch2/catch.hpp>
#include <cmath>

#include "film/film.h"
#include "support/device_name.h"

namespace film_accumulate_tests {

using namespace lucerna;

namespace {

/// Sample `s` of a component: mostly small values with digits that a float sum cannot hold, occasionally a
/// firefly a million times larger.
float sample_value(uint32_t pixel, uint32_t component, uint32_t s) {
  uint32_t h = (s * 4 + component) * 64 + pixel;
  h = (h ^ h >> 16) * 0x7feb352du, h = (h ^ h >> 15) * 0x846ca68bu, h ^= h >> 16;
  const float u = float(h >> 8) * (1.0f / 16777216.0f);
  return (h & 0xfffu) == 7u ? 3e5f * u : 0.1f + 0.3f * u;
}

}  // namespace

TEST_CASE("a million samples of mixed magnitude: each half's sum is accurate to float's last digits") {
  gpu::Device device({test::device_name(), true});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  film::Film film(device, 8, 8);
  film.clear(stream);
  // Storage buffers, and images for films that do not fit into one buffer.
  const bool images = GENERATE(false, true);
  const gpu::Kernel add(device, compiler, "film/add.comp", {{"LUCERNA_FILM_IMAGES", images ? "1" : "0"}});
  constexpr uint32_t k_batch = 1000, k_batches = 1000;
  gpu::Buffer radiance(device, {.name = "radiance", .bytes = 64 * k_batch * 4 * sizeof(vec4), .texel = true});
  gpu::Buffer features(device, {.name = "features", .bytes = 64 * k_batch * 2 * sizeof(vec4), .texel = true});
  stream.fill(features, 0);
  stream.run();
  gpu::Resources resources;
  film.bind(resources);
  gpu::Buffer block(device, {.name = "work blocks", .bytes = sizeof(shared::WorkBlock)});
  resources.set("WorkBlocks", block);
  resources.set("radiance_texels", radiance);
  resources.set("feature_texels", features);
  // Three different pixels; the rest of the tile repeats them.
  std::vector<vec4> values(64 * k_batch * 4);
  double even[3][4] = {}, odd[3][4] = {}, naive_error = 0;
  float naive = 0;
  double naive_truth = 0;
  for (uint32_t batch = 0; batch < k_batches; ++batch) {
    for (uint32_t i = 0; i < k_batch; ++i)
      for (uint32_t c = 0; c < 4; ++c) {
        float of[3];
        for (uint32_t p = 0; p < 3; ++p) {
          of[p] = sample_value(p, c, batch * k_batch + i);
          ((batch * k_batch + i) % 2 ? odd : even)[p][c] += of[p];
        }
        if (c == 0) naive += of[0], naive_truth += of[0];
        for (uint32_t pixel = 0; pixel < 64; ++pixel)
          values[(size_t(i) * 64 + pixel) * 4 + c] = vec4(of[pixel % 3], 2 * of[pixel % 3], 0, 0);
      }
    radiance.write(std::span<const vec4>(values));
    block.write(std::span<const shared::WorkBlock>({shared::WorkBlock{0, batch * k_batch}}));
    stream.dispatch(add, resources, shared::FilmPush{8, 8, 64, k_batch, 0, 0}, 1);
    stream.run();
  }
  naive_error = std::abs(naive - naive_truth) / naive_truth;
  const film::Image image = film.read();
  CHECK(naive_error > 1e-6);  // otherwise this test proves nothing
  const auto compact = [](uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); };
  for (uint32_t code = 0; code < 64; ++code) {
    const size_t pixel = compact(code >> 1) * 8 + compact(code);
    const uint32_t p = code % 3;
    CHECK(image.samples[pixel] == k_batch * k_batches);
    for (int c = 0; c < 4; ++c) {
      const double mean = (even[p][c] + odd[p][c]) / (k_batch * k_batches),
                   odd_mean = odd[p][c] * 2 / (k_batch * k_batches);
      INFO("code " << code << " component " << c);
      CHECK(std::abs(image.components[c][pixel].x - mean) <= 6e-8 * 2 * mean);
      CHECK(std::abs(image.components[c][pixel].y - 2 * mean) <= 6e-8 * 4 * mean);
      CHECK(std::abs(image.odd_half[c][pixel].x - odd_mean) <= 6e-8 * 2 * odd_mean);
      CHECK(image.components[c][pixel].z == 0);
    }
  }
  CHECK(device.validation_messages() == 0);
}

}  // namespace film_accumulate_tests
