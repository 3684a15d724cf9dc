#include "film/shown_error.h"

#include <algorithm>
#include <cmath>

namespace lucerna::film {
namespace {

using shared::PreviewTile;

// Weight of earlier measurements at the next measurement.
constexpr double k_decay = 0.25;
// Standard deviation of the whole picture's ratio relative to the first expectation, and of a level's ratio
// relative to that of the level above.
constexpr double k_first_spread = 1, k_spread = 0.7;
// Usual squared error of a picture over the expected one: the first samples' noise is expected from few
// values, and the filter removes more of it than they say. Measured like k_median_size.
constexpr double k_usual_ratio = 0.8;
constexpr double k_most_first = 4;
// Half sides of the pooled neighbourhoods [tiles].
constexpr int k_reaches[] = {4, 1, 0};
// Tiles to each side over which noise is averaged: a tile whose few samples have no rare path seems
// noise-free.
constexpr int k_noise_reach = 3;
constexpr double k_least_ratio = 0.02;
// Mean square of the errors of 3x3 pixels' means over the square of a tile's mean error.
constexpr double k_fine = 2;
// Mean deviation of 3x3 pixels' means in the median tile, and in the tile that a tenth exceeds, over the
// quadratic mean from k_fine. Errors of tiles scatter around their estimates, so the worst are farther from
// the median than the estimates are. Measured after edits of rooms (lucerna bench latency).
constexpr double k_median_size = 1.12, k_worst_size = 1.24;

double quantile(std::vector<double> values, double at) {
  const size_t n = std::min(values.size() - 1, size_t(double(values.size()) * at));
  std::nth_element(values.begin(), values.begin() + long(n), values.end());
  return values[n];
}

/// Sums over squares of 2 * reach + 1 tiles around each tile, clipped at the edges.
template <class T, class Add>
std::vector<T> sums_around(const std::vector<T>& of, int across, int reach, const Add& add) {
  const int down = int(of.size()) / across;
  std::vector<T> rows(of.size()), all(of.size());
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x)
      for (int u = std::max(0, x - reach); u <= std::min(across - 1, x + reach); ++u)
        add(rows[size_t(y * across + x)], of[size_t(y * across + u)]);
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x)
      for (int v = std::max(0, y - reach); v <= std::min(down - 1, y + reach); ++v)
        add(all[size_t(y * across + x)], rows[size_t(v * across + x)]);
  return all;
}

/// Sums over tiles, weighted so that bright and dark tiles count equally.
struct Sums {
  double square = 0, expected = 0, variance = 0;

  void add(const Sums& o) { square += o.square, expected += o.expected, variance += o.variance; }
  /// Estimated square/expected; the prior is a ratio of 1 with this spread.
  double ratio(double spread) const {
    if (expected <= 0) return 1;
    const double own = variance / (expected * expected), prior = spread * spread;
    return std::max((own + square / expected * prior) / (own + prior), k_least_ratio);
  }
};

}  // namespace

ShownJudge::ShownJudge() : first_ratio_(k_usual_ratio), ratio_(k_usual_ratio) {}

void ShownJudge::restart() {
  tiles_.clear();
  first_ratio_ = std::clamp(std::sqrt(k_usual_ratio * ratio_), 1 / k_most_first, k_most_first);
  ratio_ = first_ratio_;
}

void ShownJudge::measure(std::span<const PreviewTile> tiles, uint32_t across) {
  std::vector<std::pair<double, double>> noise;  // sum, tiles
  for (const PreviewTile& t : tiles)
    noise.emplace_back(std::max(double{t.noise}, 0.0), t.noise >= 0 ? 1.0 : 0.0);
  const auto around = sums_around(noise, int(across), k_noise_reach, [](auto& sum, const auto& other) {
    sum.first += other.first, sum.second += other.second;
  });
  std::vector<double> variances(tiles.size(), 0);
  double sum = 0, known = 0;
  for (size_t i = 0; i < tiles.size(); ++i) {
    const PreviewTile& t = tiles[i];
    if (t.noise < 0) continue;
    const double v = std::max(double{t.noise}, around[i].first / around[i].second);
    variances[i] = k_fine * k_fine * (2 * v * v + 4 * v * std::max(double{t.square}, 0.0));
    sum += variances[i], known += 1;
  }
  if (known == 0) return;
  tiles_.resize(tiles.size());
  // Measurements with little noise have the largest weight.
  const double weight = known / std::max(sum, 1e-12);
  for (size_t i = 0; i < tiles.size(); ++i) {
    Measured& m = tiles_[i];
    m.square *= k_decay, m.weight *= k_decay, m.variance *= k_decay * k_decay;
    if (tiles[i].noise < 0) continue;
    m.square += weight * k_fine * double{tiles[i].square};
    m.weight += weight;
    m.variance += weight * weight * variances[i];
  }
}

ShownError ShownJudge::judge(std::span<const PreviewTile> tiles, uint32_t across, bool measured) {
  if (tiles.empty()) return {};
  if (measured) measure(tiles, across);
  std::vector<double> squares;
  for (const PreviewTile& t : tiles) squares.push_back(double{t.error} * double{t.error} * first_ratio_);
  ratio_ = first_ratio_;
  if (tiles_.size() == tiles.size()) {
    const auto sums = [&] {
      const double usual = std::max(quantile(squares, 0.5), 1e-8);
      std::vector<Sums> all(tiles.size());
      for (size_t i = 0; i < tiles.size(); ++i) {
        const Measured& m = tiles_[i];
        if (m.weight <= 0) continue;
        const double w = 1 / (squares[i] + usual);
        all[i] = {w * m.square / m.weight, w * squares[i], w * w * m.variance / (m.weight * m.weight)};
      }
      return all;
    };
    Sums whole;
    for (const Sums& s : sums()) whole.add(s);
    const double of_all = whole.ratio(k_first_spread);
    ratio_ *= of_all;
    for (double& s : squares) s *= of_all;
    for (const int reach : k_reaches) {
      const std::vector<Sums> around =
          sums_around(sums(), int(across), reach, [](Sums& sum, const Sums& other) { sum.add(other); });
      for (size_t i = 0; i < squares.size(); ++i) squares[i] *= around[i].ratio(k_spread);
    }
  }
  return {std::min(k_median_size * std::sqrt(quantile(squares, 0.5)), 1.0),
          std::min(k_worst_size * std::sqrt(quantile(squares, 0.9)), 1.0)};
}

}  // namespace lucerna::film
