// links: scene_io
// Measured light distributions: LM-63 of all years and types, EULUMDAT, symmetry, flux, and files that cannot
// be read.
#include "scene/io/light_profile_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "unit/scene_support.h"

namespace light_profile_tests {

using namespace lucerna;
using namespace lucerna::scene;
using Catch::Contains;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

struct File {
  std::string head = "IESNA:LM-63-2002";
  std::string tilt = "TILT=NONE";
  double multiplier = 1, ballast = 1, second = 1;
  int type = 1;
  std::vector<double> vertical, horizontal, candela;

  std::string text() const {
    std::string t = head + "\n[TEST] made here\n[MORE] two words\n" + tilt + "\n";
    t += fmt::format("1 1000 {} {} {} {} 2 0 0 0\n{} {} 40\n", multiplier, vertical.size(), horizontal.size(),
                     type, ballast, second);
    return t + fmt::format("{}\n{}\n{}\n", fmt::join(vertical, " "), fmt::join(horizontal, "\r\n"),
                           fmt::join(candela, ", "));
  }
};

std::vector<double> steps(double from, double to, double step) {
  std::vector<double> list;
  for (double a = from; a <= to + 1e-9; a += step) list.push_back(a);
  return list;
}

/// Intensity I(direction) written as that type with these angles.
template <class Intensity>
File written(int type, const std::vector<double>& vertical, const std::vector<double>& horizontal,
             const Intensity& intensity) {
  File f;
  f.type = type, f.vertical = vertical, f.horizontal = horizontal;
  for (const double h : horizontal)
    for (const double v : vertical) {
      const double a = h * k_pi_d / 180, b = v * k_pi_d / 180;
      const glm::dvec3 d =
          type == 1   ? glm::dvec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b))
          : type == 3 ? glm::dvec3(std::sin(a) * std::cos(b), std::sin(b), -std::cos(a) * std::cos(b))
                      : glm::dvec3(std::sin(a), std::sin(b) * std::cos(a), -std::cos(b) * std::cos(a));
      f.candela.push_back(intensity(d));
    }
  return f;
}

/// Symmetric about x and y; more along x than along y.
double oval(const glm::dvec3& d) {
  return d.z < 0 ? 900 * std::pow(-d.z, 3) * (1 + 0.8 * d.x * d.x - 0.5 * d.y * d.y) : 0;
}
/// To the right and up: no symmetry.
double leaning(const glm::dvec3& d) { return 100 * std::exp(1.5 * (0.5 * d.x + 0.3 * d.y - 0.8 * d.z)); }

