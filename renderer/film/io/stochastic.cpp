#include "film/io/stochastic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math.h"

namespace lucerna::film {
namespace {

constexpr int k_reach = 2;  // tiles around a tile that estimate the correlation of its pixels

std::string odd_name(const std::string& channel) { return "odd." + channel; }

/// Mean of a group of pixels in one channel, with its noise.
struct Mean {
  double value = 0;
  double variance = 0, degrees = 0;  ///< of `value`, by pixels
  double difference = 0;  ///< between the halves, scaled so that its square has the mean `variance` if pixels
                          ///< are independent
  double common = 0, bias = 0;  ///< of lookups, in this channel
};

/// Sums over pixels for a Mean.
struct Sums {
  double n = 0, value = 0, v = 0, v2 = 0, difference = 0, noise = 0, bias = 0, luminance = 0;
  Mean mean() const {
    Mean m;
    m.value = value / n, m.variance = v / (n * n);
    m.degrees = v2 > 0 ? v * v / (v2 / 3) : 1;
    m.difference = difference / n;
    const double share = luminance > 0 ? value / luminance : 1;  // of the channel in the luminance
    m.common = share * noise / n, m.bias = share * bias / n;
    return m;
  }
};

/// A channel of a picture, pixel by pixel.
struct Channel {
  const std::vector<float>&all, &odd, &samples;
  const std::vector<float>*noise, *bias;
  std::vector<double> luminance;

