#include "film/shown_error.h"

#include <algorithm>
#include <cmath>

namespace lucerna::film {
namespace {

using shared::PreviewTile;

// Of what was measured before, how much counts beside the next measurement, and in the next picture.
constexpr double k_decay = 0.7, k_next_picture = 0.1;
// Of the expected squares before any measurement: the ratio, and its standard deviation over it.
constexpr double k_first_ratio = 1, k_first_spread = 1;
// Half sides of the neighbourhoods that are pooled [tiles], and the standard deviation of a level's ratio
// over that of the level above.
constexpr int k_reaches[] = {4, 1, 0};
constexpr double k_spread = 0.7;
// Over how many tiles to each side noise is averaged: a tile whose few samples met no rare path seems to have
// none.
constexpr int k_noise_reach = 3;
constexpr double k_least_ratio = 0.02;
// Mean square of the errors of 3x3 pixels' means over the square of a tile's mean error.
constexpr double k_fine = 2;
// Mean size of a deviation over its quadratic mean, over the pixels of a tile.
constexpr double k_mean_size = 0.8;

double quantile(std::vector<double> values, double at) {
  const size_t n = std::min(values.size() - 1, size_t(double(values.size()) * at));
  std::nth_element(values.begin(), values.begin() + long(n), values.end());
  return values[n];
}

/// Sums over the squares of 2 * reach + 1 tiles around each, cut off at the edges.
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

}  // namespace

void ShownJudge::Sums::add(const Sums& other, double weight) {
  square += weight * other.square;
  expected += weight * other.expected;
  variance += weight * weight * other.variance;
}

double ShownJudge::Sums::ratio(double prior, double prior_variance) const {
  if (expected <= 0) return prior;
  const double own = variance / (expected * expected);
  return std::max((prior * own + square / expected * prior_variance) / (own + prior_variance), k_least_ratio);
}

void ShownJudge::restart() {
  tiles_.clear();
  Sums kept;
  kept.add(all_, k_next_picture);
  // What holds of one picture says less of the next.
  kept.variance /= k_next_picture;
  all_ = kept;
}

double ShownJudge::ratio() const {
  return all_.ratio(k_first_ratio, k_first_ratio * k_first_ratio * k_first_spread * k_first_spread);
}

void ShownJudge::measure(std::span<const PreviewTile> tiles, uint32_t across) {
  std::vector<double> expected;
  std::vector<std::pair<double, double>> noise;  // sum, tiles
  for (const PreviewTile& t : tiles) {
    const bool known = t.noise >= 0;
    if (known) expected.push_back(double{t.expected});
    noise.emplace_back(known ? double{t.noise} : 0.0, known ? 1.0 : 0.0);
  }
  if (expected.empty()) return;
  const double usual = std::max(quantile(std::move(expected), 0.5), 1e-8);
  const auto around = sums_around(noise, int(across), k_noise_reach, [](auto& sum, const auto& other) {
    sum.first += other.first, sum.second += other.second;
  });
  std::vector<Sums> now(tiles.size());
  Sums all;
  for (size_t i = 0; i < tiles.size(); ++i) {
    const PreviewTile& t = tiles[i];
    if (t.noise < 0) continue;
    const double weight = 1 / (double{t.expected} + usual);
    const double v = std::max(double{t.noise}, around[i].first / around[i].second);
    const double square = double{t.square}, variance = 2 * v * v + 4 * v * std::max(square, 0.0);
    now[i] = {weight * k_fine * square, weight * double{t.expected},
              weight * weight * k_fine * k_fine * variance};
    all.add(now[i]);
  }
  // Measurements of little noise count most.
  const double precision = all.variance > 0 ? all.expected * all.expected / all.variance : 1;
  tiles_.resize(tiles.size());
  const auto take_up = [&](Sums& sums, const Sums& next) {
    Sums kept;
    kept.add(sums, k_decay);
    kept.add(next, precision);
    sums = kept;
  };
  for (size_t i = 0; i < tiles.size(); ++i) take_up(tiles_[i], now[i]);
  take_up(all_, all);
}

std::vector<double> ShownJudge::tile_ratios(uint32_t across) const {
  std::vector<double> ratios(tiles_.size(), ratio());
  for (const int reach : k_reaches) {
    const std::vector<Sums> around =
        sums_around(tiles_, int(across), reach, [](Sums& sum, const Sums& other) { sum.add(other); });
    for (size_t i = 0; i < ratios.size(); ++i)
      ratios[i] = around[i].ratio(ratios[i], k_spread * k_spread * ratios[i] * ratios[i]);
  }
  return ratios;
}

ShownError ShownJudge::judge(std::span<const PreviewTile> tiles, uint32_t across, bool measured) {
  if (tiles.empty()) return {};
  if (measured) measure(tiles, across);
  const std::vector<double> ratios =
      tiles_.size() == tiles.size() ? tile_ratios(across) : std::vector<double>(tiles.size(), ratio());
  std::vector<double> errors(tiles.size());
  for (size_t i = 0; i < tiles.size(); ++i)
    errors[i] = std::min(k_mean_size * std::sqrt(ratios[i]) * double{tiles[i].error}, 1.0);
  return {quantile(errors, 0.5), quantile(errors, 0.9)};
}

}  // namespace lucerna::film
