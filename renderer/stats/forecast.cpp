#include "stats/forecast.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucerna::stats {

namespace {

constexpr double k_window = 16;     // factor of work over which a law is fitted
constexpr double k_first_line = 4;  // samples a pixel; with fewer the sequence is not well distributed yet
constexpr uint32_t k_shares = 20;   // places at which f is looked at
constexpr double k_exponents[] = {0.25, 0.5, 0.75, 1};  // q
/// Over 2 / degrees: the relative variance of a sum of squares, for tails heavier than have been met.
constexpr double k_tails = 1.5;
/// Standard deviations of log(N error^2) that the family of laws itself is off by: everywhere, and for each
/// factor e of work that it is carried on.
constexpr double k_misfit = 0.03, k_drift = 0.03;
constexpr double k_few_degrees = 100;  // if they are unknown
constexpr double k_rate_spread = 0.05;
constexpr double k_band = 0.05;  // probability on either side

double square(double x) { return x * x; }

/// log(1 + rho N^-q) for the law with that share of 1 / N at `now`.
double bend(double q, double share, double now, double n) {
  return std::log1p((1 - share) / share * std::pow(now / n, q));
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

}  // namespace

Outlook::Outlook(const Ledger& ledger) {
  const auto& entries = ledger.entries();
  if (entries.empty() || entries.back().samples < k_least_samples) return;
  const double now = entries.back().samples;
  std::vector<const Entry*> lines;
  for (const Entry& e : entries)
    if (e.has_error && e.error[0] > 0 && e.samples >= std::max(k_first_line, now / k_window) &&
        (lines.empty() || e.samples > lines.back()->samples))
      lines.push_back(&e);
  if (lines.size() < 3 || lines.back() != &entries.back()) return;
  samples_ = now;
  double degrees = 0;
  const size_t recent = std::min<size_t>(lines.size(), 4);
  for (size_t i = lines.size() - recent; i < lines.size(); ++i)
    degrees += (lines[i]->degrees > 0 ? lines[i]->degrees : k_few_degrees) / double(recent);
  line_variance_ = k_tails * 2 / degrees + square(k_misfit);

  std::vector<double> likelihoods;
  for (const double q : k_exponents)
    for (uint32_t k = 0; k < k_shares; ++k) {
      const double share = (k + 0.5) / k_shares;
      // Least squares of a constant, log(a), through the chain: what each line adds to what the one before
      // has made likely is independent.
      double precision = 0, sum = 0, squares = 0, samples = 0, level = 0;  // the last two: of the line before
      for (const Entry* e : lines) {
        const double here = std::log(square(e->error[0]) * e->samples) - bend(q, share, now, e->samples);
        const double shared = samples / e->samples, rest = here - shared * level;
        const double weight = 1 / (line_variance_ * (1 - square(shared)));
        precision += weight * square(1 - shared);
        sum += weight * (1 - shared) * rest;
        squares += weight * square(rest);
        samples = e->samples, level = here;
      }
      laws_.push_back({.q = q,
                       .share = share,
                       .level = sum / precision,
                       .variance = 1 / precision,
                       .last = level,
                       .weight = 0});
      likelihoods.push_back(-0.5 * (squares - square(sum) / precision));
    }
  const double most = *std::max_element(likelihoods.begin(), likelihoods.end());
  double total = 0;
  for (size_t i = 0; i < laws_.size(); ++i) total += laws_[i].weight = std::exp(likelihoods[i] - most);
  for (Law& law : laws_) law.weight /= total;
}

double Outlook::probability(double target, double growth) const {
  const double shared = 1 / growth;
  double p = 0;
  for (const Law& law : laws_) {
    // The last line's own luck wears off as samples are added.
    const double level = law.level + shared * (law.last - law.level);
    const double expected =
        level + bend(law.q, law.share, samples_, growth * samples_) - std::log(growth * samples_);
    const double variance = square(1 - shared) * law.variance + line_variance_ * (1 - square(shared)) +
                            square(k_drift * std::log(growth)) + 1e-12;
    p += law.weight * normal_cdf((2 * std::log(target) - expected) / std::sqrt(variance));
  }
  return p;
}

double Outlook::growth(double target, double wanted) const {
  double low = 0, high = 60;  // logarithms
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (probability(target, std::exp(middle)) < wanted ? low : high) = middle;
  }
  return std::exp(high);
}

double Outlook::exponent() const {
  double sum = 0;
  for (const Law& law : laws_) sum += law.weight * 0.5 * (1 + (1 - law.share) * law.q);
  return sum;
}

