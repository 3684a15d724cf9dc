// links: transport
// Learning from light samples how to choose lights: rows are probabilities for any records, and depend on
// nothing but the records.
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <numeric>
#include <random>

#include "transport/learned_lights.h"

namespace learned_lights_tests {

using namespace lucerna;
using shared::LightRecord;

namespace {

scene::Scene lights() {
  scene::Scene s;
  scene::Material m;
  m.emission = vec3(4);
  s.materials.push_back(m);
  const auto add = [&](vec3 at, float size) {
    scene::Primitive p;
    p.positions = {at, at + vec3(size, 0, 0), at + vec3(0, 0, size)};
    p.normals.assign(3, vec3(0, -1, 0));
    p.tangents.assign(3, vec4(1, 0, 0, 1));
    p.uv0.assign(3, vec2(0));
    p.triangles = {{0, 1, 2}};
    s.meshes.push_back({"t", {p}});
    s.instances.push_back({"t", scene::Id(s.meshes.size() - 1), mat4(1), false});
  };
  add({0, 3, 0}, 2);
  for (int i = 0; i < 300; ++i) add({float(i % 20), 4, float(i / 20)}, 0.02f + 0.001f * float(i % 7));
  for (int i = 0; i < 90; ++i) {
    scene::Light lamp;
    lamp.kind = i % 30 == 0 ? scene::LightKind::directional : scene::LightKind::point;
    lamp.position = vec3(float(i), 2, float(i % 9));
    lamp.direction = vec3(0, -1, 0);
    lamp.intensity = vec3(i == 7 ? 1e8f : i == 8 ? 1e-8f : 1.f);
    s.lights.push_back(lamp);
  }
  scene::Image sky;
  sky.width = 64, sky.height = 32;
  for (uint32_t i = 0; i < 64 * 32; ++i)
    for (const float c : {0.5f + float(i % 5), 1.f, i == 777 ? 1e7f : 2.f, 1.f})
      sky.floats.push_back(i / 64 > 28 ? 0.f : c);
  s.images.push_back(sky);
  s.environment.image = 0;
  s.environment.given = true;
  return s;
}

/// Random vertices that some lights reach.
std::vector<LightRecord> records(const upload::LightClusters& clusters, uint32_t count) {
  std::mt19937 random(3);
  const auto unit = [&] { return float(random() >> 8) / 16777216.f; };
  std::vector<LightRecord> list;
  for (uint32_t i = 0; i < count; ++i) {
    LightRecord r{};
    r.position = vec3(10 * unit(), 3 * unit(), 8 * unit());
    r.cell = (random() % 6) << 16 | random() % clusters.count();
    r.value = 5 * unit() * unit();
    r.rate = unit();
    r.full = random() % 3 == 0 ? -1.f : 1 + unit();
    r.arrived = r.full > 0 && random() % 4 == 0 ? r.full : 0;
    r.before = 0.5f;
    r.met = random() % 5 == 0 ? random() % clusters.count() + 1 : 0;
    r.met_value = unit(), r.met_rate = unit();
    list.push_back(r);
  }
  return list;
}

/// Checks the largest relative difference between the probabilities of the tables and the stated ones; and
/// that rows sum to 1.
void check_rows(const upload::LightClusters& clusters, const transport::LearnedLights& lights) {
  const uint32_t n = clusters.count();
  REQUIRE(lights.rows.size() == size_t(lights.row_count) * n);
  size_t wrong_ratio = 0, too_small = 0, wrong_alias = 0, wrong_sum = 0, impossible = 0;
  for (uint32_t row = 0; row < lights.row_count; ++row) {
    std::vector<double> chosen(n, 0.0);
    double sum = 0;
    const vec4* table = &lights.rows[size_t(row) * n];
    for (uint32_t c = 0; c < n; ++c) {
      const auto alias = std::bit_cast<uint32_t>(table[c].y);
      chosen[c] += double(table[c].x) / n, chosen[alias] += (1 - double(table[c].x)) / n;
      wrong_alias += table[c].x < 1 && table[c].w != table[alias].z;
    }
    for (uint32_t c = 0; c < n; ++c) {
      const double p = double(table[c].z) * clusters.plain[c];
      sum += p;
      wrong_ratio += std::abs(chosen[c] - p) > 1e-5 * p + 1e-7;
      too_small += p < 0.1 * clusters.plain[c];
      impossible += (clusters.plain[c] > 0) != (chosen[c] > 0);
    }
    wrong_sum += std::abs(sum - 1) > 1e-5;
  }
  CHECK(wrong_ratio == 0);
  CHECK(wrong_alias == 0);
  CHECK(too_small == 0);
  CHECK(wrong_sum == 0);
  CHECK(impossible == 0);
  size_t no_row = 0;
  constexpr uint32_t k_bricks = 6 * 16 * 16 * 16;
  for (size_t i = 0; i < lights.grid.size(); ++i) {
    const uint32_t word = lights.grid[i];
    no_row += word & 1u ? i >= k_bricks || k_bricks + (size_t(word >> 1) + 1) * 512 > lights.grid.size()
                        : word >> 1 >= lights.row_count;
  }
  CHECK(no_row == 0);
}

}  // namespace

TEST_CASE("clusters contain every light once, with its probability without learning") {
  const upload::FlatScene flat = upload::flatten(lights());
  const upload::LightClusters clusters = upload::make_light_clusters(flat);
  REQUIRE(upload::has_light_clusters(flat));
  CHECK(clusters.sky == 256);
  CHECK(clusters.count() > 300);
  CHECK(std::accumulate(clusters.plain.begin(), clusters.plain.end(), 0.0) == Approx(1).epsilon(1e-5));
  std::vector<double> entries(flat.entries.size(), 0.0), texels(64 * 32, 0.0);
  for (uint32_t c = 0; c < clusters.count(); ++c) {
    const auto first = std::bit_cast<uint32_t>(clusters.clusters[c].x),
               count = std::bit_cast<uint32_t>(clusters.clusters[c].y);
    for (uint32_t i = first; i < first + count; ++i) {
      const vec4& m = clusters.members[i];
      const auto put = [&](float member, double share) {
        (c < clusters.sky ? texels : entries)[std::bit_cast<uint32_t>(member)] +=
            share / count * clusters.plain[c];
        if (c < clusters.sky && clusters.plain[c] > 0)
          CHECK(clusters.tiles[std::bit_cast<uint32_t>(member)] == c);
      };
      put(m.z, m.x);
      if (m.x < 1) put(m.w, 1 - m.x);
    }
  }
  size_t wrong = 0;
  for (size_t i = 0; i + 1 < entries.size(); ++i) {
    const double p = flat.light_alias[i].z;
    wrong += std::abs(entries[i] - p) > 1e-4 * p + 1e-9;
  }
  for (size_t i = 0; i < texels.size(); ++i) {
    const double p = double(flat.environment.alias[i].z) * flat.environment_light_pmf;
    wrong += std::abs(texels[i] - p) > 1e-4 * p + 1e-9;
  }
  CHECK(wrong == 0);
}

TEST_CASE("rows are probabilities, at least a tenth of those without learning, for any records") {
  const upload::LightClusters clusters = upload::make_light_clusters(upload::flatten(lights()));
  check_rows(clusters, transport::plain_lights(clusters));
  check_rows(clusters, transport::learn_lights(clusters, {}, {}));
  std::vector<LightRecord> list = records(clusters, 20000);
  const transport::LearnedCells cells = transport::learned_cells(list);
  CHECK(cells.scale == Approx(128 / 10.5).epsilon(0.05));
  const transport::LearnedLights learned = transport::learn_lights(clusters, cells, list);
  CHECK(learned.row_count > 100);
  check_rows(clusters, learned);
  for (LightRecord& r : list) r.full = -1, r.met = 0;  // no light has arrived anywhere
  check_rows(clusters, transport::learn_lights(clusters, cells, list));
  for (LightRecord& r : list)
    r.full = r.arrived = r.value = 1e30f, r.rate = 1e30f, r.position = vec3(2);  // all in one place
  check_rows(clusters, transport::learn_lights(clusters, transport::learned_cells(list), list));
}

TEST_CASE("the result does not depend on the order of records") {
  const upload::LightClusters clusters = upload::make_light_clusters(upload::flatten(lights()));
  std::vector<LightRecord> list = records(clusters, 20000);
  const auto learn = [&] { return transport::learn_lights(clusters, transport::learned_cells(list), list); };
  const transport::LearnedLights a = learn();
  std::shuffle(list.begin(), list.end(), std::mt19937(8));
  const transport::LearnedLights b = learn();
  CHECK(a.grid == b.grid);
  REQUIRE(a.rows.size() == b.rows.size());
  CHECK(std::memcmp(a.rows.data(), b.rows.data(), a.rows.size() * sizeof(vec4)) == 0);
}

TEST_CASE("a cluster that reaches one corner is chosen there") {
  const upload::LightClusters clusters = upload::make_light_clusters(upload::flatten(lights()));
  const uint32_t seen = clusters.count() - 1;  // a faint lamp
  std::vector<LightRecord> list = records(clusters, 40000);
  for (LightRecord& r : list) {
    r.met = 0, r.value = r.full = 1, r.rate = 0;
    r.cell = 2u << 16 | (r.cell & 0xffffu);
    const bool corner = r.position.x < 2 && r.position.z < 2;
    r.arrived = corner && (r.cell & 0xffffu) == seen ? 1.f : 0.f;
  }
  const transport::LearnedCells cells = transport::learned_cells(list);
  const transport::LearnedLights learned = transport::learn_lights(clusters, cells, list);
  const auto chosen_at = [&](vec3 p) {
    return learned.rows[size_t(learned.row_at(p, 2)) * clusters.count() + seen].z * clusters.plain[seen];
  };
  CHECK(chosen_at({1, 1.5f, 1}) > 0.8f);
  CHECK(clusters.plain[seen] < 0.01f);
}

TEST_CASE("the gain of learning is measured by samples that were not learned from") {
  const upload::LightClusters clusters = upload::make_light_clusters(upload::flatten(lights()));
  const uint32_t n = clusters.count();
  std::mt19937 random(11);
  const auto unit = [&] { return float(random() >> 8) / 16777216.f; };
  // Light samples of vertices, each chosen by the row there; `light`: of a cluster at a place.
  const auto sampled = [&](const transport::LearnedLights& by, const auto& light) {
    std::vector<LightRecord> list;
    for (uint32_t i = 0; i < 60000; ++i) {
      LightRecord r{};
      r.position = vec3(10 * unit(), 1.5f, 8 * unit());
      const vec4* row = &by.rows[size_t(by.row_at(r.position, 2)) * n];
      const uint32_t at = random() % n, c = unit() < row[at].x ? at : std::bit_cast<uint32_t>(row[at].y);
      r.cell = 2u << 16 | c;
      r.value = light(c, r.position), r.full = r.value > 0 ? 1.f : -1.f, r.arrived = 1;
      list.push_back(r);
    }
    return list;
  };
  const auto gain = [&](const auto& light) {
    const auto first = sampled(transport::exploring_lights(clusters), light);
    const auto learned = transport::learn_lights(clusters, transport::learned_cells(first), first);
    return transport::measured_gain(clusters, learned, sampled(learned, light));
  };
  // Of all lamps one faint one arrives, in half of the room another.
  const double high = gain([&](uint32_t c, vec3 p) { return c == n - (p.x < 5 ? 1 : 2) ? 1.f : 0.f; });
  // Everything arrives, as much as expected: nothing can be gained.
  const double none = gain([&](uint32_t c, vec3) { return clusters.plain[c]; });
  INFO(high << " and " << none);
  CHECK(high > 10);
  CHECK(none < 1.05);
  CHECK(transport::measured_gain(clusters, transport::plain_lights(clusters), {}) == 1);
}

}  // namespace learned_lights_tests
