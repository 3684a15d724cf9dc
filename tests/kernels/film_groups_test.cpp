// links: film
// Compact sums by light group, through the real kernel: unbiased for any ratio of sample and sum, as noisy as
// stated, over the whole range of floats, and bit-identical for any division of samples into batches.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "film/film.h"
#include "shaders/shared/group_sums.h"
#include "support/device_name.h"

namespace film_groups_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_groups = 2, k_side = 64, k_pixels = k_side * k_side, k_blocks = k_pixels / 64;
constexpr uint32_t k_lanes = 4 + k_groups;

/// The contribution of sample `s` to a group, the same in every pixel: pixels then differ by rounding only.
using Contribution = std::function<vec3(uint32_t group, uint32_t s)>;

/// A film, and the kernel that adds to it.
struct Bench {
  gpu::Device device{{test::device_name(), true}};
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{device};
  film::Film film{device, k_side, k_side, k_groups, film::GroupStorage::compact};
  gpu::Kernel add;
  gpu::Buffer block, radiance;
  gpu::Resources resources;

  explicit Bench(bool images = false)
      : add(device, compiler, "film/add_groups.comp",
            {{"LUCERNA_LIGHT_GROUPS", std::to_string(k_groups)},
             {"LUCERNA_GROUP_SUMS", "1"},
             {"LUCERNA_FILM_IMAGES", images ? "1" : "0"}}),
        block(device, {.name = "work blocks", .bytes = k_blocks * sizeof(shared::WorkBlock)}) {
    film.clear(stream);
    film.bind(resources);
    resources.set("WorkBlocks", block);
  }
  ~Bench() { CHECK(device.validation_messages() == 0); }

  /// Adds samples `first` to `first + count`, in batches of `batch`.
  void samples(uint32_t first, uint32_t count, uint32_t batch, const Contribution& contribution) {
    radiance = gpu::Buffer(
        device,
        {.name = "radiance", .bytes = uint64_t{k_pixels} * batch * k_lanes * sizeof(vec4), .texel = true});
    resources.set("radiance_texels", radiance);
    // The kernel ignores components and groups without light of the path: nothing is written for them.
    std::vector<vec4> values(size_t{k_pixels} * batch * k_lanes, vec4(7));
    std::vector<shared::WorkBlock> blocks(k_blocks);
    for (uint32_t done = 0; done < count; done += batch) {
      const uint32_t n = std::min(batch, count - done);
      for (uint32_t i = 0; i < n; ++i) write_sample(values, i, first + done + i, contribution);
      radiance.write(std::span<const vec4>(values));
      for (uint32_t b = 0; b < k_blocks; ++b) blocks[b] = {b, first + done};
      block.write(std::span<const shared::WorkBlock>(blocks));
      stream.dispatch(add, resources, shared::FilmPush{k_side, k_side, k_pixels, n, 0, 0}, k_blocks);
      stream.run();
    }
  }

  /// The contribution of path `i` of every pixel, as written by transport/shade.comp: groups with light have
  /// a bit.
  static void write_sample(std::vector<vec4>& values, uint32_t i, uint32_t sample,
                           const Contribution& contribution) {
    uint32_t lit = 0;
    vec3 light[k_groups];
    for (uint32_t g = 0; g < k_groups; ++g) {
      light[g] = contribution(g, sample);
      if (light[g] != vec3(0)) lit |= 1u << g;
    }
    for (uint32_t p = 0; p < k_pixels; ++p) {
      vec4* path = &values[(size_t{i} * k_pixels + p) * k_lanes];
      path[0].w = glm::uintBitsToFloat(lit);
      for (uint32_t g = 0; g < k_groups; ++g) path[4 + g] = lit >> g & 1u ? vec4(light[g], 0) : vec4(7);
    }
  }

  /// A group's sums of even and odd samples by pixel. The sample count is 0, so a mean is a sum.
  std::vector<vec3> sums(uint32_t group) const { return film.read_group_sum(group); }
};

struct Moments {
  double mean = 0, deviation = 0;
};

