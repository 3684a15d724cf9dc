#include "transport/aim.h"

#include <algorithm>
#include <cmath>

namespace lucerna::transport {

namespace {

constexpr double k_floor = 0.1, k_found_floor = 0.3;
constexpr double k_most_unaimed = 0.9;
constexpr double k_by_power = 0.2, k_light_found_floor = 0.2;

}  // namespace

std::vector<double> aim_shares(std::span<const double> contribution, double least_unaimed) {
  std::vector<double> shares(contribution.size(), 0.0);
  const size_t pairs = contribution.size() - 1;
  double roots = 0;
  size_t found = 0;
  for (size_t i = 1; i < contribution.size(); ++i)
    roots += std::sqrt(contribution[i]), found += contribution[i] > 0 ? 1 : 0;
  const double unaimed_root = std::sqrt(contribution[0]);
  const double wanted = roots > 0 ? unaimed_root / (unaimed_root + roots) : 1;
  const double unaimed = pairs == 0 ? 1 : std::clamp(wanted, least_unaimed, k_most_unaimed);
  shares[0] = unaimed;
  double sum = 0;
  for (size_t i = 1; i < contribution.size(); ++i) {
    shares[i] = k_floor / double(pairs);
    if (contribution[i] > 0)
      shares[i] +=
          k_found_floor / double(found) + (1 - k_floor - k_found_floor) * std::sqrt(contribution[i]) / roots;
    sum += shares[i];
  }
  for (size_t i = 1; i < contribution.size(); ++i) shares[i] *= (1 - unaimed) / sum;
  return shares;
}

std::vector<double> light_weights(std::span<const std::vector<uint32_t>> groups,
                                  std::span<const double> power, std::span<const double> contribution) {
  const auto n = double(groups.size());
  std::vector<double> powers, contributions;
  double all_power = 0, roots = 0, found = 0;
  for (const std::vector<uint32_t>& group : groups) {
    double p = 0, w = 0;
    for (const uint32_t entry : group) p += power[entry], w += contribution.empty() ? 0 : contribution[entry];
    powers.push_back(p), contributions.push_back(w);
    all_power += p, roots += std::sqrt(w), found += w > 0 ? 1 : 0;
  }
  const bool known = roots > 0;
  const double by_power = known ? k_by_power : 0.5, even = known ? k_floor : 0.5;
  std::vector<double> weights(power.size(), 0.0);
  for (size_t g = 0; g < groups.size(); ++g) {
    double share = by_power * powers[g] / all_power + even / n;
    if (known && contributions[g] > 0)
      share += k_light_found_floor / found +
               (1 - k_by_power - k_floor - k_light_found_floor) * std::sqrt(contributions[g]) / roots;
    for (const uint32_t entry : groups[g]) weights[entry] = share * power[entry] / powers[g];
  }
  return weights;
}

bool same_view(const shared::Frame& a, const shared::Frame& b) {
  return a.camera_origin == b.camera_origin && a.camera_right == b.camera_right &&
         a.camera_up == b.camera_up && a.camera_forward == b.camera_forward && a.projection == b.projection &&
         a.lens_radius == b.lens_radius && a.focus_distance == b.focus_distance &&
         a.lens_blades == b.lens_blades && a.lens_rotation == b.lens_rotation &&
         a.section_normal == b.section_normal && a.section_offset == b.section_offset && a.width == b.width &&
         a.height == b.height && a.seed == b.seed;
}

}  // namespace lucerna::transport