double Outlook::error(double growth, double wanted) const {
  double low = -14, high = 5;  // logarithms
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (probability(std::exp(middle), growth) < wanted ? low : high) = middle;
  }
  return std::exp(high);
}

double seconds_a_path(const Ledger& ledger) {
  const auto& lines = ledger.entries();
  if (lines.empty() || lines.back().paths == 0) return 0;
  const Entry& last = lines.back();
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    if (2 * line->paths <= last.paths)
      return (last.wall_s - line->wall_s) / static_cast<double>(last.paths - line->paths);
  return (last.wall_s - last.prepared_s) / static_cast<double>(last.paths);
}

double spread_of_pace(const Ledger& ledger) {
  const auto& lines = ledger.entries();
  if (lines.empty()) return k_rate_spread;
  const Entry& last = lines.back();
  const double half = seconds_a_path(ledger);
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    if (4 * line->paths <= 3 * last.paths && half > 0) {
      const double quarter = (last.wall_s - line->wall_s) / static_cast<double>(last.paths - line->paths);
      return std::max(k_rate_spread, std::abs(std::log(quarter / half)));
    }
  return k_rate_spread;
}

double paths_target(const Ledger& ledger, double target) {
  if (ledger.entries().empty()) return target;
  const Entry& last = ledger.entries().back();
  if (last.records <= 0 && last.interpolation <= 0) return target;
  const double rest = target - last.interpolation;
  return rest > last.records ? std::sqrt(square(rest) - square(last.records)) : 0;
}

std::optional<Band> seconds_to(const Ledger& ledger, double target) {
  const auto& entries = ledger.entries();
  if (entries.empty() || !entries.back().has_error || !(target > 0)) return std::nullopt;
  target = paths_target(ledger, target);
  if (!(target > 0)) return std::nullopt;
  // Reached permanently: after the last line above the target.
  size_t reached = entries.size();
  while (reached > 0 && entries[reached - 1].has_error && entries[reached - 1].error[0] <= target) --reached;
  if (reached < entries.size()) {
    const Entry& under = entries[reached];
    double s = under.wall_s;
    if (reached > 0 && entries[reached - 1].has_error && under.error[0] > 0) {
      const Entry& over = entries[reached - 1];
      const double part = std::log(over.error[0] / target) / std::log(over.error[0] / under.error[0]);
      s = over.wall_s + part * (under.wall_s - over.wall_s);
    }
    return Band{s, s, s};
  }
  const Outlook outlook(ledger);
  if (!outlook.known()) return std::nullopt;
  const Entry& last = entries.back();
  const double each = seconds_a_path(ledger) * static_cast<double>(last.paths);
  const double spread = std::exp(spread_of_pace(ledger));
  const auto seconds = [&](double probability, double rate) {
    return last.wall_s + rate * each * (outlook.growth(target, probability) - 1);
  };
  return Band{seconds(k_band, 1 / spread), seconds(0.5, 1), seconds(1 - k_band, spread)};
}

std::optional<Band> error_at(const Ledger& ledger, double samples) {
  const auto& entries = ledger.entries();
  const Outlook outlook(ledger);
  if (!outlook.known()) return std::nullopt;
  const Entry& last = entries.back();
  const double growth = std::max(1.0, samples / last.samples);
  const auto sum = [&](double probability) {
    return error_sum(outlook.error(growth, probability), last.records, last.interpolation);
  };
  return Band{sum(k_band), sum(0.5), sum(1 - k_band)};
}

std::optional<double> WorkPace::follow(double seconds, double done, double left) {
  if (points_.empty() || seconds < points_.back().seconds || done < points_.back().done) *this = {};
  const double news = points_.empty() ? 0 : done - points_.back().done;
  points_.push_back({seconds, done});
  const Point& begun = points_.front();
  const double elapsed = seconds - begun.seconds, worked = done - begun.done;
  if (elapsed < k_least_seconds || worked < k_least_share * (worked + left) || worked <= 0)
    return std::nullopt;
  // Mean time of a unit in the newer half of the work, so that a slow start does not count.
  const auto half = std::find_if(points_.rbegin(), points_.rend(),
                                 [&](const Point& p) { return p.done - begun.done <= 0.5 * worked; });
  const double rest = left * (seconds - half->seconds) / (done - half->done);
  // The mean of what that half has said; a unit of work counts as much as any other.
  const double total = elapsed + rest;
  total_ = total_ ? *total_ + std::min(1.0, 2 * news / worked) * (total - *total_) : total;
  return std::max(*total_ - elapsed, k_least_rest * rest);
}

