// links: irradiance_cache
// Smoothing of records over their neighbours: noise falls, the mean and slopes stay, and nothing is mixed
// that the records' errors do not excuse. Seeds are fixed; bounds of statistical checks state their
// significance.
#include "solvers/irradiance_cache/smoothing.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

namespace cache_smoothing_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;
using namespace lucerna::shared;

namespace {

constexpr size_t k_light_texels = size_t{k_part_count} * k_part_texels;
constexpr uint32_t k_side = 24;  ///< records along a side

struct Made {
  float light = 1;  ///< of each channel of the secondary part; the tertiary part has half of it in addition
  float error = 0;  ///< standard error of the luminance of both
};

/// Adds a record of radius 1, facing up.
void add(RawRecords& raw, const vec3& position, const Made& made, const vec3& normal = vec3(0, 1, 0)) {
  const float flags = std::bit_cast<float>(0u);
  raw.places.insert(raw.places.end(), {vec4(position, 1), vec4(normal, 1),
                                       vec4(std::bit_cast<float>(256u), 1, made.error, flags),
                                       vec4(0, 0, 0, 1), vec4(0), vec4(0)});
  raw.lights.resize(raw.lights.size() + k_light_texels, vec4(0));
  vec4* const light = &raw.lights[raw.lights.size() - k_light_texels];
  light[k_part_secondary * k_part_texels] = vec4(vec3(made.light), 0);
  light[k_part_tertiary * k_part_texels] = vec4(vec3(made.light / 2), 0);
  raw.spheres.emplace_back(position, 1);
}

vec3 place(uint32_t i) { return {float(i % k_side), 0, float(i / k_side)}; }

/// A floor of k_side x k_side records, one metre apart.
RawRecords floor_of(const std::function<Made(const vec3&)>& make) {
  RawRecords raw;
  for (uint32_t i = 0; i < k_side * k_side; ++i) add(raw, place(i), make(place(i)));
  return raw;
}

float light(const std::vector<vec4>& lights, uint32_t record, uint32_t part = k_part_secondary) {
  return lights[record * k_light_texels + part * k_part_texels].x;
}

bool identical(const vec4& a, const vec4& b) { return std::bit_cast<uvec4>(a) == std::bit_cast<uvec4>(b); }

/// True if the record's light is bit by bit as it was.
bool kept(const RawRecords& raw, const PublishedLight& now, uint32_t record) {
  for (size_t t = record * k_light_texels; t < (record + 1) * k_light_texels; ++t)
    if (!identical(raw.lights[t], now.lights[t])) return false;
  return true;
}

/// Away from the floor's border by more than the reach.
bool inside(const vec3& p) {
  return p.x >= 3 && p.z >= 3 && p.x <= float(k_side) - 4 && p.z <= float(k_side) - 4;
}

}  // namespace

TEST_CASE("smoothing keeps the mean of light that few records have found") {
  // A record's rays meet a small source a Poisson distributed number of times, half a time on average; so its
  // light and its error have a long tail, and most records have neither. All have the same area.
  for (uint32_t seed = 0; seed < 4; ++seed) {
    INFO("seed " << seed);
    std::mt19937 random(seed);
    std::poisson_distribution<int> hits(0.5);
    const RawRecords raw = floor_of([&](const vec3&) {
      const auto found = float(hits(random));
      return Made{found, 1.5f * std::sqrt(found)};
    });
    const PublishedLight now = smooth(raw, {});
    double before = 0, after = 0;
    for (uint32_t r = 0; r < k_side * k_side; ++r)
      before += double(light(raw.lights, r)), after += double(light(now.lights, r));
    // No statistics: both are of the same records.
    CHECK(after / before == Approx(1).margin(0.005));
  }
}

