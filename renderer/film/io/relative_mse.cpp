#include "film/io/relative_mse.h"

#include <algorithm>
#include <cassert>
#include <cmath>
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

}  // namespace

RelativeMse relative_mse(std::span<const vec3> picture, const ReferencePair& references,
                         const RelativeMseOptions& options) {
  assert(picture.size() == references.first.size() && picture.size() == references.second.size());
  const std::vector<dvec3> scale = scales(references, options.epsilon);
  std::vector<double> error(picture.size());
  for (size_t p = 0; p < error.size(); ++p) {
    const dvec3 t(picture[p]);
    error[p] = mean_of((t - dvec3(references.first[p])) * (t - dvec3(references.second[p])) / scale[p]);
  }
  RelativeMse result{.all = mean(error)};

  const uint32_t width = references.width, height = width ? uint32_t(error.size() / width) : 0;
  std::vector<double> beside(error.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      double sum = 0, count = 0;
      around(x, y, width, height, [&](size_t p) { sum += error[p], ++count; });
      beside[size_t{y} * width + x] = sum / count;
    }
  const size_t dropped = size_t(std::ceil(options.trimmed_share * double(error.size())));
  const size_t kept = error.size() - std::min(dropped, error.size());
  std::vector<size_t> order(error.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto calmer = [&](size_t a, size_t b) {
    return beside[a] < beside[b] || (beside[a] == beside[b] && a < b);
  };
  if (kept < order.size())
    std::nth_element(order.begin(), order.begin() + ptrdiff_t(kept), order.end(), calmer);
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += error[order[i]];
  result.trimmed = kept > 0 ? sum / double(kept) : 0;
  return result;
}

double relative_mse_noise(const ReferencePair& references, const RelativeMseOptions& options) {
  const std::vector<dvec3> scale = scales(references, options.epsilon);
  // With noises a and b of one variance s: (a - b)^2 / 2 has the mean s and, were they normal, the mean
  // square 3 s^2, where (a b)^2, of which the error has one a pixel, has s^2. Colours of a pixel are taken
  // for one.
  double squares = 0;
  for (size_t p = 0; p < scale.size(); ++p) {
    const dvec3 d = dvec3(references.first[p]) - dvec3(references.second[p]);
    const double variance = mean_of(d * d / scale[p]) / 2;
    squares += variance * variance / 3;
  }
  return scale.empty() ? 0 : std::sqrt(squares) / double(scale.size());
}

}  // namespace lucerna::film
