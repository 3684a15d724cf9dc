#include "film/io/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/color.h"
#include "base/json_text.h"

namespace lucerna::film {
namespace {

struct Planes {
  std::vector<const float*> a, b;
  std::vector<std::string> names;
};

std::string shown_name(const std::string& layer) { return layer.empty() ? "rgb" : layer; }

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Planes matching_planes(const FilmImage& a, const FilmImage& b, const std::string& layer) {
  if (a.width != b.width || a.height != b.height)
    throw_error("compare", "the images differ in size: {}x{} and {}x{}", a.width, a.height, b.width,
                b.height);
  if (a.width == 0 || a.height == 0) throw_error("compare", "the images are empty");
  const std::string where = "layer '" + shown_name(layer) + "'";
  const std::vector<size_t> in_a = a.layer(layer), in_b = b.layer(layer);
  if (in_a.empty()) throw_error(where, "not in the first image, which has: {}", joined(a.layers()));
  if (in_b.empty()) throw_error(where, "not in the second image, which has: {}", joined(b.layers()));
  if (in_a.size() != in_b.size())
    throw_error(where, "{} channels in the first image, {} in the second", in_a.size(), in_b.size());
  Planes planes;
  for (size_t i = 0; i < in_a.size(); ++i) {
    planes.a.push_back(a.channels[in_a[i]].second.data());
    planes.b.push_back(b.channels[in_b[i]].second.data());
    planes.names.push_back(b.channels[in_b[i]].first);
  }
  return planes;
}

double ratio(double a, double b) {
  if (b != 0) return a / b;
  return a == 0 ? 1 : std::numeric_limits<double>::infinity();
}

/// Reorders `values`.
double percentile(std::vector<double>& values, double q) {
  if (values.empty()) return 0;
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const size_t index = std::min(values.size() - 1, static_cast<size_t>(std::max(rank, 1.0)) - 1);
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(index), values.end());
  return values[index];
}

double mean(const std::vector<double>& values, size_t count) {
  if (count == 0) return 0;
  return std::accumulate(values.begin(), values.begin() + static_cast<ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

/// Reorders `values`.
double trimmed_mean(std::vector<double>& values, double share) {
  const size_t dropped = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
  const size_t kept = values.size() - std::min(dropped, values.size());
  if (kept > 0 && kept < values.size())
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(kept), values.end());
  return mean(values, kept);
}

/// Number of pixels of a layer of `image` with a value that satisfies `bad`.
template <class Bad>
uint64_t count_pixels(const FilmImage& image, const std::string& layer, const Bad& bad) {
  const std::vector<size_t> planes = image.layer(layer);
  uint64_t count = 0;
  for (size_t p = 0; p < size_t{image.width} * image.height; ++p)
    count += std::any_of(planes.begin(), planes.end(),
                         [&](size_t plane) { return bad(image.channels[plane].second[p], p); });
  return count;
}

std::vector<NonFinitePixels> find_non_finite(const FilmImage& a, const FilmImage& b,
                                             const std::string& compared) {
  std::vector<std::string> layers{compared};
  for (const FilmImage* image : {&a, &b})
    for (const std::string& layer : image->layers())
      if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  const std::string k_depth = "Z";
  std::vector<NonFinitePixels> found;
  for (const std::string& layer : layers) {
    NonFinitePixels pixels{.layer = layer};
    for (size_t side = 0; side < 2; ++side) {
      const FilmImage &image = side == 0 ? a : b, &other = side == 0 ? b : a;
      const std::vector<float>* across = layer == compared ? other.find(k_depth) : nullptr;
      pixels.count[side] = count_pixels(image, layer, [&](float value, size_t p) {
        if (layer != k_depth || std::isnan(value)) return !std::isfinite(value);
        return across && std::isinf(value) && (*across)[p] != value;
      });
    }
    if (pixels.count != std::array<uint64_t, 2>{0, 0}) found.push_back(pixels);
  }
  return found;
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json numbers(const std::vector<double>& values) {
  nlohmann::json list = nlohmann::json::array();
  for (double value : values) list.push_back(number(value));
  return list;
}

double mean_flip(const Planes& planes, uint32_t width, size_t pixels, bool encoded) {
  const auto colours = [&](const std::vector<const float*>& channels) {
    std::vector<vec3> c(pixels);
    for (size_t p = 0; p < pixels; ++p) {
      c[p] = {channels[0][p], channels[1][p], channels[2][p]};
      for (int k = 0; encoded && k < 3; ++k) c[p][k] = linear_from_srgb(std::clamp(c[p][k], 0.0f, 1.0f));
    }
    return c;
  };
  const std::vector<vec3> a = colours(planes.a), b = colours(planes.b);
  const std::vector<float> flips = encoded ? flip(width, a, b) : flip_hdr(width, a, b);
  return std::accumulate(flips.begin(), flips.end(), 0.0) / double(pixels);
}

uint8_t srgb_byte(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<uint8_t>(std::lround(255 * encoded));
}

}  // namespace

Comparison compare(const FilmImage& a, const FilmImage& b, const std::string& layer,
                   const CompareOptions& options) {
  if (!(options.epsilon > 0))
    throw_error("compare: epsilon", "expected a number above 0, found {}", options.epsilon);
  if (!(options.trimmed_share >= 0 && options.trimmed_share < 1))
    throw_error("compare: trimmed share", "expected 0 to below 1, found {}", options.trimmed_share);
  if (options.block == 0) throw_error("compare: block", "expected at least 1 pixel");
  const Planes planes = matching_planes(a, b, layer);
  const size_t count = planes.names.size();

  Comparison result;
  result.layer = shown_name(layer);
  result.width = a.width;
  result.height = a.height;
  result.channels = planes.names;
  result.non_finite_layers = find_non_finite(a, b, result.layer);
  result.mean_a.assign(count, 0);
  result.mean_b.assign(count, 0);

  const uint32_t blocks_x = (a.width + options.block - 1) / options.block;
  const uint32_t blocks_y = (a.height + options.block - 1) / options.block;
  std::vector<double> block_a(size_t{blocks_x} * blocks_y, 0), block_b = block_a;
  std::vector<double> square, relative_square, absolute, relative;  // one value a finite pixel
  for (uint32_t y = 0; y < a.height; ++y) {
    for (uint32_t x = 0; x < a.width; ++x) {
      const size_t p = size_t{y} * a.width + x;
      bool finite = true;
      for (size_t c = 0; c < count; ++c) {
        const float values[2] = {planes.a[c][p], planes.b[c][p]};
        for (size_t side = 0; side < 2; ++side) {
          if (std::isfinite(values[side])) continue;
          finite = false;
          ++result.non_finite[side];
          if (std::isnan(values[side])) ++result.nan[side];
        }
      }
      if (!finite) continue;
      double e2 = 0, re2 = 0, e = 0, re = 0;
      const size_t block = size_t{y / options.block} * blocks_x + x / options.block;
      for (size_t c = 0; c < count; ++c) {
        const double va = planes.a[c][p], vb = planes.b[c][p], d = va - vb, scale = vb * vb + options.epsilon;
        e2 += d * d, re2 += d * d / scale, e += std::abs(d), re += std::abs(d) / std::sqrt(scale);
        result.mean_a[c] += va, result.mean_b[c] += vb;
        block_a[block] += va, block_b[block] += vb;
      }
      const double weight = 1.0 / static_cast<double>(count);
      square.push_back(e2 * weight), relative_square.push_back(re2 * weight);
      absolute.push_back(e * weight), relative.push_back(re * weight);
      if (absolute.back() > result.largest.absolute)
        result.largest.absolute = absolute.back(), result.largest.at = {x, y};
    }
  }

  result.pixels = square.size();
  for (size_t c = 0; c < count; ++c) {
    const double pixels = std::max<double>(1, static_cast<double>(result.pixels));
    result.mean_a[c] /= pixels, result.mean_b[c] /= pixels;
    result.mean_ratio.push_back(ratio(result.mean_a[c], result.mean_b[c]));
  }
  result.rmse = std::sqrt(mean(square, square.size()));
  result.relmse = mean(relative_square, relative_square.size());
  result.trimmed.rmse = std::sqrt(trimmed_mean(square, options.trimmed_share));
  result.trimmed.relmse = trimmed_mean(relative_square, options.trimmed_share);
  result.p99.absolute = percentile(absolute, 0.99);
  result.p99.relative = percentile(relative, 0.99);

  const size_t all = size_t{a.width} * a.height;
  if (count == 3 && result.pixels == all) result.flip = mean_flip(planes, a.width, all, options.encoded);

  std::vector<double> ratios;
  for (size_t i = 0; i < block_a.size(); ++i)
    if (block_b[i] > 0) ratios.push_back(block_a[i] / block_b[i]);
  result.blocks.count = ratios.size();
  if (!ratios.empty()) {
    result.blocks.p05 = percentile(ratios, 0.05);
    result.blocks.median = percentile(ratios, 0.5);
    result.blocks.p95 = percentile(ratios, 0.95);
  }
  return result;
}

std::string to_json(const Comparison& c) {
  nlohmann::ordered_json json;
  json["layer"] = c.layer;
  json["width"] = c.width;
  json["height"] = c.height;
  json["channels"] = c.channels;
  json["pixels"] = c.pixels;
  json["non_finite"] = c.non_finite;
  json["nan"] = c.nan;
  json["non_finite_pixels"] = nlohmann::ordered_json::object();
  for (const NonFinitePixels& pixels : c.non_finite_layers)
    json["non_finite_pixels"][pixels.layer] = pixels.count;
  json["mean_a"] = numbers(c.mean_a);
  json["mean_b"] = numbers(c.mean_b);
  json["mean_ratio"] = numbers(c.mean_ratio);
  json["rmse"] = number(c.rmse);
  json["relmse"] = number(c.relmse);
  json["rmse_trimmed"] = number(c.trimmed.rmse);
  json["relmse_trimmed"] = number(c.trimmed.relmse);
  json["flip"] = c.flip ? number(*c.flip) : nlohmann::json(nullptr);
  json["p99_absolute"] = number(c.p99.absolute);
  json["p99_relative"] = number(c.p99.relative);
  json["max_absolute"] = number(c.largest.absolute);
  json["max_at"] = c.largest.at;
  json["blocks"] = c.blocks.count;
  json["block_ratio"] = {
      {"p05", number(c.blocks.p05)}, {"median", number(c.blocks.median)}, {"p95", number(c.blocks.p95)}};
  return json_text(json);
}

std::string non_finite_text(const Comparison& c) {
  std::string text;
  for (const NonFinitePixels& pixels : c.non_finite_layers)
    text += fmt::format("{}{}: {} pixels of the first image, {} of the second", text.empty() ? "" : "; ",
                        pixels.layer, pixels.count[0], pixels.count[1]);
  return text;
}

std::string to_text(const Comparison& c) {
  std::string text = fmt::format("{}  {}x{}, {} finite pixels\n", c.layer, c.width, c.height, c.pixels);
  text += fmt::format("  not finite    {} and {} values, {} and {} of them NaN\n", c.non_finite[0],
                      c.non_finite[1], c.nan[0], c.nan[1]);
  if (!c.non_finite_layers.empty()) text += fmt::format("  in the layers {}\n", non_finite_text(c));
  for (size_t i = 0; i < c.channels.size(); ++i)
    text += fmt::format("  mean {:<8} {:.6g} / {:.6g} = {:.5f}\n", c.channels[i], c.mean_a[i], c.mean_b[i],
                        c.mean_ratio[i]);
  text += fmt::format("  RMSE          {:.6g}   trimmed {:.6g}\n", c.rmse, c.trimmed.rmse);
  text += fmt::format("  relative MSE  {:.6g}   trimmed {:.6g}\n", c.relmse, c.trimmed.relmse);
  if (c.flip) text += fmt::format("  FLIP          {:.6g}\n", *c.flip);
  text += fmt::format("  99 % of pixels differ by at most {:.6g} (relative {:.6g})\n", c.p99.absolute,
                      c.p99.relative);
  text +=
      fmt::format("  largest       {:.6g} at {}, {}\n", c.largest.absolute, c.largest.at[0], c.largest.at[1]);
  text += fmt::format("  block ratios  {:.5f} (5 %)  {:.5f} (median)  {:.5f} (95 %)  of {} blocks\n",
                      c.blocks.p05, c.blocks.median, c.blocks.p95, c.blocks.count);
  return text;
}

std::vector<uint8_t> difference_picture(const FilmImage& a, const FilmImage& b, const std::string& layer,
                                        float factor) {
  const Planes planes = matching_planes(a, b, layer);
  const size_t pixels = size_t{a.width} * a.height, last = planes.names.size() - 1;
  std::vector<uint8_t> rgba(pixels * 4, 255);
  for (size_t p = 0; p < pixels; ++p) {
    bool finite = true;
    for (size_t c = 0; c < 3; ++c) {
      const size_t plane = std::min(c, last);
      const float difference = std::abs(planes.a[plane][p] - planes.b[plane][p]);
      finite = finite && std::isfinite(difference);
      rgba[4 * p + c] = finite ? srgb_byte(factor * difference) : uint8_t{255};
    }
    if (!finite) rgba[4 * p] = rgba[4 * p + 2] = 255, rgba[4 * p + 1] = 0;
  }
  return rgba;
}

}  // namespace lucerna::film
