#include "film/io/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lucerna::film {
namespace {

using Plane = std::vector<float>;

/// Weights along one axis; the middle one belongs to the pixel itself.
using Weights = std::vector<float>;

/// A picture extended beyond its edges, filtered along x or y.
struct Grid {
  int width, height;

  Plane along_x(const Plane& from, const Weights& weights) const {
    const int reach = int(weights.size() / 2);
    Plane to(from.size());
    std::vector<float> row(size_t(width + 2 * reach));
    for (int y = 0; y < height; ++y) {
      const float* line = &from[size_t(y) * size_t(width)];
      for (int x = 0; x < width + 2 * reach; ++x) row[size_t(x)] = line[std::clamp(x - reach, 0, width - 1)];
      float* sum = &to[size_t(y) * size_t(width)];
      for (size_t k = 0; k < weights.size(); ++k)
        for (int x = 0; x < width; ++x) sum[x] += weights[k] * row[size_t(x) + k];
    }
    return to;
  }

  Plane along_y(const Plane& from, const Weights& weights) const {
    const int reach = int(weights.size() / 2);
    Plane to(from.size());
    for (int y = 0; y < height; ++y) {
      float* sum = &to[size_t(y) * size_t(width)];
      for (size_t k = 0; k < weights.size(); ++k) {
        const float* line = &from[size_t(std::clamp(y + int(k) - reach, 0, height - 1)) * size_t(width)];
        for (int x = 0; x < width; ++x) sum[x] += weights[k] * line[x];
      }
    }
    return to;
  }
};

// ---- Colours -----------------------------------------------------------------------------------

// Columns: XYZ of Rec.709's red, green and blue, as the authors' program has them.
constexpr mat3 k_to_xyz(10135552 / 24577794.0f, 2613072 / 12288897.0f, 1425312 / 73733382.0f,
                        8788810 / 24577794.0f, 8788810 / 12288897.0f, 8788810 / 73733382.0f,
                        4435075 / 24577794.0f, 887015 / 12288897.0f, 70074185 / 73733382.0f);
constexpr vec3 k_white = k_to_xyz[0] + k_to_xyz[1] + k_to_xyz[2];

/// XYZ over that of white, which has luminance 1.
vec3 relative_xyz(const vec3& rgb) { return k_to_xyz * rgb / k_white; }

/// YCxCz, the linear form of CIELAB, with opposed colours.
vec3 opponents(const vec3& rgb) {
  const vec3 c = relative_xyz(rgb);
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

vec3 rgb_of_opponents(const vec3& o) {
  static const mat3 k_to_rgb = inverse(k_to_xyz);
  const float y = (o.x + 16) / 116;
  return k_to_rgb * (vec3(y + o.y / 500, y, y - o.z / 200) * k_white);
}

/// CIELAB with the colours' strength by luminance (Hunt's effect).
vec3 hunt_lab(const vec3& rgb) {
  constexpr float k_delta = 6.0f / 29;
  vec3 f = relative_xyz(rgb);
  for (int i = 0; i < 3; ++i)
    f[i] = f[i] > k_delta * k_delta * k_delta ? std::cbrt(f[i]) : f[i] / (3 * k_delta * k_delta) + 4.0f / 29;
  const float lightness = 116 * f.y - 16;
  return {lightness, 0.01f * lightness * 500 * (f.x - f.y), 0.01f * lightness * 200 * (f.y - f.z)};
}

/// The distance HyAB, |dL| + |(da, db)|, to the power 0.7, which compresses large ones.
float colour_distance(const vec3& a, const vec3& b) {
  const vec3 d = a - b;
  return std::pow(std::abs(d.x) + std::hypot(d.y, d.z), 0.7f);
}

/// Maps distances to 0..1: those below 0.4 of the largest, which is between green and blue, take 0.95 of the
/// range.
float colour_error(float distance) {
  static const float k_most = colour_distance(hunt_lab(vec3(0, 1, 0)), hunt_lab(vec3(0, 0, 1)));
  constexpr float k_part = 0.4f, k_range = 0.95f;
  const float bend = k_part * k_most;
  return distance < bend ? k_range * distance / bend
                         : k_range + (1 - k_range) * (distance - bend) / (k_most - bend);
}

// ---- Contrast sensitivity ----------------------------------------------------------------------

/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees: a part of the eye's response to a point of light. The
/// Fourier transform of the sum is its sensitivity to contrasts.
struct Bell {
  double a, b;
};
constexpr std::array<Bell, 2> k_achromatic{{{1, 0.0047}, {0, 1}}}, k_red_green{{{1, 0.0053}, {0, 1}}},
    k_blue_yellow{{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double k_widest = 0.04;

/// A plane as the eye sees its contrasts at that distance: convolution with a sum of Gaussians, of unit sum.
Plane blurred(const Grid& grid, const Plane& plane, const std::array<Bell, 2>& bells, double per_degree) {
  const int reach = int(std::ceil(3 * std::sqrt(k_widest / (2 * M_PI * M_PI)) * per_degree));
  // Tails of narrow Gaussians below the precision of floats.
  constexpr double k_least = 1e-9;
  Plane sum(plane.size());
  double all = 0;
  for (const Bell& bell : bells) {
    if (bell.a == 0) continue;
    const auto value = [&](int x) {
      const double degrees = x / per_degree;
      return std::exp(-M_PI * M_PI * degrees * degrees / bell.b);
    };
    int used = reach;
    while (used > 0 && value(used) < k_least) --used;
    Weights weights;
    double total = 0;
    for (int x = -used; x <= used; ++x) total += value(x), weights.push_back(float(value(x)));
    const double amplitude = bell.a * std::sqrt(M_PI / bell.b);
    const Plane part = grid.along_y(grid.along_x(plane, weights), weights);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += float(amplitude) * part[i];
    all += amplitude * total * total;
  }
  for (float& v : sum) v = float(v / all);
  return sum;
}

// ---- Edges and points --------------------------------------------------------------------------

/// First and second derivatives of a Gaussian as factors along x and y. The weights of each sign
/// of a derivative add up to 1.
struct FeatureWeights {
  Weights smooth, edge, point;

  explicit FeatureWeights(double per_degree) {
    const double deviation = 0.5 * 0.082 * per_degree;
    const int reach = int(std::ceil(3 * deviation));
    double total = 0;
    for (int x = -reach; x <= reach; ++x) {
      const double g = std::exp(-x * x / (2 * deviation * deviation));
      smooth.push_back(float(g)), total += g;
      edge.push_back(float(-x * g));
      point.push_back(float((x * x / (deviation * deviation) - 1) * g));
    }
    for (float& w : smooth) w = float(w / total);
    for (Weights* weights : {&edge, &point}) {
      double plus = 0, minus = 0;
      for (const float w : *weights) (w > 0 ? plus : minus) += std::abs(double{w});
      for (float& w : *weights)
        if (w != 0) w = float(w / (w > 0 ? plus : minus));
    }
  }
};

/// Strengths of edges and of points in every pixel.
struct Features {
  Plane edges, points;
};
Features features(const Grid& grid, const Plane& grey, const FeatureWeights& weights) {
  const auto lengths = [&](const Weights& derivative) {
    const Plane across = grid.along_y(grid.along_x(grey, derivative), weights.smooth),
                down = grid.along_y(grid.along_x(grey, weights.smooth), derivative);
    Plane length(grey.size());
    for (size_t i = 0; i < length.size(); ++i) length[i] = std::hypot(across[i], down[i]);
    return length;
  };
  return {lengths(weights.edge), lengths(weights.point)};
}

/// What the difference of a picture is computed from.
struct Appearance {
  std::vector<vec3> colours;  ///< hunt_lab() after blurring
  Features features;

  Appearance(const Grid& grid, std::span<const vec3> picture, double per_degree) {
    std::array<Plane, 3> planes;
    Plane grey(picture.size());
    for (Plane& plane : planes) plane.resize(picture.size());
    for (size_t i = 0; i < picture.size(); ++i) {
      const vec3 o = opponents(clamp(picture[i], vec3(0), vec3(1)));
      for (int c = 0; c < 3; ++c) planes[size_t(c)][i] = o[c];
      grey[i] = (o.x + 16) / 116;
    }
    const std::array<const std::array<Bell, 2>*, 3> bells{&k_achromatic, &k_red_green, &k_blue_yellow};
    for (size_t c = 0; c < 3; ++c) planes[c] = blurred(grid, planes[c], *bells[c], per_degree);
    colours.resize(picture.size());
    for (size_t i = 0; i < picture.size(); ++i)
      colours[i] =
          hunt_lab(clamp(rgb_of_opponents({planes[0][i], planes[1][i], planes[2][i]}), vec3(0), vec3(1)));
    features = lucerna::film::features(grid, grey, FeatureWeights(per_degree));
  }
};

// ---- Exposures --------------------------------------------------------------------------

/// ACES curve, numerator and denominator as polynomials of x: (2.51, 0.03, 0) and (2.43, 0.59, 0.14) of 0.6
/// x.
constexpr std::array<double, 6> k_aces{0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

float aces(float x) {
  const double v = std::max(0.0f, x);
  const auto& k = k_aces;
  const double denominator = k[3] * v * v + k[4] * v + k[5];
  return std::isfinite(denominator) ? float((k[0] * v * v + k[1] * v + k[2]) / denominator) : 1.0f;
}

/// The radiance that the curve maps to 0.85.
double nearly_white() {
  constexpr double t = 0.85;
  const auto& k = k_aces;
  const double a = k[0] - t * k[3], b = k[1] - t * k[4], c = k[2] - t * k[5];
  return -b / (2 * a) + std::sqrt(b * b / (4 * a * a) - c / a);
}

}  // namespace

std::vector<float> flip(uint32_t width, std::span<const vec3> a, std::span<const vec3> b,
                        const FlipOptions& options) {
  assert(a.size() == b.size());
  if (a.empty() || width == 0) return {};
  const Grid grid{int(width), int(a.size() / width)};
  const Appearance x(grid, a, options.pixels_per_degree), y(grid, b, options.pixels_per_degree);
  std::vector<float> error(a.size());
  for (size_t i = 0; i < error.size(); ++i) {
    const float colour = colour_error(colour_distance(x.colours[i], y.colours[i]));
    // dE = dE_colour ^ (1 - dE_feature), dE_feature = (max(d edge, d point) / sqrt 2) ^ 0.5.
    const float edge = std::abs(x.features.edges[i] - y.features.edges[i]),
                point = std::abs(x.features.points[i] - y.features.points[i]);
    const float feature = std::sqrt(std::max(edge, point) / std::sqrt(2.0f));
    error[i] = std::pow(colour, 1 - std::min(feature, 1.0f));
  }
  return error;
}

std::vector<float> flip_hdr(uint32_t width, std::span<const vec3> picture, std::span<const vec3> reference,
                            const FlipOptions& options) {
  assert(picture.size() == reference.size());
  if (reference.empty() || width == 0) return {};
  std::vector<float> light(reference.size());
  for (size_t i = 0; i < light.size(); ++i) light[i] = std::max(0.0f, luminance(reference[i]));
  const float most = *std::max_element(light.begin(), light.end());
  const auto middle = light.begin() + ptrdiff_t(light.size() / 2);
  std::nth_element(light.begin(), middle, light.end());
  // A picture that is half black has no median to show.
  const float median = *middle > 0 ? *middle : most;
  const double first = most > 0 ? std::log2(nearly_white() / double{most}) : 0,
               last = most > 0 ? std::log2(nearly_white() / double{median}) : 0;
  const int count = std::max(2, int(std::ceil(last - first)));
  std::vector<float> error(reference.size());
  std::vector<vec3> a(error.size()), b(error.size());
  for (int k = 0; k < count; ++k) {
    const float factor = float(std::exp2(first + (last - first) * k / (count - 1)));
    for (size_t i = 0; i < error.size(); ++i)
      for (int c = 0; c < 3; ++c)
        a[i][c] = aces(factor * picture[i][c]), b[i][c] = aces(factor * reference[i][c]);
    const std::vector<float> shown = flip(width, a, b, options);
    for (size_t i = 0; i < error.size(); ++i) error[i] = std::max(error[i], shown[i]);
  }
  return error;
}

}  // namespace lucerna::film
