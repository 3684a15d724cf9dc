// links: photons
// Irradiance cells on surfaces: unbiased for any photons, as fine as the photons allow, separate for both
// sides, unknown where photons are too few.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "base/math.h"
#include "shaders/shared/photons/photons.h"
#include "solvers/photons/irradiance_cells.h"

namespace photons_irradiance_cells_tests {

using namespace lucerna;
using photons::IrradianceCells, photons::IrradianceCellsBuilder, photons::PhotonOnSide, photons::SideOrder;

namespace {

/// A rectangle from `corner` along u and v as across x down quads of two triangles each.
void add_grid(upload::FlatScene& flat, const vec3& corner, const vec3& u, const vec3& v, int across,
              int down) {
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      const vec3 a = u / float(across), b = v / float(down), p = corner + float(x) * a + float(y) * b;
      for (const auto& t : {std::array{p, p + a, p + a + b}, std::array{p, p + a + b, p + b}}) {
        flat.positions.insert(flat.positions.end(), t.begin(), t.end());
        flat.triangles.emplace_back(0, 0, 0, 0);
        flat.non_opaque.push_back(0);
      }
    }
  flat.scene_centre = vec3(0.5f), flat.scene_radius = 2;
}

/// `count` photons per square metre, evenly on the front sides of the triangles, with a flux that gives
/// `irradiance`, or 0 where not `lit`.
std::vector<PhotonOnSide> spread(const upload::FlatScene& flat, uint32_t count, float irradiance,
                                 const std::function<bool(vec3)>& lit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<PhotonOnSide> all;
  for (uint32_t t = 0; t < flat.triangles.size(); ++t) {
    const vec3* p = &flat.positions[3 * size_t{t}];
    const float area = 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    const auto n = uint32_t(std::poisson_distribution<int>(double(count) * double(area))(random));
    for (uint32_t i = 0; i < n; ++i) {
      float u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (!lit(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]))) continue;
      const auto number = uint32_t(all.size()) << shared::k_photon_id_events;
      const auto q = [](float x) { return uint32_t(x * 65535 + 0.5f); };
      all.push_back({.side = t << 1,
                     .barycentric = q(u) | q(v) << 16,
                     .number = number,
                     .group = uint32_t(all.size() % 3),
                     .flux = vec3(irradiance / float(count))});
    }
  }
  return all;
}

IrradianceCells make(const SideOrder& order, const std::vector<PhotonOnSide>& photons, uint32_t groups,
                     float widest) {
  IrradianceCellsBuilder builder(order, photons, groups, 8, widest);
  builder.add_map(0), builder.add_map(1);
  return builder.take();
}

/// As the shader reads it: the node, or nothing if unknown.
std::optional<uint32_t> find(const IrradianceCells& cells, uint32_t groups, uint32_t side, uint32_t map,
                             float u, float v) {
  uint32_t node = cells.roots[side >> 1][int(2 * map + (side & 1u))];
  uvec2 at(uint32_t(u * 65535 + 0.5f), uint32_t(v * 65535 + 0.5f));
  const auto link = [&] { return std::bit_cast<uint32_t>(cells.nodes[size_t{node} * (1 + groups)].w); };
  for (uint32_t depth = 0; depth < shared::k_irradiance_depth && link() >= shared::k_irradiance_first;
       ++depth) {
    const uvec3 q = shared::irradiance_quarter(at);
    at = uvec2(q), node = link() + q.z;
  }
  return link() == shared::k_irradiance_known ? std::optional(node) : std::nullopt;
}

struct Seen {
  double mean = 0, square = 0, known = 0;  ///< irradiance where known; share of known places
};
Seen look(const IrradianceCells& cells, uint32_t groups, const upload::FlatScene& flat, uint32_t map,
          const std::function<bool(vec3)>& where) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  Seen seen;
  double n = 0;
  for (uint32_t t = 0; t < flat.triangles.size(); ++t)
    for (uint32_t i = 0; i < std::max<uint32_t>(8, 8192 / uint32_t(flat.triangles.size())); ++i) {
      float u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const vec3* p = &flat.positions[3 * size_t{t}];
      if (!where(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]))) continue;
      ++n;
      const auto node = find(cells, groups, t << 1, map, u, v);
      if (!node) continue;
      const auto e = double(cells.nodes[size_t{*node} * (1 + groups)].x);
      ++seen.known, seen.mean += e, seen.square += e * e;
    }
  seen.mean /= seen.known, seen.square /= seen.known, seen.known /= n;
  return seen;
}

bool everywhere(vec3) { return true; }

}  // namespace

TEST_CASE("even light on large triangles is known everywhere, with the noise of its photons") {
  upload::FlatScene flat;
  add_grid(flat, vec3(0), {1, 0, 0}, {0, 0, -1}, 1, 1);
  const SideOrder order = photons::order_sides(flat, {true});
  const std::vector<PhotonOnSide> all = spread(flat, 20000, 3, everywhere);
  const IrradianceCells cells = make(order, all, 0, 0.1f);
  CHECK(cells.known > 2 * 20000 / 2 / 40);  // both maps; 8 to 32 photons of one half per cell
  for (const uint32_t map : {0u, 1u}) {
    const Seen seen = look(cells, 0, flat, map, everywhere);
    // Quarters without photons of the deciding half are unknown.
    CHECK(seen.known > 0.9);
    // 10000 photons of one half: 1 % of noise; 8 to 32 of them per cell.
    CHECK(seen.mean == Approx(3).epsilon(0.04));
    CHECK(seen.square / (seen.mean * seen.mean) - 1 < 1.0 / 8);
    CHECK(seen.square / (seen.mean * seen.mean) - 1 > 1.0 / 32);
  }
  // The back side has none.
  CHECK_FALSE(find(cells, 0, 1, 0, 0.3f, 0.3f));
}

