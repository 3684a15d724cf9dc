// links: irradiance_cache
// The screen-space stage of the irradiance cache: the measure of detail, its pyramid compared with the host,
// and the number of points that dithering draws compared with their probabilities.
#include <cmath>
#include <random>

#include "kernels/gpu_support.h"
#include "solvers/irradiance_cache/cache.h"

namespace cache_discontinuity_tests {

using namespace lucerna;
using irradiance_cache::Discontinuity;
using irradiance_cache::DiscontinuityOptions;
using Of = Discontinuity::Of;

namespace {

/// A camera at the origin that looks along -z, and the surfaces it sees.
struct View {
  uint32_t width, height;
  bool parallel = false;
  std::vector<vec4> surfaces;
  std::vector<vec3> lit;

  View(uint32_t w, uint32_t h, bool p = false)
      : width(w), height(h), parallel(p), surfaces(2 * w * h, vec4(0)), lit(w * h, vec3(-1, INFINITY, 0)) {
    for (uint32_t i = 0; i < w * h; ++i) surfaces[2 * i].w = -1;
  }
  shared::Frame frame() const {
    shared::Frame f{};
    f.width = width, f.height = height;
    f.camera_right = vec3(half() * float(width) / float(height), 0, 0);
    f.camera_up = vec3(0, half(), 0);
    f.camera_forward = f.camera_axis = vec3(0, 0, -1);
    f.projection = parallel ? shared::k_projection_orthographic : shared::k_projection_perspective;
    return f;
  }
  static float half() { return 0.5f; }
  float pixel() const { return 2 * half() / float(height); }
  vec2 shift(uint32_t x, uint32_t y) const {
    const vec2 ndc = (vec2(float(x), float(y)) + 0.5f) / vec2(float(width), float(height)) * 2.0f - 1.0f;
    return {ndc.x * half() * float(width) / float(height), -ndc.y * half()};
  }
  /// Places the plane n x = d at a pixel.
  void plane(uint32_t x, uint32_t y, const vec3& n, float d) {
    const vec3 origin = parallel ? vec3(shift(x, y), 0) : vec3(0);
    const vec3 along = parallel ? vec3(0, 0, -1) : vec3(shift(x, y), -1);
    const float t = (d - dot(n, origin)) / dot(n, along);
    surfaces[2 * (y * width + x)] = vec4(origin + t * along, t);
    surfaces[2 * (y * width + x) + 1] = vec4(n, 0);
  }
  template <class Fill>
  void each(Fill&& fill) {
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) fill(x, y);
  }
};

/// detail.comp on the host.
float change(const View& v, uint32_t p, uint32_t q, uint32_t level, Of of, const DiscontinuityOptions& o,
             float least) {
  const vec4 &a = v.surfaces[2 * p], &b = v.surfaces[2 * q];
  if (a.w < 0 || b.w < 0) return 0;
  const vec3 away(b - a), n(v.surfaces[2 * p + 1]), m(v.surfaces[2 * q + 1]);
  const float cell = v.pixel() * float(1u << level) * (v.parallel ? 1 : std::min(a.w, b.w));
  const float geometry =
      std::max(o.depth_weight * std::max(std::abs(dot(away, n)), std::abs(dot(away, m))) / cell,
               o.normal_weight * length(n - m));
  if (of == Of::geometry) return std::min(geometry, 1.0f);
  const float e = v.lit[p].x, f = v.lit[q].x;
  if (geometry >= 1 || e < 0 || f < 0) return 0;
  return std::min(1.0f, std::max(0.0f, std::abs(e - f) / std::max({e, f, least}) - o.irradiance_noise) *
                            o.irradiance_weight);
}

struct Level {
  uint32_t across, down;
  std::vector<float> values;
  float at(uint32_t x, uint32_t y) const { return values[y * across + x]; }
};

std::vector<Level> pyramid(const View& v, Of of, const DiscontinuityOptions& o, float least) {
  std::vector<Level> all;
  for (uint32_t k = 0;; ++k) {
    const uint32_t side = 1u << k;
    Level level{(v.width + side - 1) / side, (v.height + side - 1) / side, {}};
    const auto middle = [&](uint32_t x, uint32_t y) {
      return std::min(y * side + side / 2, v.height - 1) * v.width +
             std::min(x * side + side / 2, v.width - 1);
    };
    for (uint32_t y = 0; y < level.down; ++y)
      for (uint32_t x = 0; x < level.across; ++x) {
        float own = 0, sum = 0, n = 0;
        const auto look = [&](uint32_t i, uint32_t j) {
          own = std::max(own, change(v, middle(x, y), middle(i, j), k, of, o, least));
        };
        if (x > 0) look(x - 1, y);
        if (y > 0) look(x, y - 1);
        if (x + 1 < level.across) look(x + 1, y);
        if (y + 1 < level.down) look(x, y + 1);
        for (uint32_t j = 2 * y; k > 0 && j < std::min(2 * y + 2, all.back().down); ++j)
          for (uint32_t i = 2 * x; i < std::min(2 * x + 2, all.back().across); ++i)
            sum += all.back().at(i, j), n += 1;
        level.values.push_back(std::min(1.0f, own + (n > 0 ? sum / n : 0)));
      }
    all.push_back(std::move(level));
    if (all.back().values.size() == 1) return all;
  }
}

struct Bench {
  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{silent.device};
  Discontinuity screen{silent.device, compiler, {{"LUCERNA_CACHE_PARTS", "14u"}}};

