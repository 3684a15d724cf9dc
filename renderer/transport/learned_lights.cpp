#include "transport/learned_lights.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/alias_table.h"

namespace lucerna::transport {

using namespace shared;

namespace {

/// Probability of each cluster that remains unlearned, and that is uniform, so that clusters without success
/// so far are still found, even with little power.
constexpr double k_defensive = 0.11, k_even = 0.04;
/// Uniform part before learning: where a strong light is hidden, a weak one is chosen occasionally.
constexpr double k_even_at_first = 0.1;
/// Weight of the surrounding cells' moments, in samples, for each cluster.
constexpr double k_prior_samples = 6;
/// Minimum samples of a cell to split it; a fifth of that gives a cell its own row.
constexpr size_t k_cut = 256;
/// Minimum light samples for a known share of unblocked shadow rays.
constexpr size_t k_known_rays = 16;
/// Maximum number of rows, and of their texels.
constexpr uint32_t k_most_rows = 16384, k_most_row_texels = 1u << 22;
constexpr uint32_t k_levels = 7;  // levels of the octree of the cells
static_assert(1u << k_levels == k_learned_cells && k_learned_top * k_learned_brick == k_learned_cells);
constexpr uint32_t k_top_level = 4;
static_assert(1u << k_top_level == k_learned_top);
/// Cells of the coarse grid, for all facings.
constexpr uint32_t k_bricks = k_learned_facings * k_learned_top * k_learned_top * k_learned_top;

/// Facing, then the path through the octree, 3 bits a level.
uint32_t key_of(const LearnedCells& cells, const LightRecord& r) {
  const vec3 at =
      glm::clamp((r.position - cells.origin) * cells.scale, vec3(0), vec3(float(k_learned_cells) - 0.5f));
  const uvec3 cell(at);
  uint32_t key = r.cell >> 16;
  for (int level = int(k_levels) - 1; level >= 0; --level)
    key = key << 3 | (cell.z >> level & 1u) << 2 | (cell.y >> level & 1u) << 1 | (cell.x >> level & 1u);
  return key;
}

/// A light sample, or a scattered ray that hit light.
struct Sample {
  uint32_t key;
  bool scattered;
  bool last, arrived;  // belongs to the last generation; its shadow ray was unblocked
  uint32_t cluster;
  double value, rate;
};

/// Second moments of the contributions of a cell's clusters.
using Moments = std::vector<double>;

class Learner {
 public:
  Learner(const upload::LightClusters& clusters, const LearnedCells& cells,
          std::span<const LightRecord> records, LearnedLights& to, size_t last = 0)
      : clusters_(clusters), to_(to) {
    to_.cells = cells;
    samples_.reserve(records.size() + records.size() / 4);
    for (size_t i = 0; i < records.size(); ++i) {
      const LightRecord& r = records[i];
      if (r.full == 0) continue;
      const uint32_t key = key_of(cells, r);
      samples_.push_back({key, false, i + last >= records.size(), r.full > 0 && r.arrived > 0,
                          r.cell & 0xffffu, r.full > 0 ? double(r.value) * (r.arrived / r.full) : 0.0,
                          r.rate});
      if (r.met > 0 && r.before > 0)
        samples_.push_back({key, true, false, false, r.met - 1, double(r.met_value) / r.before, r.met_rate});
    }
    // Sorts by all fields, so that sums do not depend on the order of arrival.
    std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
      return std::tie(a.key, a.scattered, a.cluster, a.value, a.rate) <
             std::tie(b.key, b.scattered, b.cluster, b.value, b.rate);
    });
    most_rows_ = std::min(k_most_rows, std::max(16u, k_most_row_texels / clusters.count()));
    // A row gets about a quarter of this number of samples.
    cut_ = std::max<size_t>(k_cut, 6 * samples_.size() / most_rows_);
    sums_.resize(clusters.count());
    counts_.resize(clusters.count());
    firsts_.resize(clusters.count());
    weights_.resize(clusters.count());
    find_rates();
    for (const float plain : clusters.plain) even_.push_back(plain > 0 ? 1 : 0);
    const double lit = std::accumulate(even_.begin(), even_.end(), 0.0);
    for (double& p : even_) p /= std::max(1.0, lit);
  }

