#include "upload/texture_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "upload/textures.h"

namespace lucerna::upload {

namespace {

constexpr double k_most_repeats = 4;  // of rows: beyond, a triangle has the whole texture's mean

int64_t floor_mod(int64_t i, int64_t n) { return (i % n + n) % n; }

/// Index of a texel of a row or column continued by the wrap mode.
int64_t wrapped(int64_t i, int64_t size, scene::Wrap wrap) {
  if (wrap == scene::Wrap::clamp) return std::clamp<int64_t>(i, 0, size - 1);
  if (wrap == scene::Wrap::repeat) return floor_mod(i, size);
  const int64_t at = floor_mod(i, 2 * size);
  return at < size ? at : 2 * size - 1 - at;
}

/// Sum of the texels before `i` of a row continued on both sides, minus that before 0. `before`: prefix sums
/// of the row, size + 1.
double sum_before(const double* before, int64_t i, int64_t size, scene::Wrap wrap) {
  if (wrap == scene::Wrap::clamp) {
    if (i < 0) return double(i) * before[1];
    return i <= size ? before[i] : before[size] + double(i - size) * (before[size] - before[size - 1]);
  }
  const int64_t period = wrap == scene::Wrap::repeat ? size : 2 * size;
  const int64_t at = floor_mod(i, period);
  const double whole = wrap == scene::Wrap::repeat ? before[size] : 2 * before[size];
  const double part = at <= size ? before[at] : 2 * before[size] - before[2 * size - at];
  return double((i - at) / period) * whole + part;
}

/// The part of a triangle between two heights, as an interval along x; false: there is none.
bool span_between(const std::array<glm::dvec2, 3>& p, double low, double high, double& from, double& to) {
  from = std::numeric_limits<double>::max(), to = -from;
  const auto add = [&](double x) { from = std::min(from, x), to = std::max(to, x); };
  for (size_t k = 0; k < 3; ++k) {
    const glm::dvec2 &a = p[k], &b = p[(k + 1) % 3];
    if (a.y >= low && a.y <= high) add(a.x);
    for (const double y : {low, high})
      if ((a.y < y) != (b.y < y)) add(a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0));
  }
  return from <= to;
}

}  // namespace

const TextureMeans::Sums& TextureMeans::sums_of(scene::Id texture) {
  const auto [at, fresh] = sums_.try_emplace(texture);
  Sums& sums = at->second;
  if (!fresh) return sums;
  const scene::Image& image = scene_.images[scene_.textures[texture].image];
  sums.rows.resize((size_t{image.width} + 1) * image.height);
  for (uint32_t y = 0; y < image.height; ++y) {
    double* row = &sums.rows[(size_t{image.width} + 1) * y];
    for (uint32_t x = 0; x < image.width; ++x) {
      const double value = luminance(read_texel(scene_, texture, x, y));
      row[x + 1] = row[x] + (std::isfinite(value) ? std::max(value, 0.0) : 0.0);
    }
    sums.mean += row[image.width] / (double(image.width) * image.height);
  }
  return sums;
}

double TextureMeans::over(const scene::TextureUse& use, const std::array<vec2, 3>& uv) {
  if (!use) return 1;
  const scene::Texture& texture = scene_.textures[use.texture];
  const scene::Image& image = scene_.images[texture.image];
  const Sums& sums = sums_of(use.texture);
  // In texels, 0 at the middle of the first: a read between two touches both.
  std::array<glm::dvec2, 3> p;
  glm::dvec2 lo(std::numeric_limits<double>::max()), hi(-lo);
  for (size_t k = 0; k < 3; ++k) {
    const auto& m = use.m;
    p[k] = {double(m[0] * uv[k].x + m[1] * uv[k].y + m[2]) * image.width - 0.5,
            double(m[3] * uv[k].x + m[4] * uv[k].y + m[5]) * image.height - 0.5};
    lo = glm::min(lo, p[k]), hi = glm::max(hi, p[k]);
    if (!std::isfinite(p[k].x) || !std::isfinite(p[k].y)) return sums.mean;
  }
  constexpr double k_most_texel = 1e15;
  if (hi.y - lo.y > k_most_repeats * image.height ||
      std::max({std::abs(lo.x), std::abs(lo.y), std::abs(hi.x), std::abs(hi.y)}) > k_most_texel)
    return sums.mean;
  // What the device rounds of its coordinates is far less than a texel; a read there has weight nearly 0.
  double sum = 0, texels = 0;
  for (auto y = int64_t(std::floor(lo.y)); y <= int64_t(std::floor(hi.y)) + 1; ++y) {
    double from = 0, to = 0;
    if (!span_between(p, double(y) - 1, double(y) + 1, from, to)) continue;
    const auto first = int64_t(std::floor(from)), end = int64_t(std::floor(to)) + 2;
    const double* row =
        &sums.rows[(size_t{image.width} + 1) * size_t(wrapped(y, image.height, texture.wrap_v))];
    sum += sum_before(row, end, image.width, texture.wrap_u) -
           sum_before(row, first, image.width, texture.wrap_u);
    texels += double(end - first);
  }
  return texels > 0 ? std::max(sum, 0.0) / texels : sums.mean;
}

}  // namespace lucerna::upload