  void add(Sums& s, size_t i) const {
    const double n = double(samples[i]), n_odd = std::floor(n / 2), n_even = n - n_odd;
    const double m = double(all[i]), o = double(odd[i]), e = (m * n - o * n_odd) / n_even;
    const double d = (e - o) * std::sqrt(n_even * n_odd) / n, v = d * d;
    s.n += 1, s.value += m, s.v += v, s.v2 += v * v, s.difference += d, s.luminance += luminance[i];
    if (noise) s.noise += double((*noise)[i]);
    if (bias) s.bias += double((*bias)[i]);
  }
};

const std::vector<float>& plane(const FilmImage& image, const std::string& name, const std::string& where) {
  const std::vector<float>* found = image.find(name);
  if (!found)
    throw_error(where, "no channel '{}'; expected a picture that a script has saved as a reference", name);
  for (const float v : *found)
    if (!std::isfinite(v)) throw_error(where, "channel '{}' has values that are not finite", name);
  return *found;
}

std::vector<std::string> channels_of(const FilmImage& image, const std::string& layer,
                                     const std::string& where) {
  std::vector<std::string> names;
  for (const size_t c : image.layer(layer)) names.push_back(image.channels[c].first);
  if (names.empty()) throw_error(where, "there is no layer '{}'", layer);
  return names;
}

/// Means of the tiles of a channel in raster order; last that of the whole picture.
std::vector<Mean> means_of(const Channel& channel, uint32_t width, uint32_t height, uint32_t tile) {
  const uint32_t across = (width + tile - 1) / tile, down = (height + tile - 1) / tile;
  std::vector<Sums> sums(size_t{across} * down + 1);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const size_t i = size_t{y} * width + x;
      channel.add(sums[size_t{y / tile} * across + x / tile], i);
      channel.add(sums.back(), i);
    }
  std::vector<Mean> means;
  for (const Sums& s : sums) means.push_back(s.mean());
  // Correlated pixels: the halves' means differ more than independent pixels would let them.
  std::vector<double> raised(means.size(), 1);
  std::vector<double> limit(means.size(), 1e9);
  double all_squares = 0, all_variance = 0;
  for (uint32_t y = 0; y < down; ++y)
    for (uint32_t x = 0; x < across; ++x) {
      const size_t i = size_t{y} * across + x;
      all_squares += means[i].difference * means[i].difference, all_variance += means[i].variance;
      double squares = 0, variance = 0, count = 0;
      for (int dy = -k_reach; dy <= k_reach; ++dy)
        for (int dx = -k_reach; dx <= k_reach; ++dx) {
          const int64_t nx = int64_t{x} + dx, ny = int64_t{y} + dy;
          if (nx < 0 || ny < 0 || nx >= int64_t{across} || ny >= int64_t{down}) continue;
          const Mean& m = means[static_cast<size_t>(ny) * across + static_cast<size_t>(nx)];
          squares += m.difference * m.difference, variance += m.variance, count += 1;
        }
      if (variance > 0 && squares > variance) raised[i] = squares / variance, limit[i] = count;
    }
  if (all_variance > 0 && all_squares > all_variance)
    raised.back() = all_squares / all_variance, limit.back() = double(means.size() - 1);
  for (size_t i = 0; i < means.size(); ++i) {
    means[i].variance *= raised[i];
    means[i].degrees = std::min(means[i].degrees, limit[i]);
  }
  return means;
}

Channel channel_of(const FilmImage& image, const std::string& layer, const std::string& name,
                   const std::string& where) {
  Channel c{plane(image, name, where),  plane(image, odd_name(name), where), plane(image, "samples", where),
            image.find("lookup.noise"), image.find("lookup.bias"),           {}};
  if (std::any_of(c.samples.begin(), c.samples.end(), [](float n) { return n < 2; }))
    throw Error(where, "a pixel has fewer than two samples, so its noise is unknown");
  const std::vector<std::string> names = channels_of(image, layer, where);
  constexpr double k_weights[] = {0.2126, 0.7152, 0.0722};
  c.luminance.assign(c.all.size(), 0);
  for (size_t k = 0; k < names.size(); ++k) {
    const std::vector<float>& values = plane(image, names[k], where);
    const double weight = names.size() == 3 ? k_weights[k] : 1.0 / double(names.size());
    for (size_t i = 0; i < values.size(); ++i) c.luminance[i] += weight * double(values[i]);
  }
  return c;
}

struct Test {
  double p = 1, noise = 0;
};

Test test(const Mean& a, const Mean& b, double tolerance) {
  const double own = a.variance + b.variance, shared = a.common * a.common + b.common * b.common;
  Test t{.p = 1, .noise = std::sqrt(own + shared)};
  const double allowed = a.bias + b.bias + tolerance * std::abs(b.value) + 1e-7;
  const double excess = std::abs(a.value - b.value) - allowed;
  if (!(excess > 0)) return t;
  if (!(t.noise > 0)) return {0, 0};
  // Welch; the noise of lookups is taken as known.
  const double parts =
      a.variance * a.variance / std::max(1.0, a.degrees) + b.variance * b.variance / std::max(1.0, b.degrees);
  const double degrees = parts > 0 ? (own + shared) * (own + shared) / parts : 1e9;
  t.p = student_two_sided(excess / t.noise, std::min(degrees, 1e9));
  return t;
}

/// ln of the beta function's incomplete integral by Lentz's continued fraction; 0 <= x <= 1.
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) /
      a;
  constexpr double k_tiny = 1e-300;
  const auto kept = [](double v) { return std::abs(v) < k_tiny ? k_tiny : v; };
  double c = 1, d = 1 / kept(1 - (a + b) * x / (a + 1)), f = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / kept(1 + even * d), c = kept(1 + even / c), f *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / kept(1 + odd * d), c = kept(1 + odd / c);
    f *= d * c;
    if (std::abs(d * c - 1) < 1e-13) break;
  }
  return front * f;
}

/// Sidak: the probability that the smallest of so many p-values is at most p.
double corrected(double p, size_t tests) {
  return -std::expm1(double(tests) * std::log1p(-std::min(p, 1 - 1e-15)));
}

}  // namespace

double student_two_sided(double t, double degrees) {
  return incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
}

FilmImage stochastic_layers(const FilmImage& image, const std::string& layer) {
  FilmImage out{.width = image.width, .height = image.height, .metadata = image.metadata};
  std::vector<std::string> names = channels_of(image, layer, "layer");
  for (const std::string& name : channels_of(image, layer, "layer")) names.push_back(odd_name(name));
  names.emplace_back("samples");
  for (const std::string& name : names) {
    const std::vector<float>* found = image.find(name);
    if (!found) throw_error("layer", "the picture has no channel '{}'", name);
    out.channels.emplace_back(name, *found);
  }
  for (const char* name : {"lookup.noise", "lookup.bias"})
    if (const std::vector<float>* found = image.find(name)) out.channels.emplace_back(name, *found);
  return out;
}