TEST_CASE("smoothing lowers the noise of a sloped light, and keeps its mean and slope") {
  const auto truth = [](const vec3& p) { return 1 + 0.02f * p.x + 0.01f * p.z; };
  double before = 0, after = 0, mean = 0, slope = 0, spread = 0, variance = 0;
  uint32_t counted = 0;
  constexpr float k_error = 0.2f;
  for (uint32_t seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    const RawRecords raw = floor_of([&](const vec3& p) {
      return Made{truth(p) + k_error / 1.5f * normal(random), k_error};
    });
    const PublishedLight now = smooth(raw, {});
    for (uint32_t i = 0; i < raw.size(); ++i) {
      // Parts have the same weights, so they keep their ratio.
      CHECK(light(now.lights, i, k_part_tertiary) == Approx(light(now.lights, i) / 2).epsilon(1e-5));
      if (!inside(place(i))) continue;
      const double left = light(now.lights, i) - truth(place(i)), x = place(i).x - 0.5 * (k_side - 1);
      before += std::pow(light(raw.lights, i) - truth(place(i)), 2), after += left * left;
      mean += left, slope += left * x, spread += x * x;
      for (uint32_t k = 0; k < k_lookup_lanes; ++k)
        variance += std::pow(now.errors[size_t{i} * k_lookup_lanes + k] / 1.5, 2) / k_lookup_lanes;
      ++counted;
    }
  }
  INFO("records " << counted << ", square before " << before << ", after " << after);
  // 29 neighbours within the reach, falling linearly: the variance falls to a twelfth.
  CHECK(after < before / 8);
  // Means of 2592 values whose errors extend over about 16 records each; four standard errors.
  const double each = k_error / 1.5 / std::sqrt(double(counted));
  CHECK(std::abs(mean / counted) < 4 * each);
  CHECK(std::abs(slope / spread) < 4 * each / std::sqrt(spread / counted));
  // The lanes' errors are those of the smoothed light, but for the likeness, which depends on it.
  CHECK(variance > 0.75 * after);
  CHECK(variance < 1.05 * after);
}

TEST_CASE("differences beyond the records' errors are not smoothed") {
  SECTION("a bend") {
    const RawRecords raw = floor_of([](const vec3& p) {
      return Made{1 + 0.02f * (p.x - 10) * (p.x - 10), 0.001f};
    });
    const PublishedLight now = smooth(raw, {});
    for (uint32_t i = 0; i < raw.size(); ++i)
      CHECK(light(now.lights, i) == Approx(light(raw.lights, i)).epsilon(0.002));
  }
  SECTION("the border of a shadow") {
    const RawRecords raw = floor_of([](const vec3& p) { return Made{p.x < 12 ? 1.0f : 3.0f, 0.05f}; });
    const PublishedLight now = smooth(raw, {});
    for (uint32_t i = 0; i < raw.size(); ++i)
      CHECK(light(now.lights, i) == Approx(light(raw.lights, i)).epsilon(0.01));
  }
  SECTION("no reach") {
    const RawRecords raw = floor_of([](const vec3& p) { return Made{p.x < 12 ? 1.0f : 3.0f, 5.0f}; });
    const PublishedLight now = smooth(raw, {.reach = 0});
    for (uint32_t i = 0; i < raw.size(); ++i) {
      CHECK(kept(raw, now, i));
      for (uint32_t k = 0; k < k_lookup_lanes; ++k)
        CHECK(std::abs(now.errors[size_t{i} * k_lookup_lanes + k]) == 5.0f);
    }
  }
}

TEST_CASE("only records of the same side, plane and medium are smoothed together") {
  const Made lit{2, 1}, dark{0.5f, 1};
  // The error would excuse mixing.
  RawRecords raw = floor_of([&](const vec3&) { return lit; });
  const uint32_t floor = raw.size();
  for (uint32_t i = 0; i < floor; ++i) add(raw, place(i) - vec3(0, 0.001f, 0), dark, vec3(0, -1, 0));
  for (uint32_t i = 0; i < floor; ++i) add(raw, place(i) + vec3(0, 0.3f, 0), dark);
  for (uint32_t i = 0; i < floor; ++i) {
    add(raw, place(i), dark);
    raw.places[size_t{raw.size() - 1} * k_record_texels + 5].x = std::bit_cast<float>(7u);
  }
  const PublishedLight now = smooth(raw, {});
  for (uint32_t i = 0; i < raw.size(); ++i)
    CHECK(light(now.lights, i) == Approx(i < floor ? lit.light : dark.light).epsilon(1e-5));
}

