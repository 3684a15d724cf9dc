// links: upload
// Alias tables: their stated probabilities are those with which the device chooses, for any weights. Tables
// of measured distributions are made once.
#include "base/alias_table.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "scene/lamp.h"
#include "upload/flatten.h"

namespace alias_table_tests {

using namespace lucerna;

namespace {

/// The probability of coin_below() in shaders/lib/sampler.glsl: the share of all 32-bit values below p.
double coin(float p) {
  return p < 0.5f ? std::ceil(double(p) * 0x1p32) / 0x1p32 : std::ceil(double(p) * 0x1p24) / 0x1p24;
}

}  // namespace

TEST_CASE("a table's probabilities equal those of its coins, for weights of any ratio") {
  std::mt19937 random(2);
  std::vector<std::vector<double>> lists{
      {1e-16, 1}, {1e-8, 1e8, 1, 1e-30}, {1e-300, 1e300}, {0, 1e-12, 0, 1}, {3e7, 1, 2, 1e-9, 0.5}};
  lists.emplace_back();
  for (int i = 0; i < 5000; ++i) lists.back().push_back(std::exp2(double(random() % 120) - 60));
  for (const std::vector<double>& weights : lists) {
    const std::vector<vec4> table = build_alias_table(weights);
    REQUIRE(table.size() == weights.size());
    const double n = double(weights.size());
    std::vector<double> chosen(weights.size(), 0.0);
    double total = 0, sum = 0;
    for (const double w : weights) total += w;
    for (size_t i = 0; i < table.size(); ++i) {
      chosen[i] += coin(table[i].x) / n;
      chosen[std::bit_cast<uint32_t>(table[i].y)] += (1 - coin(table[i].x)) / n;
    }
    size_t wrong = 0, far = 0, impossible = 0;
    for (size_t i = 0; i < table.size(); ++i) {
      const double p = table[i].z;
      sum += p;
      wrong += std::abs(chosen[i] - p) > 1e-6 * p;
      wrong += table[i].w != table[std::bit_cast<uint32_t>(table[i].y)].z;
      far += std::abs(p - weights[i] / total) > 0x1p-24 * std::max(weights[i] / total, 1 / n);
      impossible += (weights[i] > 0) != (p > 0);
    }
    INFO("of " << weights.size());
    CHECK(wrong == 0);
    CHECK(far == 0);
    CHECK(impossible == 0);
    CHECK(sum == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("the table of a measured distribution is made with it, and laid out again for other ones only") {
  const auto profile = [](double power) {
    return std::make_shared<const scene::LightProfile>(scene::sampled_profile(
        [=](double polar, double around) {
          return std::pow(std::abs(std::cos(polar * 0.0174533)), power) * (2 + std::sin(around * 0.0174533));
        },
        false));
  };
  scene::Scene s;
  scene::Primitive floor;
  floor.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, floor.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  floor.triangles = {{0, 1, 2}};
  s.meshes.push_back({"floor", {floor}});
  s.materials.resize(1);
  s.instances.push_back({.name = "floor", .mesh = 0});
  const auto first = profile(1), second = profile(4);
  CHECK(first->alias == build_alias_table(first->cells()));
  s.lights.resize(2);
  for (scene::Light& l : s.lights) l.position = {0, 2, 0};
  set_profile(s.lights[0], first);
  upload::FlatScene flat = upload::flatten(s);
  const SharedVector<vec4> before = flat.profiles;
  CHECK(before.size() == 1 + first->intensity.size());
  s.lights[0].intensity *= 3, s.lights[0].position.x = 1, s.lights[1].intensity = vec3(7);
  upload::flatten_lights(s, flat);
  CHECK(flat.profiles.shares_with(before));
  const auto as_rebuilt = [&] {
    const upload::FlatScene rebuilt = upload::flatten(s);
    // The bits of numbers are texels too: no comparison of floats.
    return rebuilt.profiles.size() == flat.profiles.size() &&
           std::memcmp(&rebuilt.profiles[0], &flat.profiles[0], 16 * flat.profiles.size()) == 0 &&
           rebuilt.lights.size() == flat.lights.size();
  };
  CHECK(as_rebuilt());
  set_profile(s.lights[1], second);
  upload::flatten_lights(s, flat);
  CHECK_FALSE(flat.profiles.shares_with(before));
  CHECK(flat.profiles.size() == 2 + first->intensity.size() + second->intensity.size());
  CHECK(as_rebuilt());
  set_profile(s.lights[0], second);
  upload::flatten_lights(s, flat);
  CHECK(flat.profiles.size() == 1 + second->intensity.size());
  CHECK(as_rebuilt());
}

}  // namespace alias_table_tests