StochasticComparison compare_stochastic(const FilmImage& now, const FilmImage& reference,
                                        const StochasticOptions& options, const std::string& where) {
  if (now.width != reference.width || now.height != reference.height)
    throw_error(where, "is {}x{} pixels; the picture has {}x{}", reference.width, reference.height, now.width,
                now.height);
  StochasticComparison c{.width = now.width, .height = now.height, .tile = options.tile};
  c.across = (c.width + c.tile - 1) / c.tile;
  const std::vector<std::string> names = channels_of(reference, options.layer, where);
  const size_t tiles = size_t{c.across} * ((c.height + c.tile - 1) / c.tile);
  c.tests = names.size() * (tiles + 1);
  c.tile_p.assign(tiles, 1);
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::string& name : names) {
    const auto means = [&](const FilmImage& image, const std::string& at) {
      return means_of(channel_of(image, options.layer, name, at), c.width, c.height, c.tile);
    };
    const std::vector<Mean> a = means(now, "the picture"), b = means(reference, where);
    for (size_t i = 0; i < a.size(); ++i) {
      const Test t = test(a[i], b[i], options.tolerance);
      if (i < tiles) c.tile_p[i] = std::min(c.tile_p[i], static_cast<float>(corrected(t.p, c.tests)));
      if (t.p >= smallest) continue;
      smallest = t.p;
      const uint32_t x = static_cast<uint32_t>(i % c.across) * c.tile,
                     y = static_cast<uint32_t>(i / c.across) * c.tile;
      c.worst.area = {x, y, std::min(c.tile, c.width - x),
                      std::min(c.tile, c.height - std::min(y, c.height))};
      if (i == tiles) c.worst.area = {0, 0, c.width, c.height};
      c.worst.channel = name, c.worst.now = a[i].value, c.worst.reference = b[i].value;
      c.worst.noise = t.noise;
    }
  }
  c.p = corrected(smallest, c.tests);
  c.different = c.p < options.significance;
  c.different_tiles = static_cast<size_t>(std::count_if(
      c.tile_p.begin(), c.tile_p.end(), [&](float p) { return double(p) < options.significance; }));
  return c;
}

std::string to_text(const StochasticComparison& c) {
  if (!c.different) return fmt::format("no difference beyond noise (p = {:.2g}, {} tests)", c.p, c.tests);
  const bool whole = c.worst.area[2] == c.width && c.worst.area[3] == c.height;
  return fmt::format(
      "{} of {} tiles differ beyond noise (p = {:.2g}); {}: {} = {:.4g}, expected {:.4g} +- {:.2g}",
      c.different_tiles, c.tile_p.size(), c.p,
      whole ? std::string("whole picture") : fmt::format("at {},{}", c.worst.area[0], c.worst.area[1]),
      c.worst.channel, c.worst.now, c.worst.reference, c.worst.noise);
}

std::vector<uint8_t> tile_picture(const StochasticComparison& c, double significance) {
  std::vector<uint8_t> rgba(size_t{c.width} * c.height * 4, 255);
  const double most = -std::log(significance);
  for (uint32_t y = 0; y < c.height; ++y)
    for (uint32_t x = 0; x < c.width; ++x) {
      const double p = std::max(1e-30, double(c.tile_p[size_t{y / c.tile} * c.across + x / c.tile]));
      uint8_t* out = &rgba[(size_t{y} * c.width + x) * 4];
      const auto grey = static_cast<uint8_t>(255 * std::clamp(-std::log(p) / most, 0.0, 1.0));
      out[0] = grey, out[1] = out[2] = p < significance ? uint8_t{40} : grey;
    }
  return rgba;
}

}  // namespace lucerna::film