  void measure(const View& v, Of of, const DiscontinuityOptions& o = {}, float least = 0.1f) {
    screen.begin(v.frame());
    screen.set(v.surfaces, v.lit);
    screen.measure(stream, of, o, least);
    stream.run();
  }
  std::vector<uint32_t> dither(Of of, const DiscontinuityOptions& o, uint32_t seed,
                               const Discontinuity::Scale& scale = {}) {
    screen.dither(stream, of, o, scale, seed);
    stream.run();
    return screen.taken();
  }
};

/// Every kind of content: walls at all angles, steps, holes, changes of light.
View scramble(uint32_t width, uint32_t height, bool parallel = false) {
  View v(width, height, parallel);
  std::mt19937 random(7);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<vec4> planes;
  for (int i = 0; i < 40; ++i)
    planes.emplace_back(normalize(vec3(0.4f * unit() - 0.2f, 0.4f * unit() - 0.2f, 1)), -2 - 3 * unit());
  v.each([&](uint32_t x, uint32_t y) {
    const vec4& p = planes[(x / 5 * 3 + y / 4 * 7) % planes.size()];
    if (unit() < 0.9f) v.plane(x, y, vec3(p), p.w);
    v.lit[y * width + x] = vec3(unit() < 0.8f ? 0.02f + unit() : -1.0f, unit(), 0);
  });
  return v;
}

}  // namespace

