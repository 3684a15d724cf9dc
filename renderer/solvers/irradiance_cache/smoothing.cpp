#include "solvers/irradiance_cache/smoothing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nanoflann.hpp>
#include <optional>
#include <utility>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr size_t k_light_texels = size_t{k_part_count} * k_part_texels;

/// What smoothing needs of a record.
struct Site {
  vec3 position, normal, tangent, bitangent;
  float radius = 0;            ///< lesser one [m]; 0: neither smoothed nor a neighbour
  float share = 0;             ///< share of its disc that it represents, 0..1
  float weight = 0;            ///< rays, times the share of its disc that it represents
  double area = 0;             ///< that it represents, up to a factor [m^2]; in double: large squares
  float light = 0, error = 0;  ///< luminance of all parts, and its standard error
  uint32_t medium = 0;
};

Site site_of(const RawRecords& raw, uint32_t r) {
  /// Least share of its disc that a record represents.
  constexpr float k_least_share = 0.01f;
  const vec4* const place = &raw.places[size_t{r} * k_record_texels];
  const vec4* const light = &raw.lights[r * k_light_texels];
  Site s{.position = vec3(place[0]), .normal = vec3(place[1]), .tangent = {}, .bitangent = {}};
  const auto [t, b] = tangent_basis(s.normal);
  s.tangent = t, s.bitangent = b;
  s.error = place[2].z;
  const float radius = place[3].w, rays = float(std::bit_cast<uint32_t>(place[2].x));
  if (raw.crowded(r) || radius <= 0 || place[0].w <= 0 || rays <= 0) return s;
  s.radius = radius;
  s.share = std::clamp(place[2].y / radius, k_least_share, 1.0f);
  s.weight = rays * s.share;
  s.area = double{radius} * double{radius} * double{s.share};
  s.medium = std::bit_cast<uint32_t>(place[5].x);
  for (uint32_t p = 0; p < k_part_count; ++p) s.light += luminance(vec3(light[p * k_part_texels]));
  return s;
}

/// The positions of all sites, as nanoflann reads them.
struct Positions {
  const std::vector<Site>& sites;
  size_t kdtree_get_point_count() const { return sites.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return sites[i].position[int(axis)]; }
  template <class Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Positions>, Positions, 3,
                                                 uint32_t>;

struct Neighbour {
  uint32_t record = 0;
  vec2 at{0};        ///< in the tangent plane of the smoothed record, over the reach
  float weight = 0;  ///< in the fit; afterwards, of its light: the sum is 1
};

/// Neighbours of a record, itself among them.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<Site>& sites, const SmoothingOptions& options)
      : sites_(sites), options_(options), positions_{sites} {
    if (options.reach > 0) tree_.emplace(3, positions_);
  }

  /// Valid until the next call.
  std::vector<Neighbour>& of(uint32_t record) {
    const Site& own = sites_[record];
    const float reach = options_.reach * own.radius;
    list_.clear(), found_.clear();
    if (reach > 0) tree_->radiusSearch(&own.position.x, reach * reach, found_, {});
    for (const auto& [index, square] : found_)
      if (serves(sites_[index], own)) {
        const vec3 away = sites_[index].position - own.position;
        list_.push_back({index, vec2(dot(away, own.tangent), dot(away, own.bitangent)) / reach,
                         likeness(sites_[index], own) * (1 - std::sqrt(square) / reach)});
      }
    if (list_.size() < 2) list_.assign(1, {record, vec2(0), 1});
    return list_;
  }

