#include "solvers/irradiance_cache/placement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <unordered_map>

namespace lucerna::irradiance_cache {
namespace {

constexpr uint32_t k_morton_bits = 21;
constexpr float k_cluster_width = 4;  // in spacings

uint64_t spread(uint64_t x) {  // two zero bits after each
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  x = (x | x << 2) & 0x1249249249249249ull;
  return x;
}

uint64_t mix(uint64_t x) {  // splitmix64's finalizer
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27, x *= 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

}  // namespace

std::vector<Place> choose_places(std::span<const Place> candidates, const PlacementOptions& o,
                                 std::vector<uint32_t>* cluster) {
  if (cluster) cluster->assign(candidates.size(), 0);
  if (candidates.empty() || o.most == 0) return {};
  vec3 lo = candidates[0].position, hi = lo;
  for (const Place& c : candidates) lo = glm::min(lo, c.position), hi = glm::max(hi, c.position);
  const vec3 extent = hi - lo;
  const float side = std::max({extent.x, extent.y, extent.z, 1e-20f});
  std::vector<std::pair<uint64_t, uint32_t>> order;
  order.reserve(candidates.size());
  const double cells = double((1u << k_morton_bits) - 1);
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    const vec3 p = candidates[i].position - lo;
    const auto cell = [&](float x) { return static_cast<uint64_t>(double(x) / side * cells); };
    order.emplace_back(spread(cell(p.x)) | spread(cell(p.y)) << 1 | spread(cell(p.z)) << 2, i);
  }
  std::sort(order.begin(), order.end());

  std::vector<std::vector<Place>> clusters;
  const auto reach = [&](const Place& p) {
    const float seen = o.spacing_of_distance * (o.parallel ? 1 : distance(p.position, o.eye));
    return std::max({o.spacing, seen, p.origin == shared::k_origin_recursive ? o.spacing_beyond : 0});
  };
  for (size_t first = 0; first < order.size();) {
    vec3 box_lo = candidates[order[first].second].position, box_hi = box_lo;
    const float widest = k_cluster_width * reach(candidates[order[first].second]);
    size_t last = first + 1;
    for (; last < order.size(); ++last) {
      const vec3& p = candidates[order[last].second].position;
      const vec3 l = glm::min(box_lo, p), h = glm::max(box_hi, p);
      if (std::max({h.x - l.x, h.y - l.y, h.z - l.z}) > widest) break;
      box_lo = l, box_hi = h;
    }
    std::vector<Place> left, chosen;
    for (size_t i = first; cluster && i < last; ++i)
      (*cluster)[order[i].second] = static_cast<uint32_t>(clusters.size());
    for (size_t i = first; i < last; ++i) left.push_back(candidates[order[i].second]);
    uint64_t random = mix(order[first].first * 0x9e3779b97f4a7c15ull + o.seed);
    while (!left.empty()) {
      random = mix(random + 0x9e3779b97f4a7c15ull);
      const Place pick = left[random % left.size()];
      chosen.push_back(pick);
      const float near2 = reach(pick) * reach(pick);
      std::erase_if(left, [&](const Place& c) {
        const vec3 d = c.position - pick.position;
        return dot(d, d) <= near2 && 1 - dot(c.normal, pick.normal) <= o.normal_tolerance;
      });
    }
    clusters.push_back(std::move(chosen));
    first = last;
  }
  // When there are too many: whole ranks (the first of every cluster, the second, ...) while they fit, and of
  // the next one evenly over the clusters.
  std::vector<size_t> quota(clusters.size(), 0);
  for (size_t left = o.most, rank = 0; left > 0; ++rank) {
    std::vector<size_t> having;
    for (size_t c = 0; c < clusters.size(); ++c)
      if (clusters[c].size() > rank) having.push_back(c);
    if (having.empty()) break;
    const size_t fitting = std::min(left, having.size());
    for (size_t k = 0; k < fitting; ++k) ++quota[having[k * having.size() / fitting]];
    left -= fitting;
    if (fitting < having.size()) break;
  }
  std::vector<Place> all;
  for (size_t c = 0; c < clusters.size(); ++c)
    all.insert(all.end(), clusters[c].begin(), clusters[c].begin() + std::ptrdiff_t(quota[c]));
  return all;
}

std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               const ThinningOptions& o) {
  std::vector<uint32_t> order(places.size()), kept;
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return radii[a] > radii[b]; });
  // Grids of those kept, one for each power of two of what they cover: cells are as wide as that at most, so
  // that whatever covers a point is centred in its cell or one of the 26 around it.
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
    return dot(away, away) <= covered * covered && turned <= o.share * o.share * o.normal_tolerance &&
           dot(away, p.normal + places[k].normal) >= -2 * o.behind * radii[k];
  };
  for (const uint32_t i : order) {
    const Place& p = places[i];
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
