// links: photons
// Where photons are more efficient for caustics: both methods' moments compared with closed forms, and the
// choice.
#include <catch2/catch.hpp>
#include <random>

#include "base/math.h"
#include "solvers/photons/efficiency.h"

namespace photons_efficiency_tests {

using namespace lucerna;
using photons::Moments, photons::Regions, photons::EfficiencyCosts, photons::EfficiencyPilot;

namespace {

/// Photons of equal flux, evenly distributed over a square of the plane y = 0 with side 2 around the origin,
/// arriving from above.
std::vector<shared::PhotonContribution> even(uint32_t n, float flux, float radiance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<shared::PhotonContribution> all(n);
  for (shared::PhotonContribution& p : all) {
    p.position = {unit(random), 0, unit(random)};
    p.flux = flux, p.radiance = radiance;
    p.facet = shared::facet_pack(vec3(0, 1, 0));
  }
  return all;
}

EfficiencyPilot pilot_of(const std::vector<shared::PhotonContribution>& photons,
                         const std::vector<shared::PhotonLookup>& lookups, std::span<const double> gain) {
  EfficiencyPilot pilot{.lookups = lookups,
                        .width = uint32_t(lookups.size()),
                        .height = 1,
                        .photons = photons,
                        .gain = gain,
                        .paths = 1};
  for (shared::PhotonFrame* f : {&pilot.around, &pilot.round}) f->most = 1;
  pilot.around.base = 0.5f, pilot.round.base = 0.1f;
  return pilot;
}

/// 8 x 8 regions of 2 x 2 pixels.
constexpr uint32_t k_side = 16;
std::vector<Moments> halves(const Moments& left, const Moments& right) {
  std::vector<Moments> all;
  for (uint32_t i = 0; i < k_side * k_side; ++i) all.push_back(i % k_side < k_side / 2 ? left : right);
  return all;
}
Regions choose(const std::vector<Moments>& moments, const EfficiencyCosts& costs) {
  return photons::choose_regions(moments, k_side, k_side, costs);
}
constexpr EfficiencyCosts k_costs{.base = 2, .lookup = 0.5, .onward = 1.5, .paths = 2};

}  // namespace

TEST_CASE("light paths estimate the moments of photons and of camera paths", "[photons_efficiency]") {
  const float albedo = 0.6f, flux = 2e-5f, radiance = 40;
  const uint32_t n = 200000;
  const std::vector<shared::PhotonContribution> all = even(n, flux, radiance);
  const shared::PhotonLookup here{vec3(0), albedo, shared::facet_pack(vec3(0, 1, 0))};
  const std::vector<shared::PhotonLookup> lookups{here};
  const std::vector<double> as_before(n, 1), twice(n, 2);
  const Moments m = photons::caustic_moments(pilot_of(all, lookups, as_before))[0];
  const double pi = double(k_pi), density = n / 4.0, irradiance = double(flux) * density;
  // About 39 thousand photons are found: their number has an error of half a per cent.
  CHECK(m.found == Approx(density * pi * 0.25).epsilon(0.03));
  CHECK(m.mean == Approx(double(albedo) / pi * irradiance).epsilon(0.03));
  // A Poisson process of n photons per square metre: n times the square of the kernel.
  const double f = double(albedo * flux) / pi;
  CHECK(m.photons == Approx(f * f * density * 4 / (3 * pi * 0.01)).epsilon(0.03));
  // If light of radiance L comes from the cosine-weighted share p of directions, p = E / (pi L), the mean is
  // albedo L p and the second moment (albedo L)^2 p.
  const double p = irradiance / (pi * double(radiance)), value = double(albedo * radiance);
  CHECK(m.paths == Approx(value * value * p * (1 - p)).epsilon(0.03));

  // Twice as many paths of half the flux: half the variance. The same if each path is twice as likely.
  EfficiencyPilot more = pilot_of(all, lookups, as_before);
  more.paths = 2;
  CHECK(photons::caustic_moments(more)[0].photons == Approx(m.photons / 2));
  CHECK(photons::caustic_moments(pilot_of(all, lookups, twice))[0].photons == Approx(m.photons / 2));
  CHECK(photons::caustic_moments(pilot_of(all, lookups, twice))[0].mean == Approx(m.mean));
}

TEST_CASE("photons on the other side, or on no surface, do not contribute", "[photons_efficiency]") {
  const std::vector<shared::PhotonContribution> all = even(10000, 1, 1);
  const uint32_t up = shared::facet_pack(vec3(0, 1, 0)), down = shared::facet_pack(vec3(0, -1, 0)),
                 across = shared::facet_pack(vec3(1, 0, 0));
  const std::vector<shared::PhotonLookup> lookups{{vec3(0), 1, down},
                                                  {vec3(0), 1, across},
                                                  {vec3(0, 0.3f, 0), 1, up},
                                                  {vec3(0), 0, up},
                                                  {vec3(9), 1, up}};
  const std::vector<double> gain(all.size(), 1);
  for (const Moments& m : photons::caustic_moments(pilot_of(all, lookups, gain))) {
    CHECK(m.found == 0);
    CHECK((m.mean == 0 && m.photons == 0 && m.paths == 0));
  }
}

TEST_CASE("each region gets the method that makes the whole most efficient", "[photons_efficiency]") {
  const Moments hard{1, 0.1, 1000, 50}, soft{1, 0.5, 0.2, 50}, unknown{1, 0.5, 0.2, 0};
  SECTION("photons everywhere if paths rarely find the light") {
    const Regions r = choose(halves(hard, hard), k_costs);
    CHECK((r.by_photons == 1 && !r.nowhere && r.gain == 1));
  }
  SECTION("none if paths are more efficient") {
    const Regions r = choose(halves(soft, soft), k_costs);
    CHECK((r.by_photons == 0 && r.nowhere));
    // Variance times cost of either method.
    CHECK(r.gain == Approx(0.5 * (2 + 0.5 + 2) / (0.2 * (2 + 1.5))));
  }
  SECTION("each half by its own method") {
    const Regions r = choose(halves(hard, soft), k_costs);
    CHECK_FALSE(r.nowhere);
    CHECK(r.gain > 1);
    // The left half; regions with a neighbour in it, which are judged together; and one region further.
    for (uint32_t y = 0; y < r.height; ++y)
      for (uint32_t x = 0; x < r.width; ++x) CHECK(r.delegated[y * r.width + x] == (x < 6 ? 0 : 1));
    CHECK(r.by_photons == Approx(6.0 / 8));
  }
  SECTION("paths where the pilot found little or no light") {
    for (const Moments& few : {unknown, Moments{}}) {
      const Regions none = choose(halves(few, few), k_costs);
      CHECK((none.nowhere && none.scarce));
      const Regions half = choose(halves(hard, few), k_costs);
      CHECK((!half.nowhere && !half.scarce));
      for (uint32_t y = 0; y < half.height; ++y)
        for (uint32_t x = 0; x < half.width; ++x)
          CHECK(half.delegated[y * half.width + x] == (x < 6 ? 0 : 1));
    }
    CHECK_FALSE(choose(halves(soft, soft), k_costs).scarce);
  }
  SECTION("photons everywhere if they find most light, and the rest is the noisiest light of paths") {
    // As in `glass` and `ring`: a bright caustic, and faint light around it that few photons find.
    const Moments faint{0.05, 0.01, 500, 1}, bright{1, 0.1, 20, 50};
    const Regions all = choose(halves(bright, faint), k_costs);
    CHECK((all.by_photons == 1 && !all.nowhere));
    CHECK(all.gain == 1);
    // With little of the light well found there is no evidence.
    const Moments equal{1, 0.01, 500, 1};
    CHECK(choose(halves({0.02, 0.1, 20, 8}, equal), k_costs).by_photons < 1);
    // Nor if paths find the faint light easily.
    CHECK(choose(halves(bright, {0.05, 0.5, 0.001, 1}), k_costs).by_photons < 1);
  }
  SECTION("light that no camera path hits") {
    const Moments unmet{1, 0.1, double(shared::k_radiance_unmet), 50};
    CHECK(choose(halves(unmet, soft), k_costs).delegated[0] == 0);
    CHECK(choose(halves(unmet, unmet), k_costs).by_photons == 1);
  }
  SECTION("what is sent and looked up for other light costs caustics nothing") {
    const Moments even{1, 0.2, 0.3, 50};
    CHECK(choose(halves(even, even), {.base = 2, .lookup = 0, .onward = 0, .paths = 0}).by_photons == 1);
    CHECK(choose(halves(even, even), {.base = 2, .lookup = 0.5, .onward = 0, .paths = 4}).nowhere);
  }
}

}  // namespace photons_efficiency_tests