TEST_CASE("a record in a crease counts by the share of its disc that it represents") {
  // Every fifth record sees a surface at a hundredth of its radius, and is dark.
  RawRecords raw = floor_of([](const vec3& p) { return Made{int(p.x) % 5 == 0 ? 0.5f : 1.0f, 0.5f}; });
  const auto mean_along = [](const PublishedLight& now) {
    double sum = 0;
    for (uint32_t z = 4; z < k_side - 4; ++z) sum += light(now.lights, z * k_side + 10);
    return sum / (k_side - 8);
  };
  const double equal = mean_along(smooth(raw, {}));
  for (uint32_t i = 0; i < raw.size(); ++i)
    if (int(place(i).x) % 5 == 0) raw.places[size_t{i} * k_record_texels + 2].y = 0.01f;
  const double narrow = mean_along(smooth(raw, {}));
  CHECK(equal < 0.85);
  CHECK(narrow > 0.97);
}

TEST_CASE("the brightest light is smoothed without overflow") {
  const RawRecords raw = floor_of([](const vec3& p) { return Made{p.x < 12 ? 1e25f : 3e25f, 2e25f}; });
  const PublishedLight now = smooth(raw, {});
  for (uint32_t i = 0; i < raw.size(); ++i) {
    CHECK(light(now.lights, i) >= 0.99e25f);
    CHECK(light(now.lights, i) <= 3.01e25f);
  }
}

TEST_CASE("crowded records and records without a radius keep their texels, and serve no neighbour") {
  RawRecords raw = floor_of([](const vec3& p) { return Made{1 + 0.1f * std::sin(p.x), 1}; });
  const uint32_t crowded = 5 * k_side + 5, unplaced = 15 * k_side + 15;
  raw.places[size_t{crowded} * k_record_texels + 2].w = std::bit_cast<float>(k_record_crowded);
  raw.places[size_t{unplaced} * k_record_texels].w = 0;
  for (const uint32_t r : {crowded, unplaced})
    std::fill_n(&raw.lights[r * k_light_texels], k_light_texels, vec4(std::numeric_limits<float>::max()));
  const PublishedLight now = smooth(raw, {});
  for (uint32_t i = 0; i < raw.size(); ++i) {
    const bool apart = i == crowded || i == unplaced;
    CHECK(kept(raw, now, i) == apart);
    if (!apart) CHECK(light(now.lights, i) < 1.2f);
  }
}

TEST_CASE("the shares of light groups are smoothed as their light is") {
  // Errors so large that light does not influence the weights. Two groups; the record's number determines the
  // first one's share.
  const auto share_of = [](uint32_t i) { return float(i % 5) / 8; };
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  RawRecords raw = floor_of([&](const vec3&) { return Made{2 + 0.2f * normal(random), 30}; });
  for (uint32_t i = 0; i < raw.size(); ++i)
    raw.groups.emplace_back(share_pack(vec3(share_of(i))), share_pack(vec3(1 - share_of(i))), 0, 0);
  RawRecords first = raw;
  for (uint32_t i = 0; i < raw.size(); ++i)
    for (uint32_t p = 0; p < k_part_count; ++p)
      first.lights[i * k_light_texels + p * k_part_texels] *= share_of(i);
  const PublishedLight now = smooth(raw, {}), alone = smooth(first, {});
  for (uint32_t i = 0; i < raw.size(); ++i) {
    const vec3 a = share_unpack(now.groups[i].x), b = share_unpack(now.groups[i].y);
    CHECK(a.x * light(now.lights, i) == Approx(light(alone.lights, i)).epsilon(0.01).margin(0.005));
    CHECK(a.x + b.x == Approx(1).epsilon(0.005));
  }
}

}  // namespace cache_smoothing_tests
