// links: photons
// The law by which the photon radius shrinks, compared with its closed form and the recurrence that it
// solves; and the report.
#include <catch2/catch.hpp>

#include "solvers/photons/radius.h"
#include "solvers/photons/report.h"

namespace photons_radius_tests {

using namespace lucerna;
using photons::radius_ratio;

TEST_CASE("the radius of photons follows Knaus and Zwicker") {
  const double alpha = 2.0 / 3;
  CHECK(radius_ratio(0, alpha) == Approx(1));
  CHECK(radius_ratio(63, alpha) == Approx(0.526).margin(5e-4));
  CHECK(radius_ratio(1023, alpha) == Approx(0.331).margin(5e-4));
  CHECK(radius_ratio(9999, alpha) == Approx(0.227).margin(5e-4));
  for (const double a : {0.1, alpha, 0.9, 1.0}) {
    double square = 1;
    for (uint32_t round = 0; round < 2000; ++round) {
      REQUIRE(radius_ratio(round, a) == Approx(std::sqrt(square)).epsilon(1e-9));
      const double i = double(round) + 1;
      square *= (i + a) / (i + 1);
    }
  }
  CHECK(radius_ratio(~0u, alpha) > 0);
}

TEST_CASE("the report of photons states why there are none") {
  photons::PhotonReport r;
  r.lights_power = 0;
  const auto says = [](const solvers::Report& report, const char* words) {
    for (const auto& item : report.sections[0].items)
      if (const auto* text = std::get_if<solvers::Paragraph>(&item))
        if (text->text.find(words) != std::string::npos) return true;
    return false;
  };
  CHECK(says(photons::make_report(r), "The scene has no light"));
  r.lights_power = 1, r.sends = false;
  CHECK(says(photons::make_report(r), "there are no caustics"));
  r.sends = true, r.limited = true;
  CHECK_FALSE(says(photons::make_report(r), "no caustics"));
  CHECK(says(photons::make_report(r), "limited to a quarter"));
  r.rounds = 5, r.last.round = 4;
  CHECK(photons::make_report(r).state == "round 5");
  CHECK(photons::make_report(r).figure("rounds") == 5);
}

}  // namespace photons_radius_tests
