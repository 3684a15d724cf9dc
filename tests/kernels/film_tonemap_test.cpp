// links: film
// The tone curves on the device equal those of the host: the window shows the values of a PNG.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/tonemap.h"
#include "gpu/stream.h"

namespace film_tonemap_tests {

using namespace lucerna;

TEST_CASE("the device's tone curves equal the host's, also for unusual values") {
  gpu::Device device({"", true});
  gpu::ShaderCompiler compiler;
  const gpu::Kernel kernel(device, compiler,
                           std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/film_tonemap.comp", {});
  std::mt19937 random(19);
  std::uniform_real_distribution<float> stop(-18, 18);
  std::vector<vec3> colours(20000);
  for (vec3& c : colours) c = {std::exp2(stop(random)), std::exp2(stop(random)), std::exp2(stop(random))};
  const float odd[] = {0, -1, NAN, INFINITY, -INFINITY, 3.4e38f, 1e-42f};
  for (size_t i = 0; i < 700; ++i) colours[i][static_cast<int>(i % 3)] = odd[i % 7];
  for (size_t i = 0; i < 7; ++i) colours[i] = vec3(odd[i]);

  const uint64_t bytes = colours.size() * sizeof(vec3);
  gpu::Buffer radiance(device, {"radiance", bytes}), shown(device, {"shown", bytes});
  radiance.write(std::span<const vec3>(colours));
  gpu::Resources resources;
  resources.set("Radiance", radiance);
  resources.set("Shown", shown);
  for (const uint32_t curve : {shared::k_tone_neutral, shared::k_tone_agx, shared::k_tone_linear}) {
    struct {
      uint32_t count, curve;
    } push{static_cast<uint32_t>(colours.size()), curve};
    gpu::Stream stream(device);
    stream.dispatch(kernel, resources, push, (push.count + 63) / 64);
    stream.run();
    const auto found = shown.read_all<vec3>();
    float worst = 0;
    size_t at = 0;
    bool finite = true;
    for (size_t i = 0; i < colours.size(); ++i) {
      const vec3 expected = shared::tone_map(colours[i], curve);
      for (int c = 0; c < 3; ++c) {
        const float difference = std::abs(found[i][c] - expected[c]);
        finite = finite && std::isfinite(found[i][c]);
        if (difference > worst) worst = difference, at = i;
      }
    }
    INFO("curve " << curve << ": " << worst << " at " << colours[at].x << ' ' << colours[at].y << ' '
                  << colours[at].z);
    CHECK(finite);
    CHECK(worst < 1e-3f);  // a quarter of an 8-bit step; pow and log2 on devices have a few more ulp
  }
  CHECK(device.validation_messages() == 0);
}

}  // namespace film_tonemap_tests