  void learn() {
    // Without learning: contributions proportional to the probabilities.
    Moments prior(clusters_.count());
    for (size_t c = 0; c < prior.size(); ++c) prior[c] = double(clusters_.plain[c]) * clusters_.plain[c];
    const Range all{0, samples_.size()};
    const Moments root = moments_of(all, prior, false);
    const uint32_t row = add_row(root);
    note_arrived(all, row, -1);
    fill_all(row);
    if (!(to_.cells.scale > 0)) return;
    for (uint32_t facing = 0; facing < k_learned_facings; ++facing) {
      const Range range = find(all, facing << 3 * k_levels, (facing + 1) << 3 * k_levels);
      visit(range, facing, 0, uvec3(0), root, row);
    }
  }

  void fill_all(uint32_t row) { to_.grid.assign(k_bricks, row << 1); }
  /// As without learning, except for this share, which is uniform over the clusters with light.
  void mix_all(double even) {
    std::vector<double> p(even_.size());
    for (size_t c = 0; c < p.size(); ++c) p[c] = (1 - even) * clusters_.plain[c] + even * even_[c];
    put_row(p);
    fill_all(to_.row_count - 1);
  }
  uint32_t add_row(const Moments& moments) {
    std::vector<double> p(moments.size());
    double total = 0;
    for (size_t c = 0; c < p.size(); ++c) total += p[c] = std::sqrt(moments[c]);
    for (size_t c = 0; c < p.size(); ++c)
      p[c] = total > 0 ? k_defensive * clusters_.plain[c] + (1 - k_defensive - k_even) * p[c] / total +
                             k_even * even_[c]
                       : clusters_.plain[c];
    put_row(p);
    return to_.row_count - 1;
  }

 private:
  struct Range {
    size_t first, end;
    size_t size() const { return end - first; }
  };
  Range find(Range in, uint32_t low, uint32_t high) const {
    const auto at = [&](uint32_t key) {
      return size_t(std::lower_bound(samples_.begin() + std::ptrdiff_t(in.first),
                                     samples_.begin() + std::ptrdiff_t(in.end), key,
                                     [](const Sample& s, uint32_t k) { return s.key < k; }) -
                    samples_.begin());
    };
    return {at(low), at(high)};
  }

  void put_row(const std::vector<double>& p) {
    for (vec4 e : build_alias_table(p)) {
      const uint32_t own = uint32_t(to_.rows.size()) % clusters_.count(),
                     alias = std::bit_cast<uint32_t>(e.y);
      const auto ratio = [&](uint32_t c, float probability) {
        return clusters_.plain[c] > 0 ? probability / clusters_.plain[c] : 0.f;
      };
      e.z = ratio(own, e.z), e.w = ratio(alias, e.w);
      to_.rows.push_back(e);
    }
    ++to_.row_count;
  }

  /// Mean rates of the clusters, from all points.
  void find_rates() {
    rates_.assign(clusters_.count(), 0.0);
    std::vector<double> counts(rates_.size(), 0.0);
    for (const Sample& s : samples_)
      if (!s.scattered) rates_[s.cluster] += std::min(s.rate, 1.0), ++counts[s.cluster];
    for (size_t c = 0; c < rates_.size(); ++c) rates_[c] /= std::max(1.0, counts[c]);
  }

  /// With `prior`; if `scaled`, only its proportions are used.
  Moments moments_of(Range range, const Moments& prior, bool scaled) {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    std::fill(firsts_.begin(), firsts_.end(), 0.0);
    std::fill(counts_.begin(), counts_.end(), 0u);
    double vertices = 0;
    for (size_t i = range.first; i < range.end; ++i) {
      const Sample& s = samples_[i];
      if (!s.scattered) ++counts_[s.cluster], ++vertices;
    }
    // Combines light samples and scattered rays by the balance heuristic.
    for (size_t i = range.first; i < range.end; ++i) {
      const Sample& s = samples_[i];
      const double share = s.value / (counts_[s.cluster] + vertices * s.rate);
      if (!(s.value > 0)) continue;
      sums_[s.cluster] += share * s.value;
      firsts_[s.cluster] += share;
    }
    // Equivalent number of light samples, and the brightness here relative to the prior.
    double found = 0, expected = 0;
    for (size_t c = 0; c < prior.size(); ++c) {
      weights_[c] = counts_[c] + vertices * rates_[c];
      found += sums_[c] * weights_[c], expected += weights_[c] * prior[c];
    }
    const double mean = vertices > 0 ? expected / vertices : 0;
    const double scale = expected > 0 ? (found + (scaled ? mean : 0)) / (expected + (scaled ? mean : 0)) : 1;
    Moments moments(prior.size());
    for (size_t c = 0; c < prior.size(); ++c)
      moments[c] =
          (sums_[c] * weights_[c] + k_prior_samples * scale * prior[c]) / (weights_[c] + k_prior_samples);
    return moments;
  }

