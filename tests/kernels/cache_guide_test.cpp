// links: irradiance_cache
// Guided directions of paths that gather along edges: draws follow the stated density, wherever the vertex's
// normal differs from the record's.
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "base/math.h"
#include "kernels/gpu_support.h"
#include "kernels/statistics_support.h"
#include "shaders/shared/irradiance_cache/records.h"

namespace cache_guide_tests {

using namespace lucerna;
using namespace lucerna::shared;

namespace {

constexpr uint32_t k_draws = 1 << 17, k_cells = k_guide_azimuths * k_guide_elevations;
using Cells = std::array<uint32_t, k_cells>;

struct Push {
  uint32_t count, record;
  vec3 normal;
};

/// make_basis() of shaders/lib/math.glsl.
std::array<vec3, 2> basis(const vec3& n) {
  const float s = n.z >= 0 ? 1.0f : -1.0f, a = -1 / (s + n.z), c = n.x * n.y * a;
  return {vec3(1 + s * n.x * n.x * a, s * c, -s * n.x), vec3(c, s + n.y * n.y * a, -n.y)};
}

/// The guide's cell of a direction, in the frame that the vertex rotates it to.
size_t cell_of(const vec3& direction, const vec3& normal, const vec3& record_normal) {
  const vec3 t = basis(record_normal)[0];
  const vec3 tangent = normalize(t - dot(t, normal) * normal), bitangent = cross(normal, tangent);
  const double x = dot(direction, tangent), y = dot(direction, bitangent);
  double turn = std::atan2(y, x) / (2 * M_PI);
  turn += turn < 0 ? 1 : 0;
  const auto azimuth = std::min(uint32_t(turn * k_guide_azimuths), k_guide_azimuths - 1);
  const auto elevation = std::min(uint32_t((x * x + y * y) * k_guide_elevations), k_guide_elevations - 1);
  return azimuth * k_guide_elevations + elevation;
}

struct Bed {
  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{silent.device};
  gpu::Kernel kernel{silent.device, compiler, test::shader("guide_probe.comp")};

  /// Draws from record 1 of two, with those cells and that normal; the other record's differ.
  std::vector<vec4> draw(const Cells& cells, const vec3& record_normal, const vec3& normal,
                         const std::vector<vec2>& points, uint32_t record = 1) {
    const size_t lights = size_t{k_part_count} * k_part_texels;
    std::vector<vec4> places(2 * k_record_texels, vec4(7)), words(2 * lights, vec4(0.3f));
    places[k_record_texels + 1] = vec4(record_normal, 0);
    for (uint32_t t = 0; t < k_guide_texels; ++t)
      for (int w = 0; w < 4; ++w) {
        uint32_t word = 0;
        for (uint32_t b = 0; b < 4; ++b) word |= cells[16 * t + 4 * uint32_t(w) + b] << 8 * b;
        words[lights + t][w] = std::bit_cast<float>(word);
      }
    gpu::Device& d = silent.device;
    gpu::Buffer record_texels(d, {.name = "records", .bytes = places.size() * sizeof(vec4), .texel = true}),
        irradiance(d, {.name = "irradiance", .bytes = words.size() * sizeof(vec4), .texel = true}),
        at(d, {.name = "points", .bytes = points.size() * sizeof(vec2)}),
        drawn(d, {.name = "drawn", .bytes = points.size() * sizeof(vec4)});
    record_texels.write(std::span<const vec4>(places));
    irradiance.write(std::span<const vec4>(words));
    at.write(std::span<const vec2>(points));
    gpu::Resources resources;
    resources.set("record_texels", record_texels);
    resources.set("irradiance_texels", irradiance);
    resources.set("Points", at);
    resources.set("Drawn", drawn);
    stream.dispatch(kernel, resources, Push{uint32_t(points.size()), record, normal},
                    gpu::groups_for(points.size(), 64));
    stream.run();
    std::vector<vec4> out(points.size());
    drawn.read(out.data(), out.size() * sizeof(vec4));
    return out;
  }
};

std::vector<vec2> random_points() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(0, 0x1.fffffep-1f);
  std::vector<vec2> points(k_draws);
  for (vec2& p : points) p = vec2(any(random), any(random));
  return points;
}

}  // namespace

TEST_CASE("guided directions follow their stated density, which integrates to 1") {
  Bed bed;
  Cells lamp{}, any{}, full{};
  lamp[77] = k_guide_most;
  std::mt19937 random(3);
  for (uint32_t& c : any) c = random() % 3 ? 0 : random() % (k_guide_most + 1);
  full.fill(k_guide_most);
  const vec3 up = normalize(vec3(0.3f, -0.5f, 0.8f)), down = normalize(vec3(0.1f, 0.2f, -0.9f));
  const vec3 tilted = normalize(up + vec3(0.1f, 0.15f, 0));
  test::Jury jury;
  int wrong = 0;
  for (const auto& [name, cells] :
       {std::pair{"one cell", lamp}, std::pair{"some", any}, std::pair{"all", full}})
    for (const auto& [record_normal, normal] :
         {std::pair{up, up}, std::pair{down, down}, std::pair{up, tilted}}) {
      double total = 0;
      for (const uint32_t c : cells) total += c;
      std::vector<double> observed(k_cells), expected(k_cells);
      test::Mean one;  // 1 over the density, whose mean is the cosine's integral
      for (const vec4& d : bed.draw(cells, record_normal, normal, random_points())) {
        const vec3 direction(d);
        wrong += std::abs(length(direction) - 1) > 1e-5f || dot(direction, normal) < -1e-4f;
        const size_t cell = cell_of(direction, normal, record_normal);
        ++observed[cell];
        one.add(1 / double(d.w));
      }
      for (size_t c = 0; c < k_cells; ++c)
        expected[c] = k_draws * (0.5 * cells[c] / total + 0.5 / double(k_cells));
      jury.add(std::string(name) + ", cells", test::chi_square(observed, expected).p);
      jury.add(std::string(name) + ", integral", test::mean_tail(one, 1, 1e-6));
    }
  CHECK(wrong == 0);
  CHECK(jury.size() == 18);
  CHECK(jury.verdict() == "");
}

TEST_CASE("an empty guide keeps the cosine distribution") {
  Bed bed;
  const vec3 up(0, 0, 1);
  const std::vector<vec2> points = random_points();
  for (const uint32_t record : {1u, k_no_guide}) {
    test::Mean cosine;
    int wrong = 0;
    for (const vec4& d : bed.draw({}, up, up, points, record)) wrong += d.w != 1, cosine.add(double(d.z));
    CHECK(wrong == 0);
    CHECK(test::mean_tail(cosine, 2.0 / 3, 1e-6) > 1e-4);
  }
}

}  // namespace cache_guide_tests