TEST_CASE("a flat wall has no detail at any level, whatever its slope") {
  Bench bench;
  for (const bool parallel : {false, true})
    for (const vec3 n : {vec3(0, 0, 1), vec3(0.9f, 0, 0.3f), vec3(0.5f, -0.8f, 0.33f)}) {
      View v(61, 35, parallel);
      v.each([&](uint32_t x, uint32_t y) { v.plane(x, y, normalize(n), -3); });
      bench.measure(v, Of::geometry);
      REQUIRE(bench.screen.levels() == 7);
      for (uint32_t k = 0; k < bench.screen.levels(); ++k)
        for (const float d : bench.screen.level(k)) REQUIRE(d < 2e-4f);
      for (const uint32_t level : bench.dither(Of::geometry, {}, 1)) REQUIRE(level == bench.screen.levels());
      // Some points are placed on a wall anyway: one per square of that side. For this number of independent
      // points the total is within 5 deviations in all but one of 10^6 runs.
      constexpr float k_side = 0.3f;
      const auto width = [&](uint32_t i) { return v.pixel() * (parallel ? 1 : v.surfaces[2 * i].w); };
      double expected = 0;
      for (uint32_t i = 0; i < 61 * 35; ++i)
        if (v.surfaces[2 * i].w >= 0)
          expected += std::pow(std::min(double(width(i)) / double(k_side), 1.0), 2);
      uint32_t drawn = 0;
      const std::vector<uint32_t> taken = bench.dither(Of::geometry, {}, 1, {.flat_side = k_side});
      for (uint32_t i = 0; i < taken.size(); ++i) {
        if (taken[i] == bench.screen.levels()) continue;
        ++drawn;
        // The finest cells that are at least as wide as the square.
        const float cell = width(i) * float(1u << taken[i]);
        REQUIRE(cell >= 0.999f * k_side);
        REQUIRE((taken[i] == 0 || cell <= 2.001f * k_side));
      }
      INFO(drawn << " of " << expected);
      CHECK(expected > 5);
      CHECK(std::abs(drawn - expected) < 5 * std::sqrt(expected));
    }
}

TEST_CASE("a step counts by its height in cells, an edge by its angle") {
  Bench bench;
  // Seen from the front, nearer on the left of column 32.
  constexpr float k_step = 0.01f;
  View v(64, 32);
  v.each([&](uint32_t x, uint32_t y) { v.plane(x, y, vec3(0, 0, 1), x < 32 ? -3 : -3 - k_step); });
  bench.measure(v, Of::geometry);
  const std::vector<float> fine = bench.screen.level(0), next = bench.screen.level(1);
  const float expected = std::min(1.0f, 3 * k_step / (3 * v.pixel()));
  REQUIRE(expected > 0.2f);
  REQUIRE(expected < 0.5f);
  for (uint32_t y = 0; y < 32; ++y)
    for (uint32_t x = 0; x < 64; ++x)
      CHECK(fine[y * 64 + x] == Approx(x == 31 || x == 32 ? expected : 0).margin(1e-4));
  // Half as high relative to cells twice as wide, and half of their pixels are at the step.
  for (uint32_t x = 0; x < 32; ++x)
    CHECK(next[5 * 32 + x] == Approx(x == 15 || x == 16 ? expected / 2 + expected / 2 : 0).margin(1e-4));

  // Two walls that meet: the same at every level, up to the maximum.
  const float turn = 0.05f;
  View edge(64, 32);
  edge.each([&](uint32_t x, uint32_t y) {
    edge.plane(x, y, vec3(x < 32 ? std::sin(turn) : -std::sin(turn), 0, std::cos(turn)), -3 * std::cos(turn));
  });
  bench.measure(edge, Of::geometry);
  const float own = 3 * 2 * std::sin(turn);
  CHECK(bench.screen.level(0)[31] == Approx(own).margin(1e-4));
  CHECK(bench.screen.level(1)[15] == Approx(own + own / 2).margin(1e-4));
  CHECK(bench.screen.level(2)[7] == Approx(own + (own + own / 2) / 2).margin(1e-4));
  CHECK(bench.screen.level(0)[30] < 1e-4f);
}

TEST_CASE("irradiance counts where it changes on one surface, and only there") {
  Bench bench;
  const DiscontinuityOptions o{.irradiance_weight = 1.5f, .irradiance_noise = 0.1f};
  View v(16, 16);
  v.each([&](uint32_t x, uint32_t y) {
    v.plane(x, y, y < 8 ? vec3(0, 0, 1) : normalize(vec3(0, 1, 1)), -3);
    v.lit[y * 16 + x] = vec3(x < 4 ? -1.0f : x < 10 ? 2.0f : 3.0f, 0.5f, 0);
  });
  // Another light below the edge belongs to another surface.
  for (uint32_t i = 8 * 16; i < 16 * 16; ++i) v.lit[i].x = v.lit[i].x > 0 ? 0.05f : -1.0f;
  bench.measure(v, Of::irradiance, o, 0.2f);
  const std::vector<float> fine = bench.screen.level(0);
  for (uint32_t y = 0; y < 16; ++y)
    for (uint32_t x = 0; x < 16; ++x) {
      INFO(x << " " << y);
      CHECK(fine[y * 16 + x] ==
            Approx(y < 8 && (x == 9 || x == 10) ? 1.5f * (1 / 3.0f - 0.1f) : 0).margin(1e-5));
    }
}