  /// Share for the last generation's rays; `around`: used if these are too few.
  void note_arrived(Range range, uint32_t row, float around) {
    size_t count = 0, arrived = 0;
    for (size_t i = range.first; i < range.end; ++i)
      if (samples_[i].last) ++count, arrived += samples_[i].arrived;
    to_.arrived.resize(row + 1, -1.f);
    to_.arrived[row] = count >= k_known_rays ? float(arrived) / float(count) : around;
  }

  /// A cell of a level, with the moments and the row of its parent.
  void visit(Range range, uint32_t key, uint32_t level, uvec3 corner, const Moments& around, uint32_t row) {
    Moments own = around;
    if (range.size() >= cut_ / 5 && to_.row_count < most_rows_) {
      own = moments_of(range, around, true);
      const uint32_t around_row = std::exchange(row, add_row(own));
      note_arrived(range, row, to_.arrived[around_row]);
      fill(level, corner, key, row);
    }
    if (range.size() < cut_ || level == k_levels) return;
    const uint32_t shift = 3 * (k_levels - level - 1);
    for (uint32_t child = 0; child < 8; ++child) {
      const uint32_t below = key << 3 | child;
      const Range part = find(range, below << shift, (below + 1) << shift);
      const uvec3 at = 2u * corner + uvec3(child & 1u, child >> 1 & 1u, child >> 2);
      if (part.size() > 0) visit(part, below, level + 1, at, own, row);
    }
  }

  /// Makes lookups in this cell read the row.
  void fill(uint32_t level, uvec3 corner, uint32_t key, uint32_t row) {
    const uint32_t facing = key >> 3 * level;
    const auto top_index = [&](uvec3 t) {
      return ((facing * k_learned_top + t.z) * k_learned_top + t.y) * k_learned_top + t.x;
    };
    if (level <= k_top_level) {
      const uint32_t size = 1u << (k_top_level - level);
      const uvec3 first = corner * size;
      for (uint32_t z = 0; z < size; ++z)
        for (uint32_t y = 0; y < size; ++y)
          for (uint32_t x = 0; x < size; ++x) to_.grid[top_index(first + uvec3(x, y, z))] = row << 1;
      return;
    }
    constexpr uint32_t k_brick_cells = k_learned_brick * k_learned_brick * k_learned_brick;
    const uint32_t fine = k_levels - level, size = 1u << fine;
    const uvec3 first = corner * size;
    const uint32_t top = top_index(first / k_learned_brick);
    if ((to_.grid[top] & 1u) == 0) {
      const uint32_t brick = uint32_t(to_.grid.size() - k_bricks) / k_brick_cells, before = to_.grid[top];
      to_.grid.insert(to_.grid.end(), k_brick_cells, before);
      to_.grid[top] = brick << 1 | 1u;
    }
    const uint32_t base = k_bricks + (to_.grid[top] >> 1) * k_brick_cells;
    const uvec3 within = first % k_learned_brick;
    for (uint32_t z = 0; z < size; ++z)
      for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
          to_.grid[base + ((within.z + z) * k_learned_brick + within.y + y) * k_learned_brick + within.x +
                   x] = row << 1;
  }

  const upload::LightClusters& clusters_;
  LearnedLights& to_;
  std::vector<Sample> samples_;
  size_t cut_ = 0;
  uint32_t most_rows_ = 0;
  std::vector<double> sums_, firsts_, weights_, rates_, even_;
  std::vector<uint32_t> counts_;
};

}  // namespace

