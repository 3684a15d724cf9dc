#include "film/io/relative_mse.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace lucerna::film {
namespace {

using glm::dvec3;

/// The pixels around (x, y) that are in the picture; of a picture of one pixel, that one.
template <class F>
void around(uint32_t x, uint32_t y, uint32_t width, uint32_t height, F visit) {
  for (uint32_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v)
    for (uint32_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u)
      if (u != x || v != y || width * height == 1) visit(size_t{v} * width + u);
}

/// r^2 + epsilon of every pixel.
std::vector<dvec3> scales(const ReferencePair& references, double epsilon) {
  const uint32_t width = references.width, height = width ? uint32_t(references.first.size() / width) : 0;
  std::vector<dvec3> scale(references.first.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      dvec3 sum(0);
      double count = 0;
      around(x, y, width, height, [&](size_t p) {
        sum += (dvec3(references.first[p]) + dvec3(references.second[p])) / 2.0, ++count;
      });
      const dvec3 r = sum / count;
      scale[size_t{y} * width + x] = r * r + dvec3(epsilon);
    }
  return scale;
}

double mean_of(const dvec3& v) { return (v.x + v.y + v.z) / 3; }

double mean(std::span<const double> values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Median; for an even number of values the mean of the two in the middle.
double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const size_t n = values.size();
  const auto upper = values.begin() + ptrdiff_t(n / 2);
  std::nth_element(values.begin(), upper, values.end());
  return n % 2 ? *upper : (*upper + *std::max_element(values.begin(), upper)) / 2;
}

/// (l + f m)^2 of every pixel, for each colour.
std::vector<dvec3> seen_scales(const ReferencePair& references, double floor) {
  const uint32_t width = references.width, height = width ? uint32_t(references.first.size() / width) : 0;
  std::vector<double> light(references.first.size()), local(light.size());
  for (size_t p = 0; p < light.size(); ++p)
    light[p] = (double(luminance(references.first[p])) + double(luminance(references.second[p]))) / 2;
  for (int y = 0; y < int(height); ++y)
    for (int x = 0; x < int(width); ++x) {
      double sum = 0;
      for (int v = y - 2; v <= y + 2; ++v)
        for (int u = x - 2; u <= x + 2; ++u)
          sum += light[size_t(std::clamp(v, 0, int(height) - 1)) * width +
                       size_t(std::clamp(u, 0, int(width) - 1))];
      local[size_t(y) * width + size_t(x)] = sum / 25;
    }
  double adapted = median(local);
  if (!(adapted > 0)) adapted = mean(local);
  std::vector<dvec3> scale(local.size());
  for (size_t p = 0; p < scale.size(); ++p) {
    const double seen = local[p] + floor * adapted;
    scale[p] = dvec3(seen > 0 ? seen * seen : std::numeric_limits<double>::infinity());
  }
  return scale;
}

/// The mean over the colours of the product of the differences from both references, over the scale.
std::vector<double> products(std::span<const vec3> picture, const ReferencePair& references,
                             std::span<const dvec3> scale) {
  assert(picture.size() == references.first.size() && picture.size() == references.second.size());
  std::vector<double> error(picture.size());
  for (size_t p = 0; p < error.size(); ++p) {
    const dvec3 t(picture[p]);
    error[p] = mean_of((t - dvec3(references.first[p])) * (t - dvec3(references.second[p])) / scale[p]);
  }
  return error;
}

/// The mean of `error` without the worst share of the pixels by `order`, rounded up; of equal ones the last.
/// 0 if none remains.
double trimmed_mean(std::span<const double> error, std::span<const double> order, double share) {
  const size_t dropped = size_t(std::ceil(share * double(error.size())));
  const size_t kept = error.size() - std::min(dropped, error.size());
  std::vector<size_t> pixels(error.size());
  std::iota(pixels.begin(), pixels.end(), size_t{0});
  const auto calmer = [&](size_t a, size_t b) {
    return order[a] < order[b] || (order[a] == order[b] && a < b);
  };
  if (kept < pixels.size())
    std::nth_element(pixels.begin(), pixels.begin() + ptrdiff_t(kept), pixels.end(), calmer);
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += error[pixels[i]];
  return kept > 0 ? sum / double(kept) : 0;
}

/// Standard error of the mean of products() from the references' own noise.
double products_noise(const ReferencePair& references, std::span<const dvec3> scale) {
  // With noises a and b of variance s, (a - b)^2 / 2 has the mean s and, if they are normal, the mean square
  // 3 s^2, whereas (a b)^2, one of which is in the error of each pixel, has s^2. The colours of a pixel count
  // as one value.
  double squares = 0;
  for (size_t p = 0; p < scale.size(); ++p) {
    const dvec3 d = dvec3(references.first[p]) - dvec3(references.second[p]);
    const double variance = mean_of(d * d / scale[p]) / 2;
    squares += variance * variance / 3;
  }
  return scale.empty() ? 0 : std::sqrt(squares) / double(scale.size());
}

}  // namespace

RelativeMse relative_mse(std::span<const vec3> picture, const ReferencePair& references,
                         const RelativeMseOptions& options) {
  const std::vector<double> error = products(picture, references, scales(references, options.epsilon));
  const uint32_t width = references.width, height = width ? uint32_t(error.size() / width) : 0;
  std::vector<double> beside(error.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      double sum = 0, count = 0;
      around(x, y, width, height, [&](size_t p) { sum += error[p], ++count; });
      beside[size_t{y} * width + x] = sum / count;
    }
  return {.all = mean(error), .trimmed = trimmed_mean(error, beside, options.trimmed_share)};
}

double relative_mse_noise(const ReferencePair& references, const RelativeMseOptions& options) {
  return products_noise(references, scales(references, options.epsilon));
}

SeenMse seen_mse(std::span<const vec3> picture, const ReferencePair& references,
                 const SeenMseOptions& options) {
  const std::vector<dvec3> scale = seen_scales(references, options.floor);
  const std::vector<double> error = products(picture, references, scale);
  double trimmed = 0;
  for (const std::vector<vec3>* reference : {&references.first, &references.second}) {
    std::vector<double> apart(error.size());
    for (size_t p = 0; p < error.size(); ++p) {
      const dvec3 d = dvec3(picture[p]) - dvec3((*reference)[p]);
      apart[p] = mean_of(d * d / scale[p]);
    }
    trimmed += trimmed_mean(error, apart, options.trimmed_share) / 2;
  }
  return {.all = mean(error), .trimmed = trimmed};
}

double seen_mse_noise(const ReferencePair& references, const SeenMseOptions& options) {
  return products_noise(references, seen_scales(references, options.floor));
}

std::vector<float> seen_difference(std::span<const vec3> picture, const ReferencePair& references,
                                   const SeenMseOptions& options) {
  const std::vector<dvec3> scale = seen_scales(references, options.floor);
  std::vector<float> difference(scale.size());
  for (size_t p = 0; p < difference.size(); ++p) {
    const double truth =
        (double(luminance(references.first[p])) + double(luminance(references.second[p]))) / 2;
    difference[p] = float(std::abs(double(luminance(picture[p])) - truth) / std::sqrt(scale[p].x));
  }
  return difference;
}

}  // namespace lucerna::film