TEST_CASE("light ends where its photons end, and unlit cells stay unknown") {
  upload::FlatScene flat;
  add_grid(flat, vec3(0), {1, 0, 0}, {0, 0, -1}, 1, 1);
  const auto lit = [](vec3 p) { return p.x < 0.4f; };
  const SideOrder order = photons::order_sides(flat, {true});
  const IrradianceCells cells = make(order, spread(flat, 40000, 3, lit), 0, 0.1f);
  const Seen within = look(cells, 0, flat, 0, [](vec3 p) { return p.x < 0.36f; });
  CHECK(within.known > 0.9);
  CHECK(within.mean == Approx(3).epsilon(0.04));
  CHECK(look(cells, 0, flat, 0, [](vec3 p) { return p.x > 0.55f; }).known == 0);
  // Hidden parts do not dilute visible ones: at the border a cell's photons are not spread over the dark
  // quarters beside it.
  const Seen border = look(cells, 0, flat, 0, [](vec3 p) { return p.x > 0.37f && p.x < 0.395f; });
  CHECK(border.mean > 0.75 * 3);
}

TEST_CASE("small triangles are merged with neighbours of similar orientation") {
  upload::FlatScene flat;
  add_grid(flat, vec3(0), {1, 0, 0}, {0, 0, -1}, 40, 40);  // the floor
  const auto floors = uint32_t(flat.triangles.size());
  add_grid(flat, vec3(0), {1, 0, 0}, {0, 1, 0}, 40, 40);  // a wall that shares an edge
  const SideOrder order = photons::order_sides(flat, {true});
  // 0.6 photons per triangle; the wall is dark.
  const auto lit = [](vec3 p) { return p.y <= 0; };
  const std::vector<PhotonOnSide> all = spread(flat, 2000, 3, lit);
  const IrradianceCells cells = make(order, all, 0, 0.3f);
  upload::FlatScene floor = flat;
  floor.triangles.resize(floors);
  const Seen seen = look(cells, 0, floor, 0, everywhere);
  CHECK(seen.known > 0.8);
  CHECK(seen.mean == Approx(3).epsilon(0.12));  // 1000 photons of one half: 3 % of noise
  // The wall has only the light of its lowest row, which shares cells with the floor.
  const Seen wall = look(cells, 0, flat, 0, [](vec3 p) { return p.y > 0.03f; });
  CHECK(!(wall.known > 0));
  // Without merging few triangles have eight photons of one half.
  CHECK(make(order, all, 0, 0.002f).known < 10);
}

TEST_CASE("a map does not depend on the order of its photons, and two maps use separate halves") {
  upload::FlatScene flat;
  add_grid(flat, vec3(0), {1, 0, 0}, {0, 0, -1}, 4, 4);
  const SideOrder order = photons::order_sides(flat, {true});
  std::vector<PhotonOnSide> all = spread(flat, 5000, 3, everywhere);
  const IrradianceCells cells = make(order, all, 3, 0.2f);
  std::shuffle(all.begin(), all.end(), std::mt19937(5));
  const IrradianceCells again = make(order, all, 3, 0.2f);
  REQUIRE(cells.nodes.size() == again.nodes.size());
  CHECK(std::memcmp(cells.nodes.data(), again.nodes.data(), cells.nodes.size() * sizeof(vec4)) == 0);
  CHECK(cells.roots == again.roots);
  // The noise of the two maps is independent. Groups sum to the whole.
  double covariance = 0, variance = 0, n = 0;
  for (uint32_t t = 0; t < flat.triangles.size(); ++t)
    for (float u = 0.05f; u < 0.9f; u += 0.1f) {
      const auto a = find(cells, 3, t << 1, 0, u, 0.07f), b = find(cells, 3, t << 1, 1, u, 0.07f);
      if (!a || !b) continue;
      const vec4* texels = &cells.nodes[4 * size_t{*a}];
      const double x = double(texels->x) / 3 - 1, y = double(cells.nodes[4 * size_t{*b}].x) / 3 - 1;
      covariance += x * y, variance += 0.5 * (x * x + y * y), ++n;
      CHECK(texels[1].x + texels[2].x + texels[3].x == Approx(texels->x).epsilon(1e-5));
    }
  CHECK(n > 200);
  // Places share cells, so far fewer than n count; 0.35 is beyond 3 sigma of 100 pairs.
  CHECK(std::abs(covariance) < 0.35 * variance);
}

TEST_CASE("without photons, or with triangles of zero area, no irradiance is known") {
  upload::FlatScene flat;
  CHECK(make(photons::order_sides(flat, {}), {}, 0, 1).known == 0);
  add_grid(flat, vec3(0), {1, 0, 0}, vec3(0), 1, 1);
  const SideOrder order = photons::order_sides(flat, {true});
  const std::vector<PhotonOnSide> lost(100, {.side = 0, .barycentric = 0, .number = 0, .flux = vec3(1)});
  CHECK(make(order, lost, 0, 1).known == 0);
  // Many photons in one point end at the maximum depth.
  upload::FlatScene one;
  add_grid(one, vec3(0), {1, 0, 0}, {0, 0, -1}, 1, 1);
  std::vector<PhotonOnSide> point(1000, {.side = 0, .barycentric = 1000, .flux = vec3(1)});
  for (uint32_t i = 0; i < point.size(); ++i) point[i].number = i << shared::k_photon_id_events;
  CHECK(make(photons::order_sides(one, {true}), point, 0, 1).known > 0);
}

}  // namespace photons_irradiance_cells_tests
