#include "solvers/photons/efficiency.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "base/math.h"

namespace lucerna::photons {

using namespace shared;

namespace {

constexpr uint32_t k_region = 2;  // pixels of the pilot's picture, per side
// Mean number of photons per lookup of a region from which their estimate is used.
constexpr double k_least_found = 4;
constexpr double k_least_found_in_all = 256;  // ... and in the whole picture
// Share of the caustics' light in such regions from which photons may compute the others, too: 0.5 in `glass`
// and `ring`, at most 0.08 where light is too rare for the pilot; and how far they must be ahead.
constexpr double k_well_found = 0.25, k_clearly = 2;
constexpr uint32_t k_most_steps = 32;  // iterations of the optimization

double radius_at(const PhotonFrame& f, const vec3& x) {
  return double(photon_radius_of(f.base + f.slope * glm::distance(x, f.eye), f.most, x));
}

/// Photons by cubes at least as wide as the search radius.
class Cubes {
 public:
  Cubes(std::span<const PhotonContribution> photons, double width) : width_(width) {
    for (const PhotonContribution& p : photons)
      if (p.flux > 0) cubes_[key(cube_of(p.position))].push_back(&p);
  }
  template <class F>
  void near(const vec3& x, F&& f) const {
    const glm::ivec3 at = cube_of(x);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (const auto found = cubes_.find(key(at + glm::ivec3(dx, dy, dz))); found != cubes_.end())
            for (const PhotonContribution* p : found->second) f(*p);
  }