uint32_t LearnedLights::row_at(const vec3& position, uint32_t facing) const {
  const uvec3 cell(
      glm::clamp((position - cells.origin) * cells.scale, vec3(0), vec3(float(k_learned_cells) - 0.5f)));
  const uvec3 top = cell / k_learned_brick, in = cell % k_learned_brick;
  uint32_t word = grid[((facing * k_learned_top + top.z) * k_learned_top + top.y) * k_learned_top + top.x];
  if ((word & 1u) != 0)
    word = grid[k_bricks +
                (((word >> 1) * k_learned_brick + in.z) * k_learned_brick + in.y) * k_learned_brick + in.x];
  return word >> 1;
}

LearnedCells learned_cells(std::span<const LightRecord> records) {
  std::array<std::vector<float>, 3> along;
  for (const LightRecord& r : records)
    for (int axis = 0; axis < 3 && r.full != 0; ++axis) along[size_t(axis)].push_back(r.position[axis]);
  if (along[0].size() < 2) return {};
  vec3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float>& a = along[size_t(axis)];
    const auto at = [&](size_t i) {
      std::nth_element(a.begin(), a.begin() + std::ptrdiff_t(i), a.end());
      return a[i];
    };
    const size_t out = a.size() / 200;
    low[axis] = at(out), high[axis] = at(a.size() - 1 - out);
  }
  const vec3 size = high - low;
  const float side = 1.05f * std::max({size.x, size.y, size.z});
  if (!(side > 0) || !std::isfinite(side)) return {};
  return {0.5f * (low + high) - 0.5f * side, float(k_learned_cells) / side};
}

LearnedLights plain_lights(const upload::LightClusters& clusters) {
  LearnedLights to;
  Learner(clusters, {}, {}, to).mix_all(k_even_at_first);
  return to;
}

LearnedLights exploring_lights(const upload::LightClusters& clusters) {
  LearnedLights to;
  Learner(clusters, {}, {}, to).mix_all(0.5);
  return to;
}

LearnedLights learn_lights(const upload::LightClusters& clusters, const LearnedCells& cells,
                           std::span<const LightRecord> records, size_t last) {
  LearnedLights to;
  Learner(clusters, cells, records, to, last).learn();
  return to;
}

double measured_gain(const upload::LightClusters& clusters, const LearnedLights& lights,
                     std::span<const LightRecord> records) {
  // What a sample says of its row: light, and the second moments with both probabilities.
  struct Sample {
    uint32_t row;
    double light, learned, plain;
  };
  std::vector<Sample> samples;
  for (const LightRecord& r : records) {
    if (r.full == 0) continue;
    const uint32_t row = lights.row_at(r.position, r.cell >> 16), c = r.cell & 0xffffu;
    const double plain = clusters.plain[c],
                 p = double(lights.rows[size_t(row) * clusters.count() + c].z) * plain;
    if (!(p > 0)) continue;
    const double value = r.full > 0 ? double(r.value) * (r.arrived / r.full) : 0.0;
    samples.push_back({row, value / p, value * value / (p * p), value * value / (p * plain)});
  }
  // Sums must not depend on the order of arrival.
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return std::tie(a.row, a.light, a.plain) < std::tie(b.row, b.light, b.plain);
  });
  double mean = 0, learned = 0, plain = 0;
  for (const Sample& s : samples) mean += s.light / double(samples.size());
  const double floor = 0.05 * mean;
  for (size_t i = 0, end = 0; i < samples.size(); i = end) {
    Sample sum{samples[i].row, 0, 0, 0};
    for (; end < samples.size() && samples[end].row == sum.row; ++end)
      sum.light += samples[end].light, sum.learned += samples[end].learned, sum.plain += samples[end].plain;
    const double n = double(end - i), m = sum.light / n, weight = n / (m * m + floor * floor);
    if (!(m > 0)) continue;
    learned += weight * std::max(0.0, sum.learned / n - m * m);
    plain += weight * std::max(0.0, sum.plain / n - m * m);
  }
  return plain > 0 ? plain / std::max(learned, 1e-6 * plain) : 1;
}

}  // namespace lucerna::transport