namespace {

constexpr double k_spread_of_k = 0.5;  // of log k
constexpr double k_least_k = 0.5, k_most_k = 2.5;
constexpr int k_laws = 12;
constexpr double k_history_spread = 0.07;  // of the mean of log(error / expected)
/// Probability that errors follow no law because new light was found, and the deviation then.
constexpr double k_surprise = 0.01, k_surprise_spread = 1.5;
constexpr double k_law_spread = 0.05, k_growth_spread = 0.15;  // of log(paths)

/// 1/error^k over saturation. Beyond saturation a measured error contains little information; at least a
/// quarter of the value without it.
double quality(double error, double k) {
  const double q = std::pow(error, -k);
  return std::max(q - std::pow(k_saturated_error, -k), 0.25 * q);
}

/// Prediction of the tile's present error from an earlier one.
double expected_error(const TileProgress& t, double k) {
  const double q = quality(t.earlier_error, k) * std::pow(t.samples / t.earlier_samples, 0.5 * k);
  return std::pow(q + std::pow(k_saturated_error, -k), -1 / k);
}

}  // namespace

double samples_to(const TileProgress& tile, double target, double k) {
  if (!(tile.error > 0)) return tile.samples;
  return tile.samples * std::pow(quality(target, k) / quality(tile.error, k), 2 / k);
}

std::optional<Band> total_paths(std::span<const TileProgress> tiles, uint32_t across, double target,
                                double min_samples, double max_samples) {
  const int width = static_cast<int>(across), height = across ? static_cast<int>(tiles.size() / across) : 0;
  double closed = 0, now = 0;  // paths of the finished tiles, and so far of the others
  for (const TileProgress& t : tiles) {
    if (t.open && t.samples < Outlook::k_least_samples) return std::nullopt;
    (t.open ? now : closed) += t.samples * t.pixels;
  }
  if (now <= 0) return Band{closed, closed, closed};
  std::vector<double> beside(tiles.size());  // samples at which each has twice the target
  const auto open_paths = [&](double k) {
    const auto goal = [&](const TileProgress& t) { return t.goal > 0 ? t.goal : target; };
    for (size_t t = 0; t < tiles.size(); ++t) beside[t] = samples_to(tiles[t], 2 * goal(tiles[t]), k);
    double paths = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const TileProgress& tile = tiles[static_cast<size_t>(y) * across + static_cast<size_t>(x)];
        if (!tile.open) continue;
        double samples = std::max({tile.samples, min_samples, samples_to(tile, goal(tile), k)});
        for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
            samples = std::max(samples, beside[static_cast<size_t>(v) * across + static_cast<size_t>(u)]);
        paths += std::min(samples, std::max(max_samples, tile.samples)) * tile.pixels;
      }
    return paths;
  };
  struct Law {
    double weight, paths, spread;  // logarithm of the paths and its deviation
  };
  std::array<Law, k_laws> laws;
  for (int i = 0; i < k_laws; ++i) {
    const double k = k_least_k * std::pow(k_most_k / k_least_k, i / (k_laws - 1.0));
    double sum = 0, count = 0;
    for (const TileProgress& t : tiles)
      if (t.open && t.error > 0 && t.earlier_error > 0 && t.earlier_samples > 0)
        sum += std::log(t.error / expected_error(t, k)), ++count;
    const double off = count > 0 ? sum / count : 0;
    const double history =
        (1 - k_surprise) * std::exp(-0.5 * square(off / k_history_spread)) +
        k_surprise * k_history_spread / k_surprise_spread * std::exp(-0.5 * square(off / k_surprise_spread));
    const double prior = std::log(k / k_usual_k) / k_spread_of_k;
    const double paths = std::log(open_paths(k));
    laws[static_cast<size_t>(i)] = {history * std::exp(-0.5 * square(prior)), paths,
                                    k_law_spread + k_growth_spread * (paths - std::log(now))};
  }
  double weights = 0;
  for (const Law& law : laws) weights += law.weight;
  // No fewer than there are, no more than the cap allows.
  double most = 0;
  for (const TileProgress& t : tiles)
    if (t.open) most += std::max({max_samples, t.samples, min_samples}) * t.pixels;
  const auto total = [&](double wanted) {
    double low = std::log(now), high = std::max(low, std::log(most));
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      double p = 0;
      for (const Law& law : laws) p += law.weight / weights * normal_cdf((middle - law.paths) / law.spread);
      (p < wanted ? low : high) = middle;
    }
    return closed + std::exp(high);
  };
  return Band{total(k_band), total(0.5), total(1 - k_band)};
}

}  // namespace lucerna::stats
