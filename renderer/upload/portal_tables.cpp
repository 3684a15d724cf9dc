#include "upload/portal_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "shaders/shared/portals.h"
#include "upload/environment_map.h"

namespace lucerna::upload {

using namespace shared;

namespace {

constexpr uint32_t k_most_width = 1024;  // of the map that is sampled
constexpr double k_pi_d = std::numbers::pi;

/// The sky's sampling density, by texel, with neighbours averaged if there are many.
class Sky {
 public:
  Sky(const scene::Scene& scene, const EnvironmentTables& tables)
      : rotation_(scene.environment.rotation * k_pi / 180) {
    const EnvironmentMap map(scene);
    const uint32_t factor = (map.width + k_most_width - 1) / k_most_width;
    w_ = (map.width + factor - 1) / factor, h_ = (map.height + factor - 1) / factor;
    values_.resize(size_t(w_) * h_);
    for (uint32_t y = 0; y < h_; ++y)
      for (uint32_t x = 0; x < w_; ++x) {
        double sum = 0, weights = 0;
        for (uint32_t row = y * factor; row < std::min((y + 1) * factor, map.height); ++row) {
          const double band = std::sin(k_pi_d * (row + 0.5) / map.height);
          for (uint32_t column = x * factor; column < std::min((x + 1) * factor, map.width); ++column)
            sum += band * std::abs(double(tables.density[size_t(row) * map.width + column])), weights += band;
        }
        values_[size_t(y) * w_ + x] = float(sum / weights);
      }
    u_scale_ = float(map.width) / float(factor * w_), v_scale_ = float(map.height) / float(factor * h_);
  }
  /// Along a side of a texel of a portal's map: enough to find every texel of the sky.
  uint32_t points() const { return w_ > k_portal_side ? 2 : 1; }
  double density(const vec3& d) const {
    if (values_.size() == 1) return double(values_[0]);
    const float u = 0.5f + (std::atan2(d.z, d.x) + rotation_) / (2 * k_pi);
    const float v = std::acos(std::clamp(d.y, -1.f, 1.f)) / k_pi;
    const auto x = uint32_t((u - std::floor(u)) * u_scale_ * float(w_)),
               y = uint32_t(v * v_scale_ * float(h_));
    return double(values_[size_t(std::min(y, h_ - 1)) * w_ + std::min(x, w_ - 1)]);
  }

 private:
  float rotation_, u_scale_, v_scale_;
  uint32_t w_, h_;
  std::vector<float> values_;
};

/// X of the map's coordinate, 0 ... k_portal_side.
double plane_of(double at) {
  const double m = 2 * at / k_portal_side - 1;
  return std::abs(m) < 1 ? m / (1 - std::abs(m)) : std::copysign(std::numeric_limits<double>::infinity(), m);
}

/// Solid angles of a map's texels: differences of that of the quadrant below and left of (X, Y), which is
/// atan(XY / sqrt(1 + X^2 + Y^2)) but for a constant.
std::vector<double> solid_angles() {
  constexpr uint32_t n = k_portal_side;
  std::vector<double> sines(n + 1), angles(size_t(n) * n);
  for (uint32_t i = 0; i <= n; ++i) sines[i] = std::sin(std::atan(plane_of(i)));
  const auto corner = [&](uint32_t x, uint32_t y) { return std::asin(sines[x] * sines[y]); };
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x)
      angles[size_t(y) * n + x] = corner(x + 1, y + 1) - corner(x, y + 1) - corner(x + 1, y) + corner(x, y);
  return angles;
}

/// Weights of a portal's texels, and the flux through it over its area.
struct Map {
  std::vector<double> weights;
  double flux = 0;
};
Map map_of(const scene::Portal& portal, const Sky& sky, const std::vector<double>& solid_angles) {
  constexpr uint32_t n = k_portal_side;
  const glm::dvec3 s(glm::normalize(portal.half_width)), t(glm::normalize(portal.half_height)),
      out(-normal_of(portal));
  const uint32_t points = sky.points();
  std::vector<double> along(size_t(n) * points);
  for (size_t i = 0; i < along.size(); ++i) along[i] = plane_of((double(i) + 0.5) / points);
  Map map;
  map.weights.resize(size_t(n) * n);
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      double density = 0, cosine = 0;
      for (uint32_t j = 0; j < points; ++j)
        for (uint32_t i = 0; i < points; ++i) {
          const double a = along[x * points + i], b = along[y * points + j];
          const double height = 1 / std::sqrt(1 + a * a + b * b);
          density += sky.density(vec3(height * (a * s + b * t + out))), cosine += height;
        }
      const double weight = density / (points * points) * solid_angles[size_t(y) * n + x];
      map.weights[size_t(y) * n + x] = weight;
      map.flux += weight * cosine / (points * points);
    }
  return map;
}

/// Appends the summed-area table of these weights as integers, of which each weight above 0 gets one.
void append_sums(const std::vector<double>& weights, std::vector<uint32_t>& to) {
  constexpr uint32_t n = k_portal_side;
  const size_t first = to.size();
  to.resize(first + k_portal_words, 0);
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(all > 0)) return;
  const double scale = (0x1p32 - 2.0 * n * n) / all;
  for (uint32_t y = 0; y < n; ++y) {
    uint32_t row = 0;
    for (uint32_t x = 0; x < n; ++x) {
      const double w = weights[size_t(y) * n + x];
      if (w > 0) row += std::max(1u, uint32_t(w * scale));
      to[first + size_t(y + 1) * (n + 1) + x + 1] = to[first + size_t(y) * (n + 1) + x + 1] + row;
    }
  }
}

}  // namespace

PortalTables portal_tables(const scene::Scene& scene, const EnvironmentTables& environment,
                           const PortalTables& before) {
  PortalTables to;
  to.of = scene.portals, to.density = environment.density, to.rotation = double(scene.environment.rotation);
  if (before.of == to.of && before.density.shares_with(to.density) && before.rotation == to.rotation)
    return before;
  if (to.of.empty() || !(environment.sky_weight > 0)) return to;
  const Sky sky(scene, environment);
  const std::vector<double> angles = solid_angles();
  std::vector<uint32_t> sums;
  double total = 0;
  for (const scene::Portal& portal : to.of) {
    const Map map = map_of(portal, sky, angles);
    to.shares.push_back(map.flux * double(area_of(portal)));
    total += to.shares.back();
    append_sums(map.weights, sums);
  }
  if (!(total > 0)) {
    to.shares.clear();
    return to;
  }
  for (size_t i = 0; i < to.of.size(); ++i) {
    const scene::Portal& portal = to.of[i];
    to.shares[i] /= total;
    to.portals.emplace_back(portal.centre, glm::length(portal.half_width));
    to.portals.emplace_back(glm::normalize(portal.half_width), glm::length(portal.half_height));
    to.portals.emplace_back(glm::normalize(portal.half_height), float(to.shares[i]));
  }
  to.sums = std::move(sums);
  return to;
}

}  // namespace lucerna::upload