TEST_CASE("the pyramid equals that of the host, for pictures of any size") {
  Bench bench;
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {2u, 1u}, {1u, 5u}, {37u, 23u}, {64u, 64u}, {65u, 33u}})
    for (const bool parallel : {false, true})
      for (const Of of : {Of::geometry, Of::irradiance}) {
        const View v = scramble(width, height, parallel);
        const DiscontinuityOptions o{.depth_weight = 0.4f, .normal_weight = 0.7f, .irradiance_noise = 0.05f};
        bench.measure(v, of, o, 0.1f);
        const std::vector<Level> expected = pyramid(v, of, o, 0.1f);
        REQUIRE(bench.screen.levels() == expected.size());
        double sum = 0;
        for (uint32_t k = 0; k < expected.size(); ++k) {
          const std::vector<float> found = bench.screen.level(k);
          REQUIRE(found.size() == expected[k].values.size());
          for (size_t i = 0; i < found.size(); ++i) {
            INFO(width << "x" << height << " level " << k << " cell " << i);
            REQUIRE(found[i] == Approx(expected[k].values[i]).margin(2e-4));
            sum += double(found[i]);
          }
        }
        if (width > 30) CHECK(sum > 10);
      }
}

TEST_CASE("points are drawn with their probabilities") {
  Bench bench;
  const DiscontinuityOptions o{
      .density = 0.3f, .falloff = 0.4f, .depth_weight = 0.05f, .normal_weight = 0.2f};
  View v = scramble(37, 23);
  for (vec3& l : v.lit) l = vec3(-1, INFINITY, 0);  // no pixel has records
  bench.measure(v, Of::geometry, o);
  const uint32_t levels = bench.screen.levels();
  std::vector<std::vector<float>> probability(levels, std::vector<float>(37 * 23, 0));
  for (uint32_t k = 0; k < levels; ++k) {
    const std::vector<float> cells = bench.screen.level(k);
    const uint32_t across = (37 + (1u << k) - 1) >> k;
    for (uint32_t i = 0; i < 37 * 23; ++i)
      if (v.surfaces[2 * i].w >= 0)
        probability[k][i] =
            o.density * std::pow(o.falloff, float(k)) * cells[(i / 37 >> k) * across + (i % 37 >> k)];
  }
  constexpr uint32_t k_seeds = 400;
  std::vector<std::vector<uint32_t>> count(levels, std::vector<uint32_t>(37 * 23, 0));
  for (uint32_t seed = 0; seed < k_seeds; ++seed) {
    const std::vector<uint32_t> taken = bench.dither(Of::geometry, o, seed * 2654435761u + 17);
    for (uint32_t i = 0; i < taken.size(); ++i)
      if (taken[i] < levels) ++count[taken[i]][i];
  }
  // Seeds are independent: each point and level is binomial. With about 3,000 of them 5.5 standard deviations
  // occur once in 10^4 such tests.
  double squares = 0, n = 0;
  for (uint32_t k = 0; k < levels; ++k)
    for (uint32_t i = 0; i < 37 * 23; ++i) {
      const double p = double(probability[k][i]), variance = k_seeds * p * (1 - p);
      if (p == 0) CHECK(count[k][i] == 0);
      if (variance < 4) continue;  // far from normal
      const double z = (count[k][i] - k_seeds * p) / std::sqrt(variance);
      INFO("level " << k << " point " << i << ": " << count[k][i] << " of " << k_seeds << " at " << p);
      CHECK(std::abs(z) < 5.5);
      squares += z * z, n += 1;
    }
  INFO(n << " points and levels, mean of z^2 " << squares / n);
  REQUIRE(n > 800);
  CHECK(squares / n == Approx(1).margin(0.15));
}

