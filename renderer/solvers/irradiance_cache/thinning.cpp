// Selects the tried places to keep: thin_out().
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <unordered_map>

#include "solvers/irradiance_cache/placement.h"

namespace lucerna::irradiance_cache {

namespace {

uint64_t mix(uint64_t x) {  // splitmix64's finalizer
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27, x *= 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

}  // namespace

std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               std::span<const float> off_planes, const ThinningOptions& o) {
  std::vector<uint32_t> order(places.size()), kept;
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return radii[a] > radii[b]; });
  // Grids of the kept places, one for each power of two of their radius. Cells are at least that wide, so a
  // place that covers a point is in the point's cell or one of the 26 around it.
  struct Cell {
    int level;
    int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    size_t operator()(const Cell& c) const {
      return mix(mix(mix(mix(uint64_t(c.level)) + uint64_t(c.x)) + uint64_t(c.y)) + uint64_t(c.z));
    }
  };
  std::unordered_map<Cell, std::vector<uint32_t>, Hash> grid;
  std::set<int> levels;
  const auto cell_at = [](const vec3& p, int level) {
    const auto along = [&](float x) {
      return static_cast<int64_t>(std::floor(std::ldexp(double(x), -level)));
    };
    return Cell{level, along(p.x), along(p.y), along(p.z)};
  };
  const auto covers = [&](uint32_t k, const Place& p) {
    const vec3 away = p.position - places[k].position;
    const float covered = o.share * radii[k];
    const float turned = std::max(0.0f, 1 - dot(p.normal, places[k].normal));
    return p.medium == places[k].medium && dot(away, away) <= covered * covered &&
           turned <= o.share * o.share * o.normal_tolerance &&
           std::abs(dot(away, p.normal + places[k].normal)) <= 2 * off_planes[k];
  };
  for (const uint32_t i : order) {
    const Place& p = places[i];
    if (p.origin == shared::k_origin_recursive && radii[i] < o.least_beyond) continue;
    bool covered = false;
    for (const int level : levels) {
      const Cell at = cell_at(p.position, level);
      for (int n = 0; n < 27 && !covered; ++n) {
        const auto found = grid.find({level, at.x + n % 3 - 1, at.y + n / 3 % 3 - 1, at.z + n / 9 - 1});
        covered = found != grid.end() && std::any_of(found->second.begin(), found->second.end(),
                                                     [&](uint32_t k) { return covers(k, p); });
      }
      if (covered) break;
    }
    if (covered) continue;
    kept.push_back(i);
    const float reach = o.share * radii[i];
    if (!(reach > 0) || !std::isfinite(reach)) continue;
    const int level = static_cast<int>(std::ceil(std::log2(reach)));
    levels.insert(level);
    grid[cell_at(p.position, level)].push_back(i);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace lucerna::irradiance_cache