 private:
  bool serves(const Site& s, const Site& own) const {
    return s.radius > 0 && s.medium == own.medium &&
           1 - dot(s.normal, own.normal) <= options_.normal_tolerance &&
           std::abs(dot(s.position - own.position, s.normal + own.normal)) <=
               2 * options_.off_plane * own.radius;
  }
  /// Weight by what the two records' light and errors say: near 1 up to three standard errors of their
  /// difference, in root mean squares of both errors. What the own record does not represent may differ by as
  /// much as the light.
  static float likeness(const Site& s, const Site& own) {
    constexpr double k_errors = 3;
    // In double: squares of the brightest light would overflow.
    const double a = double{s.error}, b = double{own.error}, from = double{s.light} - double{own.light};
    const double unknown = (1 - double{own.share}) * double{std::max(s.light, own.light)} / k_errors;
    const double square = (a * a + b * b) / 2 + unknown * unknown;
    if (from == 0) return s.weight;
    return square > 0 ? s.weight * float(std::exp(-from * from / (2 * k_errors * k_errors * square))) : 0.0f;
  }

  const std::vector<Site>& sites_;
  SmoothingOptions options_;
  Positions positions_;
  std::optional<Tree> tree_;  ///< none without a reach
  std::vector<std::pair<uint32_t, float>> found_;
  std::vector<Neighbour> list_;
};

/// Turns the weights of the fit into those of the light: the first row of the inverse of its normal
/// equations, without negative weights.
void fit_plane(std::vector<Neighbour>& list) {
  /// A mild prior of no slope, over the weights, for neighbours along a line.
  constexpr double k_prior = 0.02;
  double s = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
  for (const Neighbour& n : list) {
    const double w = n.weight, x = n.at.x, y = n.at.y;
    s += w, u += w * x, v += w * y, uu += w * x * x, uv += w * x * y, vv += w * y * y;
  }
  uu += k_prior * s, vv += k_prior * s;
  const double one = uu * vv - uv * uv, by_x = uv * v - u * vv, by_y = u * uv - uu * v;
  double sum = 0;
  for (Neighbour& n : list) {
    n.weight *= float(std::max(0.0, one + by_x * n.at.x + by_y * n.at.y) / one);
    sum += n.weight;
  }
  for (Neighbour& n : list) n.weight = float(n.weight / sum);
}