TEST_CASE("thresholds are distributed over blocks, follow the seed, and skip pixels with records") {
  Bench bench;
  // Maximum detail everywhere: no two neighbours have the same orientation.
  View v(64, 64);
  v.each([&](uint32_t x, uint32_t y) {
    v.plane(x, y, (x + y) % 2 ? vec3(0, 0, 1) : normalize(vec3(1, 0, 1)), -3);
  });
  const DiscontinuityOptions o{.density = 0.5f};
  bench.measure(v, Of::geometry, o);
  for (const float d : bench.screen.level(0)) REQUIRE(d == 1);
  const std::vector<uint32_t> taken = bench.dither(Of::geometry, o, 3);
  // Level 0 has the lower half of the thresholds, level 1 the eighth above: two of four, two of sixteen.
  for (const auto& [side, level] : {std::pair{2u, 0u}, {4u, 1u}})
    for (uint32_t y = 0; y < 64; y += side)
      for (uint32_t x = 0; x < 64; x += side) {
        uint32_t n = 0;
        for (uint32_t i = 0; i < side * side; ++i) n += taken[(y + i / side) * 64 + x + i % side] == level;
        REQUIRE(n == 2);
      }
  // Not everywhere in the same corner of its block.
  uint32_t corners[4] = {};
  for (uint32_t i = 0; i < 64 * 64; ++i) corners[2 * (i / 64 % 2) + i % 2] += taken[i] == 0;
  for (const uint32_t n : corners) CHECK(std::abs(int(n) - 512) < 5 * 16);
  CHECK(bench.dither(Of::geometry, o, 3) == taken);
  CHECK(bench.dither(Of::geometry, o, 4) != taken);
  // Levels finer than the minimum radius of a record draw no points,
  for (const uint32_t level : bench.dither(Of::geometry, o, 3, {.least_width = 3})) REQUIRE(level >= 2);
  // nor, here, levels with cells narrower than a metre: level 4 is 0.75 m wide where the wall is 3 m away.
  const std::vector<uint32_t> wide =
      bench.dither(Of::geometry, {.density = 0.5f, .falloff = 1}, 3, {.finest = 1});
  for (uint32_t i = 0; i < wide.size(); ++i)
    if (wide[i] < bench.screen.levels())
      REQUIRE(v.pixel() * v.surfaces[2 * i].w * float(1u << wide[i]) >= 0.999f);
  CHECK(std::count(wide.begin(), wide.end(), bench.screen.levels()) == 0);

  // With records geometry draws no points; irradiance does where the nearest record is farther than half a
  // cell.
  for (uint32_t i = 0; i < 64 * 64; ++i) v.lit[i] = vec3(i % 3 ? 1 : -1, i % 2 ? 1e-6f : 1e6f, 0);
  bench.measure(v, Of::geometry, o);
  const std::vector<uint32_t> geometry = bench.dither(Of::geometry, o, 3),
                              irradiance = bench.dither(Of::irradiance, o, 3);
  uint32_t asking = 0;
  for (uint32_t i = 0; i < 64 * 64; ++i) {
    REQUIRE(geometry[i] == (i % 3 ? bench.screen.levels() : taken[i]));
    REQUIRE(irradiance[i] == (i % 3 && i % 2 == 0 ? taken[i] : bench.screen.levels()));
    asking += irradiance[i] < bench.screen.levels();
  }
  CHECK(asking > 500);
}

}  // namespace cache_discontinuity_tests