Moments moments(const std::vector<vec3>& values, int channel) {
  double sum = 0, squares = 0;
  for (const vec3& v : values) sum += double{v[channel]}, squares += double{v[channel]} * double{v[channel]};
  const double n = double(values.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

/// Halves rounded separately, each with half of the samples, have together at most the noise of a single sum.
double estimated_deviation(double samples) { return std::min(std::sqrt(samples / 12) / 131072, 1.0 / 512); }

}  // namespace

TEST_CASE(
    "small samples beside a large sum are not lost: the mean over pixels is right to 5 standard errors") {
  // An eighth of the sum's last bit: rounding to nearest would lose every sample.
  constexpr uint32_t k_small = 4000;
  const float small = 0x1p-20f;
  Bench b;
  const Contribution contribution = [&](uint32_t group, uint32_t s) {
    return (s < 2 ? 1.0f : small) * vec3(1, 0.5f, 0) * (group == 0 ? 1.0f : 0x1p-9f);
  };
  b.samples(0, 2 + k_small, 64, contribution);
  for (uint32_t g = 0; g < k_groups; ++g)
    for (int k = 0; k < 3; ++k) {
      double exact = 0;
      for (uint32_t s = 0; s < 2 + k_small; ++s) exact += double{contribution(g, s)[k]};
      const Moments m = moments(b.sums(g), k);
      INFO("group " << g << " channel " << k);
      CHECK(std::abs(m.mean - exact) <= 5 * m.deviation / std::sqrt(double{k_pixels}));
      CHECK((m.deviation > 0) == (k < 2));
    }
}

TEST_CASE("sums of many samples are unbiased, and no noisier than stated") {
  // Samples of different size with the group's mean in all channels; pixels differ by rounding.
  const Contribution contribution = [](uint32_t group, uint32_t s) {
    const float x = float((s * 2654435761u) >> 8) * 0x1p-24f;
    return (group == 0 ? 3.7f : 1e-6f) * vec3(x, 0.3f, 0.9f * x * x);
  };
  Bench b;
  double exact[k_groups][3] = {};
  uint32_t done = 0;
  for (const uint32_t samples : {16u, 256u, 4096u}) {
    b.samples(done, samples - done, std::min(samples, 64u), contribution);
    for (; done < samples; ++done)
      for (uint32_t g = 0; g < k_groups; ++g)
        for (int k = 0; k < 3; ++k) exact[g][k] += double{contribution(g, done)[k]};
    for (uint32_t g = 0; g < k_groups; ++g)
      for (int k = 0; k < 3; ++k) {
        const Moments m = moments(b.sums(g), k);
        INFO(samples << " samples, group " << g << ", channel " << k << ": " << m.deviation / exact[g][k]);
        CHECK(std::abs(m.mean - exact[g][k]) <= 5 * m.deviation / std::sqrt(double{k_pixels}));
        // The bit is that of the largest channel.
        const double largest = std::max({exact[g][0], exact[g][1], exact[g][2]});
        CHECK(m.deviation <= 1.1 * estimated_deviation(samples) * largest);
        CHECK(m.deviation > 0);
      }
  }
}

TEST_CASE("sums are bit-identical for any batches and either way of writing") {
  const Contribution contribution = [](uint32_t group, uint32_t s) {
    return std::exp2(float(s * 37 % 23) - 11.0f) * vec3(0.3f, 1 + 0.1f * float(group), float(s % 3));
  };
  std::vector<vec3> first[k_groups];
  for (const uint32_t batch : {37u, 1u, 8u, 37u}) {
    Bench b(batch == 8);  // through images
    b.samples(5, 37, batch, contribution);
    for (uint32_t g = 0; g < k_groups; ++g) {
      const std::vector<vec3> sums = b.sums(g);
      if (first[g].empty()) first[g] = sums;
      CHECK(sums == first[g]);
      CHECK(std::any_of(sums.begin(), sums.end(), [&](const vec3& v) { return v != sums[0]; }));
    }
  }
}

TEST_CASE("sums range from 1e-32 to 1e36, and represent one sample exactly") {
  for (const float scale : {1e-32f, 1e-20f, 1.0f, 1e20f, 1e36f}) {
    INFO(scale);
    Bench b;
    b.samples(0, 1, 1,
              [&](uint32_t group, uint32_t) { return group == 0 ? scale * vec3(1, 0.25f, 0) : vec3(0); });
    for (const vec3& v : b.sums(0)) {
      CHECK(std::abs(v.x - scale) <= scale * 0x1p-17f);
      CHECK(std::abs(v.y - 0.25f * scale) <= scale * 0x1p-17f);
      CHECK(v.z == 0);
    }
    for (const vec3& v : b.sums(1)) CHECK(v == vec3(0));
    // A large one after it, and a far smaller one: the large one's share is correct.
    b.samples(1, 2, 1, [&](uint32_t group, uint32_t s) {
      return group == 0 ? vec3(0) : s == 1 ? vec3(scale) : vec3(1e-12f * scale);
    });
    const Moments m = moments(b.sums(1), 0);
    CHECK(std::abs(m.mean - double{scale}) <= double{scale} * 0x1p-17);
  }
}

TEST_CASE("a channel that is negligible beside the others is scaled with them in a mix") {
  CHECK(shared::group_ratio(vec3(2, 0, 0), vec3(1, 0, 4)) == vec3(2, 0.4f, 0));
  CHECK(shared::group_ratio(vec3(0), vec3(0)) == vec3(1));
  CHECK(shared::group_ratio(vec3(0), vec3(3, 2, 0)) == vec3(0));
}

TEST_CASE("samples without light of a group add nothing to it, whatever memory contains") {
  Bench bench;
  // Whole numbers, which are represented exactly; each group has light in some samples of a batch.
  const auto contribution = [](uint32_t group, uint32_t sample) {
    return sample % (2 + group) == 0 ? vec3(1, 2, float(1 + group)) : vec3(0);
  };
  bench.samples(0, 12, 6, contribution);
  for (uint32_t g = 0; g < k_groups; ++g) {
    vec3 right(0);
    for (uint32_t s = 0; s < 12; ++s) right += contribution(g, s);
    const std::vector<vec3> sums = bench.sums(g);
    INFO("group " << g);
    CHECK(std::all_of(sums.begin(), sums.end(), [&](const vec3& v) { return v == right; }));
  }
}

}  // namespace film_groups_tests