 private:
  glm::ivec3 cube_of(const vec3& x) const { return glm::ivec3(glm::floor(glm::dvec3(x) / width_)); }
  static uint64_t key(const glm::ivec3& c) {
    constexpr uint64_t k_mask = (1u << 21) - 1;
    return (uint64_t(uint32_t(c.x)) & k_mask) << 42 | (uint64_t(uint32_t(c.y)) & k_mask) << 21 |
           (uint64_t(uint32_t(c.z)) & k_mask);
  }
  double width_;
  std::unordered_map<uint64_t, std::vector<const PhotonContribution*>> cubes_;
};

}  // namespace

std::vector<Moments> caustic_moments(const EfficiencyPilot& pilot) {
  std::vector<Moments> all(pilot.lookups.size());
  std::map<int, Cubes> levels;  // by the power of two of the radius
  for (size_t i = 0; i < all.size(); ++i) {
    const PhotonLookup& l = pilot.lookups[i];
    if (l.carried <= 0) continue;
    const double around = radius_at(pilot.around, l.position), within = radius_at(pilot.round, l.position);
    const vec3 side = facet_unpack(l.facet);
    double flux = 0, squares = 0, met = 0;  // sums over photons: flux, flux^2, flux times radiance
    Moments& m = all[i];
    const int level = std::ilogb(around) + 1;
    const auto cubes = levels.try_emplace(level, pilot.photons, std::ldexp(1.0, level)).first;
    cubes->second.near(l.position, [&](const PhotonContribution& p) {
      if (p.unreachable != 0) return;  // computed by photons in any case
      const glm::dvec3 away = glm::dvec3(p.position) - glm::dvec3(l.position);
      if (glm::dot(away, away) >= around * around) return;
      if (std::abs(glm::dot(away, glm::dvec3(side))) >= double(k_photon_slab) * around) return;
      if (glm::dot(facet_unpack(p.facet), side) <= k_photon_normals) return;
      const auto f = double(p.flux);
      flux += f, squares += f * f / pilot.gain[size_t(&p - pilot.photons.data())],
          met += f * double(p.radiance);
      ++m.found;
    });
    // f_D = albedo / pi. A photon of the rounds is weighted by Epanechnikov's kernel, whose square has the
    // integral 4 / (3 pi r^2); an eye path has the density cos / pi and contributes albedo times radiance.
    const double area = double(k_pi) * around * around, carried = double(l.carried);
    const double lambert = carried / double(k_pi);
    m.mean = lambert * flux / area;
    m.photons = lambert * lambert * squares / (area * pilot.paths) * 4 / (3 * double(k_pi) * within * within);
    m.paths = std::max(0.0, carried * lambert * met / area - m.mean * m.mean);
  }
  return all;
}

Regions choose_regions(std::span<const Moments> moments, uint32_t width, uint32_t height,
                       const EfficiencyCosts& costs) {
  Regions out;
  out.width = (width + k_region - 1) / k_region, out.height = (height + k_region - 1) / k_region;
  const auto w = int(out.width), h = int(out.height);
  const auto at = [&](int x, int y) { return size_t(y * w + x); };
  std::vector<double> pixels(size_t(w * h), 0);
  std::vector<Region> plain(size_t(w * h));
  std::vector<Region>& all = out.all;
  all.resize(plain.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const Moments& m = moments[y * width + x];
      Region& r = plain[at(int(x / k_region), int(y / k_region))];
      r.mean += m.mean, r.photons += m.photons, r.paths += m.paths, r.found += m.found;
      ++pixels[at(int(x / k_region), int(y / k_region))];
    }
  const auto around = [&](int x, int y, auto&& f) {
    for (int v = std::max(0, y - 1); v <= std::min(h - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(w - 1, x + 1); ++u) f(at(u, v));
  };
  double mean = 0, found = 0;
  for (const Region& r : plain) found += r.found;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      Region& r = all[at(x, y)];
      double n = 0;
      around(x, y, [&](size_t k) {
        r.mean += plain[k].mean, r.photons += plain[k].photons, r.paths += plain[k].paths;
        r.found += plain[k].found, n += pixels[k];
      });
      r.mean /= n, r.photons /= n, r.paths /= n, r.found /= n;
      mean += r.mean;
    }
  const auto regions = double(all.size());
  mean /= regions;
  for (Region& r : all) r.weight = mean > 0 ? 1 / (r.mean * r.mean + mean * mean) : 0;

  // Noise times cost of the whole picture for a choice per region. Costs are per region of one pixel; light
  // paths are shared by all regions, and not traced at all if no region uses them.
  const double base = costs.base, looked = costs.lookup, onward = costs.onward;
  struct Whole {
    double noise = 0, cost = 0;
    double product() const { return noise * cost; }
  };
  const auto whole = [&](const std::vector<bool>& delegated) {
    Whole sum;
    bool any = false;
    for (size_t i = 0; i < all.size(); ++i) {
      sum.noise += all[i].weight * (delegated[i] ? all[i].paths : all[i].photons);
      sum.cost += base + (delegated[i] ? onward : looked);
      any = any || !delegated[i];
    }
    if (any) sum.cost += costs.paths * regions;
    return sum;
  };
  const Whole photons = whole(std::vector<bool>(all.size(), false));
  out.delegated.assign(all.size(), 0.0f);
  // Few photons arrive where little light does, and are noisy there; light that is too rare for the pilot
  // would be as rare in rounds. So paths compute these regions: they find all of this light (Moments).
  std::vector<bool> delegated(all.size());
  for (size_t i = 0; i < all.size(); ++i) delegated[i] = all[i].found < k_least_found;
  // Photons reach beyond their region: remove outliers from the choice.
  const auto spread = [&](const std::vector<bool>& of) {
    std::vector<bool> result(of);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        if (!of[at(x, y)]) around(x, y, [&](size_t k) { result[k] = false; });
    return result;
  };
  std::vector<bool> best = spread(delegated);
  // At the optimum, each region uses the technique that adds less to noise and cost, relatively.
  Whole now = whole(delegated);
  for (uint32_t step = 0; step < k_most_steps; ++step) {
    std::vector<bool> better(all.size());
    for (size_t i = 0; i < all.size(); ++i) {
      const Region& r = all[i];
      better[i] = r.found < k_least_found || r.weight * r.paths / now.noise + onward / now.cost <
                                                 r.weight * r.photons / now.noise + looked / now.cost;
    }
    const Whole then = whole(better);
    if (better == delegated || !(then.product() < now.product())) break;
    delegated = better, now = then;
  }
  const std::vector<bool> none(all.size(), true), mixed_delegated = spread(delegated);
  const Whole mixed = whole(mixed_delegated), paths = whole(none);
  double least = whole(best).product();
  if (mixed.product() < least) best = mixed_delegated, least = mixed.product();
  if (found >= k_least_found_in_all && paths.product() < least) best = none, least = paths.product();
  // Where the pilot finds most of the light, the rest is faint and often the noisiest light of eye paths, so
  // delegating it would leave their noise and add the photons' cost.
  double light = 0, well_found = 0;
  for (const Region& r : all) light += r.mean, well_found += r.found >= k_least_found ? r.mean : 0;
  if (well_found > 0 && well_found >= k_well_found * light && k_clearly * photons.product() < least)
    best.assign(all.size(), false), least = photons.product();
  for (size_t i = 0; i < out.delegated.size(); ++i) out.delegated[i] = best[i] ? 1 : 0;
  const auto by_photons = std::count(best.begin(), best.end(), false);
  out.by_photons = double(by_photons) / regions;
  out.nowhere = by_photons == 0;
  out.scarce = found < k_least_found_in_all;
  out.gain = least > 0 ? photons.product() / least : 1;
  return out;
}

}  // namespace lucerna::photons
