#include "stats/forecast.h"

#include <algorithm>
#include <cmath>

namespace lucerna::stats {

namespace {
double hold(double exponent) { return std::clamp(exponent, 0.3, 1.2); }
}  // namespace

Law fit(const Ledger& ledger, int layer) {
  const auto& entries = ledger.entries();
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (const Entry& e : entries) {
    if (!e.told || e.samples < 8 || e.paths < entries.back().paths / 16 || !(e.error[layer] > 0)) continue;
    const double x = std::log(double(e.paths)), y = std::log(e.error[layer]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double spread = n > 0 ? sxx - sx * sx / n : 0;
  if (n < 3 || spread <= 0) return {};
  const double slope = (sxy - sx * sy / n) / spread;
  const double residual = std::max(0.0, (syy - sy * sy / n) - slope * (sxy - sx * sy / n));
  // The lines share their samples, so that the residual alone is too kind.
  return {hold(-slope), std::max(0.05, 2 * std::sqrt(residual / (n - 2) / spread))};
}

std::optional<Band> seconds_to(const Ledger& ledger, double target, int layer) {
  const auto& entries = ledger.entries();
  if (entries.empty() || !entries.back().told || !(target > 0)) return std::nullopt;
  // Reached for good: the first line after the last one that is over the target.
  size_t reached = entries.size();
  while (reached > 0 && entries[reached - 1].told && entries[reached - 1].error[layer] <= target) --reached;
  if (reached < entries.size()) {
    const double s = entries[reached].wall_s;
    return Band{s, s, s};
  }
  const Entry& last = entries.back();
  const Law law = fit(ledger, layer);
  const auto seconds = [&](double exponent, double error) {
    return last.prepared_s +
           (last.wall_s - last.prepared_s) * std::pow(std::max(1.0, error / target), 1 / hold(exponent));
  };
  const double error = last.error[layer];
  return Band{seconds(law.exponent + law.deviation, 0.95 * error), seconds(law.exponent, error),
              seconds(law.exponent - law.deviation, 1.05 * error)};
}

double samples_to(const TileProgress& tile, double target, double exponent) {
  // Beyond saturation a measured error tells little; at least a quarter of what it says without.
  const auto quality = [](double error) {
    const double q = 1 / (error * error);
    return std::max(q - 1 / (k_saturated_error * k_saturated_error), 0.25 * q);
  };
  if (!(tile.error > 0)) return tile.samples;
  return tile.samples * std::pow(quality(target) / quality(tile.error), 0.5 / exponent);
}

Band total_paths(std::span<const TileProgress> tiles, uint32_t across, double target, double min_samples,
                 double max_samples) {
  const int width = static_cast<int>(across), height = across ? static_cast<int>(tiles.size() / across) : 0;
  const auto total = [&](double exponent, double noise) {
    const auto needed = [&](const TileProgress& t, double error) {
      return samples_to(t, error / noise, exponent);
    };
    double paths = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const TileProgress& tile = tiles[static_cast<size_t>(y) * across + static_cast<size_t>(x)];
        double samples = tile.samples;
        if (tile.open) {
          samples = std::max({samples, min_samples, needed(tile, target)});
          for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
              samples = std::max(
                  samples,
                  needed(tiles[static_cast<size_t>(v) * across + static_cast<size_t>(u)], 2 * target));
          samples = std::min(samples, std::max(max_samples, tile.samples));
        }
        paths += samples * tile.pixels;
      }
    return paths;
  };
  return {total(0.6, 0.95), total(0.5, 1), total(0.44, 1.05)};
}

}  // namespace lucerna::stats