void check_like(const LightProfile& p, double (*intensity)(const glm::dvec3&), double tolerance) {
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 500, phi = 2.399963 * i, r = std::sqrt(1 - z * z);
    const glm::dvec3 d(r * std::cos(phi), r * std::sin(phi), z);
    worst = std::max(worst, std::abs(p.peak * double(p.along(vec3(d))) - intensity(d)));
  }
  CHECK(worst < tolerance * p.peak);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string failure(const std::string& text) {
  try {
    parse_ies(text, "lamp.ies");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// 10 lamps of 100 lm in 4 C planes.
std::string eulumdat(int symmetry, int planes, const std::vector<double>& c, const std::vector<double>& g,
                     const std::vector<double>& candela) {
  std::string t =
      "company\n1\n" + fmt::format("{}\n{}\n{}\n{}\n{}\n", symmetry, planes, 360.0 / planes, g.size(), 5);
  for (int i = 0; i < 5; ++i) t += "name\n";
  for (int i = 0; i < 9; ++i) t += "100\n";
  t += "100\n80\n1\n0\n1\n10\nlamp\n1000\n3000\n1B\n20\n";
  for (int i = 0; i < 10; ++i) t += "0,5\n";
  return t + fmt::format("{}\n{}\n{}\n", fmt::join(c, "\n"), fmt::join(g, "\n"), fmt::join(candela, "\n"));
}

}  // namespace

TEST_CASE("flux of written distributions is that of their formula within half a percent") {
  // Lambertian: pi times the intensity in front.
  const auto lambert = [](const glm::dvec3& d) { return std::max(0.0, -d.z) * 250; };
  for (const double step : {1.0, 2.5, 5.0}) {
    const LightProfile p = parse_ies(written(1, steps(0, 90, step), {0}, lambert).text(), "x");
    CHECK(p.columns == 1);
    CHECK(p.peak == Approx(250).epsilon(1e-6));
    CHECK(p.lumens() == Approx(250 * k_pi_d).epsilon(0.005));
  }
  const LightProfile all =
      parse_ies(written(1, steps(0, 180, 5), {0}, [](const glm::dvec3&) { return 10.0; }).text(), "x");
  CHECK(all.lumens() == Approx(40 * k_pi_d).epsilon(1e-5));
  // The integral of exp(k cos) over the sphere is 4 pi sinh(k) / k.
  const double k = 1.5 * std::sqrt(0.25 + 0.09 + 0.64);
  const double expected = 100 * 4 * k_pi_d * std::sinh(k) / k;
  CHECK(parse_ies(written(1, steps(0, 180, 5), steps(0, 360, 10), leaning).text(), "x").lumens() ==
        Approx(expected).epsilon(0.005));
}

TEST_CASE("every type and symmetry gives the same light in every direction") {
  check_like(parse_ies(written(1, steps(0, 90, 2.5), steps(0, 360, 10), oval).text(), "x"), oval, 0.01);
  check_like(parse_ies(written(1, steps(0, 90, 2.5), steps(0, 350, 10), oval).text(), "x"), oval, 0.01);
  check_like(parse_ies(written(1, steps(0, 180, 2.5), steps(0, 180, 10), oval).text(), "x"), oval, 0.01);
  check_like(parse_ies(written(1, steps(0, 90, 2.5), steps(90, 270, 10), oval).text(), "x"), oval, 0.01);
  check_like(parse_ies(written(1, steps(0, 90, 2.5), steps(0, 90, 10), oval).text(), "x"), oval, 0.01);
  for (const int type : {2, 3}) {
    INFO("type " << type);
    check_like(parse_ies(written(type, steps(-90, 90, 3), steps(-90, 90, 3), oval).text(), "x"), oval, 0.01);
    check_like(parse_ies(written(type, steps(0, 90, 3), steps(0, 90, 3), oval).text(), "x"), oval, 0.01);
    const auto front = [](const glm::dvec3& d) { return d.z < 0 ? leaning(d) : 0.0; };
    const LightProfile p = parse_ies(written(type, steps(-90, 90, 3), steps(-90, 90, 3), front).text(), "x");
    for (const glm::dvec3 d : {glm::dvec3(0.6, 0, -0.8), {0, 0.6, -0.8}, {-0.48, 0.36, -0.8}})
      CHECK(p.peak * double(p.along(vec3(d))) == Approx(leaning(d)).epsilon(0.01));
  }
  check_like(parse_ies(written(1, steps(0, 180, 2.5), steps(0, 360, 5), leaning).text(), "x"), leaning, 0.01);
}

TEST_CASE("years, factors and tilts of LM-63") {
  File f = written(1, {0, 45, 90}, {0}, [](const glm::dvec3&) { return 10.0; });
  f.multiplier = 2, f.ballast = 0.5, f.second = 0.25;
  for (const auto& [head, peak] : {std::pair("IESNA:LM-63-2002", 10.0),
                                   {"IES:LM-63-2019", 10.0},
                                   {"IESNA:LM-63-1995", 10.0},
                                   {"IESNA91", 2.5},
                                   {"A lamp of 1986", 2.5}}) {
    f.head = head;
    INFO(head);
    CHECK(parse_ies(f.text(), "x").peak == Approx(peak));
  }
  f.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8";
  CHECK(parse_ies(f.text(), "x").peak == Approx(2.5));
  f.tilt = "TILT=lamp.tlt";
  CHECK(parse_ies(f.text(), "x").peak == Approx(2.5));
}

TEST_CASE("EULUMDAT of every symmetry gives the same light") {
  const auto value = [](double c, double g) {
    const double a = c * k_pi_d / 180, b = g * k_pi_d / 180;
    return oval({std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b)});
  };
  const std::vector<double> g = steps(0, 90, 2.5), c = steps(0, 345, 15);
  for (const auto& [symmetry, planes] :
       {std::pair(0, c), {2, steps(0, 180, 15)}, {3, std::vector<double>()}, {4, steps(0, 90, 15)}}) {
    std::vector<double> kept = planes, candela;
    if (symmetry == 3)
      for (double a = -90; a <= 90; a += 15) kept.push_back(a);
    for (const double plane : kept)
      for (const double angle : g) candela.push_back(value(plane, angle));
    INFO("symmetry " << symmetry);
    const std::string text = ies_of_eulumdat(eulumdat(symmetry, 24, c, g, candela), "x.ldt");
    const LightProfile p = parse_ies(text, "x.ldt");
    CHECK(p.peak == Approx(900).epsilon(1e-6));  // 1000 lm of the lamps
    check_like(p, oval, 0.01);
    // What is saved reads as the same.
    CHECK(parse_ies(p.text, "again").intensity == p.intensity);
  }
  std::vector<double> even;
  for (const double angle : g) even.push_back(100 * std::cos(angle * k_pi_d / 180));
  const LightProfile round = parse_ies(ies_of_eulumdat(eulumdat(1, 24, c, g, even), "x.ldt"), "x");
  CHECK(round.columns == 1);
  CHECK(round.lumens() == Approx(100 * k_pi_d).epsilon(0.005));
}