/// Random signs of a record's errors, a bit for each lane, independent between records: lowbias32 (C.
/// Wellons, "Prospecting for hash functions", 2018).
uint32_t error_signs(uint32_t record) {
  uint32_t x = record + 0x9e3779b9u;
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

void mix_errors(const std::vector<Site>& sites, const std::vector<Neighbour>& list, float* lanes) {
  for (const Neighbour& n : list) {
    const uint32_t signs = error_signs(n.record);
    for (uint32_t lane = 0; lane < k_lookup_lanes; ++lane)
      lanes[lane] += n.weight * sites[n.record].error * (signs >> lane & 1 ? -1.0f : 1.0f);
  }
}

/// Value and rotational gradient of a part (k_part_texels).
void mix_part(const RawRecords& raw, const std::vector<Site>& sites, const Site& own,
              const std::vector<Neighbour>& list, uint32_t part, float* to) {
  std::fill_n(to, 9, 0.0f);
  for (const Neighbour& n : list) {
    const float* const from = &raw.lights[n.record * k_light_texels + part * k_part_texels].x;
    const Site& s = sites[n.record];
    const vec3 t = n.weight * s.tangent, b = n.weight * s.bitangent;
    for (int c = 0; c < 3; ++c) {
      to[c] += n.weight * from[c];
      to[3 + c] += dot(t, own.tangent) * from[3 + c] + dot(b, own.tangent) * from[6 + c];
      to[6 + c] += dot(t, own.bitangent) * from[3 + c] + dot(b, own.bitangent) * from[6 + c];
    }
  }
}

/// Light of a record that groups share.
vec3 shared_light(const RawRecords& raw, uint32_t record) {
  vec3 all(0);
  for (uint32_t p = k_part_direct + 1; p < k_part_count; ++p)
    all += vec3(raw.lights[record * k_light_texels + p * k_part_texels]);
  return all;
}

void mix_shares(const RawRecords& raw, const std::vector<Neighbour>& list, std::span<uvec4> to) {
  vec3 all(0);
  for (const Neighbour& n : list) all += n.weight * shared_light(raw, n.record);
  for (size_t t = 0; t < to.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      vec3 light(0);
      for (const Neighbour& n : list)
        light +=
            n.weight * share_unpack(raw.groups[n.record * to.size() + t][i]) * shared_light(raw, n.record);
      for (int c = 0; c < 3; ++c) light[c] = all[c] > 0 ? light[c] / all[c] : 0.0f;
      to[t][i] = share_pack(light);
    }
}

/// Each record's neighbours with their weights in its fit.
class Fits {
 public:
  Fits(const std::vector<Site>& sites, const SmoothingOptions& options)
      : sites_(sites), gains_(sites.size(), 1.0f) {
    Neighbourhood neighbourhood(sites, options);
    for (uint32_t r = 0; r < sites.size(); ++r) {
      const std::vector<Neighbour>& found = neighbourhood.of(r);
      neighbours_.insert(neighbours_.end(), found.begin(), found.end());
      ends_.push_back(neighbours_.size());
    }
  }

  /// Weights of the light that a record reads; valid until the next call.
  const std::vector<Neighbour>& of(uint32_t record) {
    const size_t first = record > 0 ? ends_[record - 1] : 0;
    list_.assign(neighbours_.begin() + ptrdiff_t(first), neighbours_.begin() + ptrdiff_t(ends_[record]));
    if (list_.size() < 2) return list_;
    for (Neighbour& n : list_) n.weight *= gains_[n.record];
    fit_plane(list_);
    return list_;
  }

  /// Scales the records' weights until each is read by as much area as it represents.
  void balance() {
    /// Without any, 2.6 % of the light of the unit test's sparse records is lost; after 4 it is .2 %.
    constexpr int k_rounds = 4;
    /// Largest scale: a record that hardly any fit admits does not get all of one. A record that represents
    /// only a part of its disc gets none: that others reject its light is wanted (likeness()).
    constexpr float k_most = 4;
    for (int round = 0; round < k_rounds; ++round) {
      std::vector<double> read(sites_.size(), 0.0);
      for (uint32_t r = 0; r < sites_.size(); ++r)
        for (const Neighbour& n : of(r)) read[n.record] += sites_[r].area * double{n.weight};
      for (uint32_t r = 0; r < sites_.size(); ++r)
        if (read[r] > 0)
          gains_[r] = std::clamp(gains_[r] * float(sites_[r].area / read[r]), 1 / k_most,
                                 sites_[r].share < 1 ? 1 : k_most);
    }
  }

 private:
  const std::vector<Site>& sites_;
  std::vector<float> gains_;  // of each record's weight in all fits
  std::vector<Neighbour> neighbours_, list_;
  std::vector<size_t> ends_;  // of each record's neighbours
};

}  // namespace

PublishedLight smooth(const RawRecords& raw, const SmoothingOptions& options) {
  const uint32_t count = raw.size();
  const size_t group_texels = count > 0 ? raw.groups.size() / count : 0;
  std::vector<Site> sites;
  for (uint32_t r = 0; r < count; ++r) sites.push_back(site_of(raw, r));
  Fits fits(sites, options);
  fits.balance();
  PublishedLight out{raw.lights, raw.groups, std::vector<float>(size_t{count} * k_lookup_lanes)};
  for (uint32_t r = 0; r < count; ++r) {
    const std::vector<Neighbour>& list = fits.of(r);
    mix_errors(sites, list, &out.errors[size_t{r} * k_lookup_lanes]);
    if (list.size() == 1) continue;
    for (uint32_t p = 0; p < k_part_count; ++p)
      mix_part(raw, sites, sites[r], list, p, &out.lights[r * k_light_texels + p * k_part_texels].x);
    mix_shares(raw, list, std::span(out.groups).subspan(r * group_texels, group_texels));
  }
  return out;
}

}  // namespace lucerna::irradiance_cache
