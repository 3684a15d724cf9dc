#include "upload/bsdf_table.h"

#include <cmath>
#include <deque>
#include <mutex>

#include "shaders/shared/bsdf_table.h"

namespace lucerna::upload {
namespace {

using shared::k_table_mu;
using shared::k_table_rough;
constexpr double k_tau = 6.283185307179586;

struct Vec {
  double x, y, z;
};
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec normalized(Vec v) {
  const double s = 1 / std::sqrt(dot(v, v));
  return {v.x * s, v.y * s, v.z * s};
}

double lambda(double c, double alpha) {
  const double tan2 = std::max(0.0, 1 - c * c) / std::max(c * c, 1e-30);
  return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

double fresnel(double c, double eta) {
  const double sin2 = (1 - c * c) / (eta * eta);
  if (sin2 >= 1) return 1;
  const double ct = std::sqrt(1 - sin2);
  const double p = (eta * c - ct) / (eta * c + ct), s = (c - eta * ct) / (c + eta * ct);
  return 0.5 * (p * p + s * s);
}

/// Visible normals (Heitz 2018 by spherical caps, Dupuy and Benyoub 2023), integrated with a fixed Hammersley
/// set.
template <class Integrand>
void integrate_visible(double mu, double alpha, int n, const Integrand& integrand) {
  const Vec wo{std::sqrt(std::max(0.0, 1 - mu * mu)), 0, mu};
  const Vec v = normalized({alpha * wo.x, 0, wo.z});
  for (int i = 0; i < n; ++i) {
    uint32_t bits = uint32_t(i), reversed = 0;
    for (int b = 0; b < 32; ++b) reversed = reversed << 1 | (bits >> b & 1);
    const double u = (i + 0.5) / n, w = (reversed + 0.5 * 65536) / 4294967296.0;
    const double z = (1 - w) * (1 + v.z) - v.z, s = std::sqrt(std::max(0.0, 1 - z * z));
    Vec h{s * std::cos(k_tau * u) + v.x, s * std::sin(k_tau * u), z + v.z};
    h = normalized({alpha * h.x, alpha * h.y, std::max(h.z, 1e-12)});
    const double oh = dot(wo, h);
    integrand(wo, h, oh, Vec{2 * oh * h.x - wo.x, 2 * oh * h.y - wo.y, 2 * oh * h.z - wo.z});
  }
}

double g2_over_g1(double co, double ci, double alpha) {
  const double lo = lambda(co, alpha), li = lambda(ci, alpha);
  return (1 + lo) / (1 + lo + li);
}

/// Cosine-weighted average 2 * integral of E(mu) mu dmu of a row as the shader interpolates it (linear in
/// sqrt(mu)).
double row_average(const vec4* row, int channel) {
  const int n = 4096;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n, x = std::sqrt(mu) * (k_table_mu - 1);
    const int x0 = std::min(int(x), int(k_table_mu) - 2);
    const double e = row[x0][channel] + (row[x0 + 1][channel] - row[x0][channel]) * (x - x0);
    sum += 2 * mu * e / n;
  }
  return sum;
}

constexpr int k_samples = 1024;

void schlick_table(vec4* table) {
  for (uint32_t j = 0; j < k_table_rough; ++j) {
    const double r = double(j) / (k_table_rough - 1), alpha = r * r;
    vec4* row = table + j * k_table_mu;
    for (uint32_t i = 0; i < k_table_mu; ++i) {
      const double t = double(i) / (k_table_mu - 1), mu = std::max(t * t, 1e-6);
      double a = 0, b = 0;
      if (j == 0) {
        b = std::pow(1 - mu, 5), a = 1 - b;
      } else {
        integrate_visible(mu, alpha, k_samples, [&](Vec wo, Vec, double oh, Vec wi) {
          if (wi.z <= 0) return;
          const double w = std::pow(1 - std::min(oh, 1.0), 5), g = g2_over_g1(wo.z, wi.z, alpha) / k_samples;
          a += (1 - w) * g, b += w * g;
        });
      }
      row[i] = vec4(float(a), float(b), 0, 0);
    }
    const float a = float(row_average(row, 0)), b = float(row_average(row, 1));
    for (uint32_t i = 0; i < k_table_mu; ++i) row[i].z = a, row[i].w = b;
  }
}

void glass_table(vec4* table, double eta) {
  for (uint32_t j = 0; j < k_table_rough; ++j) {
    const double r = double(j) / (k_table_rough - 1), alpha = r * r;
    vec4* row = table + j * k_table_mu;
    for (uint32_t i = 0; i < k_table_mu; ++i) {
      const double t = double(i) / (k_table_mu - 1), mu = std::max(t * t, 1e-6);
      // On a smooth surface all facets are parallel to it: F is reflected, 1 - F transmitted.
      double e = j == 0 ? 1 : 0, e_0 = 0, e_1 = 0;
      if (j > 0) {
        integrate_visible(mu, alpha, k_samples, [&](Vec wo, Vec h, double oh, Vec wi) {
          const double f = fresnel(std::min(oh, 1.0), eta);
          if (wi.z > 0) {
            const double g = g2_over_g1(wo.z, wi.z, alpha) / k_samples;
            e += f * g;
            if (f < 1) e_0 += g, e_1 += f * g;
          }
          if (f < 1) {
            const double ct = std::sqrt(1 - (1 - oh * oh) / (eta * eta));
            const double z = -wo.z / eta + (oh / eta - ct) * h.z;
            if (z < 0) {
              const double g = g2_over_g1(wo.z, -z, alpha) / k_samples;
              e += (1 - f) * g, e_0 -= g, e_1 -= f * g;
            }
          }
        });
      }
      row[i] = vec4(float(std::min(e, 1.0)), float(e_0), float(e_1), 0);
    }
  }
}

constexpr uint32_t k_points = k_table_mu * k_table_rough, k_columns = k_table_mu - 1,
                   k_rows = k_table_rough - 1;
static_assert(shared::k_table_cells == k_columns * k_rows);
static_assert(shared::k_table_schlick_texels == 2 * shared::k_table_cells + k_rows);
static_assert(shared::k_table_glass_block == shared::k_table_cells + k_rows);
static_assert(shared::k_table_glass_texels == 3 * shared::k_table_glass_block);
static_assert(shared::k_table_first_glass == shared::k_table_schlick_texels + shared::k_table_glass_block);

/// Directional albedo of a white sheen (shaders/lib/sheen.glsl), by a product rule over the hemisphere.
void sheen_table(vec4* table) {
  const auto fit = [](double x, double share) {
    const auto mix = [share](double a, double b) { return a + (b - a) * share; };
    return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
           mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
  };
  const auto hidden = [&](double c, double alpha) {
    const double share = (1 - alpha) * (1 - alpha);
    return c < 0.5 ? std::exp(fit(c, share)) : std::exp(2 * fit(0.5, share) - fit(1 - c, share));
  };
  constexpr int k_heights = 48, k_turns = 24;
  for (uint32_t j = 0; j < k_table_rough; ++j) {
    const double r = std::max(double(j) / (k_table_rough - 1), double(shared::k_least_sheen_roughness)),
                 alpha = r * r;
    vec4* row = table + j * k_table_mu;
    for (uint32_t i = 0; i < k_table_mu; ++i) {
      const double t = double(i) / (k_table_mu - 1), mu = std::max(t * t, 1e-4);
      const Vec wo{std::sqrt(1 - mu * mu), 0, mu};
      double sum = 0;
      for (int a = 0; a < k_heights; ++a)
        for (int b = 0; b < k_turns; ++b) {
          const double z = (a + 0.5) / k_heights, s = std::sqrt(1 - z * z);
          const double turn = k_tau / 2 * (b + 0.5) / k_turns;  // the other half is alike
          const Vec wi{s * std::cos(turn), s * std::sin(turn), z};
          const Vec h = normalized({wo.x + wi.x, wi.y, wo.z + wi.z});
          const double d =
              (2 + 1 / alpha) * std::pow(std::max(h.x * h.x + h.y * h.y, 1e-12), 0.5 / alpha) / k_tau;
          sum += d / ((1 + hidden(mu, alpha) + hidden(z, alpha)) * 4 * mu);
        }
      row[i] = vec4(float(sum * k_tau / (k_heights * k_turns)), 0, 0, 0);
    }
  }
}

void append_schlick(const vec4* points, std::vector<vec4>& out) {
  for (uint32_t j = 0; j < k_rows; ++j)
    for (uint32_t i = 0; i < k_columns; ++i)
      for (const vec4* row : {points + j * k_table_mu, points + (j + 1) * k_table_mu})
        out.push_back(vec4(row[i].x, row[i].y, row[i + 1].x, row[i + 1].y));
  for (uint32_t j = 0; j < k_rows; ++j) {
    const vec4 &a = points[j * k_table_mu], &b = points[(j + 1) * k_table_mu];
    out.push_back(vec4(a.z, a.w, b.z, b.w));
  }
}

void append_glass(const vec4* points, int k, std::vector<vec4>& out) {
  for (uint32_t j = 0; j < k_rows; ++j)
    for (uint32_t i = 0; i < k_columns; ++i) {
      const vec4 *low = points + j * k_table_mu + i, *high = low + k_table_mu;
      out.push_back(vec4(low[0][k], low[1][k], high[0][k], high[1][k]));
    }
  for (uint32_t j = 0; j < k_rows; ++j) {
    const vec4* low = points + j * k_table_mu;
    out.push_back(vec4(row_average(low, k), row_average(low + k_table_mu, k), 0, 0));
  }
}

/// Both sides of a glass surface, in the layout of build_bsdf_tables().
std::vector<vec4> glass_tables(float ior) {
  std::vector<vec4> tables, points(k_points);
  for (const double eta : {double(ior), 1.0 / ior}) {
    glass_table(points.data(), eta);
    for (int k = 0; k < 3; ++k) append_glass(points.data(), k, tables);
  }
  return tables;
}

/// Likewise, cached for later scenes: each takes a tenth of a second, and most glass is equal.
std::vector<vec4> kept_glass_tables(float ior) {
  constexpr size_t k_kept = 64;
  static std::mutex mutex;
  static std::deque<std::pair<float, std::vector<vec4>>> kept;
  const std::lock_guard lock(mutex);
  for (const auto& [of, tables] : kept)
    if (of == ior) return tables;
  if (kept.size() == k_kept) kept.pop_front();
  return kept.emplace_back(ior, glass_tables(ior)).second;
}

const std::vector<vec4>& kept_schlick_tables() {
  static const std::vector<vec4> tables = [] {
    std::vector<vec4> made, points(k_points);
    schlick_table(points.data());
    append_schlick(points.data(), made);
    return made;
  }();
  return tables;
}

const std::vector<vec4>& kept_sheen_table() {
  static const std::vector<vec4> table = [] {
    std::vector<vec4> made, points(k_points);
    sheen_table(points.data());
    append_glass(points.data(), 0, made);
    return made;
  }();
  return table;
}

}  // namespace

std::vector<vec4> build_bsdf_tables(std::span<const float> glass_iors, bool sheen) {
  std::vector<vec4> tables = kept_schlick_tables();
  if (sheen) tables.insert(tables.end(), kept_sheen_table().begin(), kept_sheen_table().end());
  tables.resize(shared::k_table_first_glass);
  for (const float ior : glass_iors) {
    const std::vector<vec4> glass = kept_glass_tables(ior);
    tables.insert(tables.end(), glass.begin(), glass.end());
  }
  return tables;
}

}  // namespace lucerna::upload