TEST_CASE("files that cannot be read: one message with the line") {
  const File good = written(1, {0, 45, 90}, {0, 90}, [](const glm::dvec3&) { return 10.0; });
  REQUIRE(failure(good.text()).empty());
  const std::string text = good.text();
  CHECK_THAT(failure(text.substr(0, text.size() - 6)),
             Contains("lamp.ies, line") && Contains("the file ends before"));
  CHECK_THAT(failure("IESNA:LM-63-2002\n[TEST] x\n"),
             Contains("line 2") && Contains("there is no line TILT="));
  CHECK_THAT(failure(""), Contains("lamp.ies") && Contains("TILT="));
  File f = good;
  f.candela[4] = -3;
  CHECK_THAT(failure(f.text()), Contains("line 10") && Contains("-3 candela are negative"));
  CHECK_THAT(failure(replaced(text, "10, 10", "10, ten")),
             Contains("'ten' is no number, expected a value of candela"));
  CHECK_THAT(failure(replaced(text, "10, 10", "10, nan")), Contains("'nan' is no number"));
  CHECK_THAT(failure(replaced(text, "1 1000 1 3 2", "1 1000 1 100000 2")),
             Contains("line 5") && Contains("100000 vertical angles, expected 1 to 3601"));
  CHECK_THAT(failure(replaced(text, "1 1000 1 3 2", "1 1000 0 3 2")), Contains("expected above 0"));
  CHECK_THAT(failure(replaced(text, "0 45 90", "0 45 45")), Contains("vertical angle 45 does not increase"));
  CHECK_THAT(failure(replaced(text, "3 2 1 2", "3 2 7 2")),
             Contains("7 as type of photometry, expected 1 to 3"));
  for (double& c : f.candela) c = 0;
  CHECK_THAT(failure(f.text()), Contains("all candela are 0"));
  CHECK_THROWS_WITH(ies_of_eulumdat("company\n1\n9\n", "a.ldt"),
                    Contains("a.ldt, line 3") && Contains("9 as symmetry, expected 0 to 4"));
  CHECK_THROWS_WITH(ies_of_eulumdat("company\n1\n0\n24\n", "a.ldt"), Contains("the file ends before"));
  CHECK_THROWS_WITH(load_light_profile("/nowhere/lamp.ies"), Contains("/nowhere/lamp.ies: cannot be read"));
}

}  // namespace light_profile_tests
