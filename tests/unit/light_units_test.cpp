// links: scene
// Units of light: conversions against closed forms and quadratures.
#include "scene/light_units.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error.h"
#include "scene/lamp.h"

namespace light_units_tests {

using namespace lucerna;
using namespace lucerna::scene;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

Light lamp(LightKind kind) {
  Light light;
  light.kind = kind, light.intensity = vec3(1);
  light.width = 1.2f, light.height = 0.4f, light.radius = 0.3f;
  light.inner_cone = glm::radians(20.0f), light.outer_cone = glm::radians(40.0f);
  return light;
}

double factor(const Light& light, LightUnit unit, double distance = 1) {
  const auto f = unit_factor(light, unit, distance);
  REQUIRE(f);
  return *f;
}

/// Illuminance at (0, 0, distance), facing -z, of a patch of luminance `nits` with that normal.
double patch(const glm::dvec3& at, const glm::dvec3& normal, double area, double distance, double nits) {
  const glm::dvec3 way = glm::dvec3(0, 0, distance) - at;
  const double d2 = glm::dot(way, way), leaves = glm::dot(normal, way), arrives = way.z;
  return leaves > 0 && arrives > 0 ? nits * area * leaves * arrives / (d2 * d2) : 0;
}

}  // namespace

TEST_CASE("a candela is 1/d2 lux, and as many lumens as the lamp's solid angle") {
  const Light point = lamp(LightKind::point);
  CHECK(factor(point, LightUnit::candela) == 1);
  CHECK(factor(point, LightUnit::lumen) == Approx(4 * k_pi_d));
  CHECK(factor(point, LightUnit::lux, 2) == 0.25);
  CHECK(factor(point, LightUnit::watt) == Approx(4 * k_pi_d / 683));
  CHECK_FALSE(unit_factor(point, LightUnit::nit, 1));
  CHECK_FALSE(unit_factor(point, LightUnit::lux, 0));

  // A spot: full up to the inner cone; then the squared ramp in the cosine, which integrates to a third.
  const Light spot = lamp(LightKind::spot);
  const double inner = std::cos(double{spot.inner_cone}), outer = std::cos(double{spot.outer_cone});
  CHECK(factor(spot, LightUnit::lumen) == Approx(2 * k_pi_d * (1 - inner + (inner - outer) / 3)));
  CHECK(factor(spot, LightUnit::lux, 0.5) == 4);
  Light sharp = spot;
  sharp.inner_cone = sharp.outer_cone;
  CHECK(factor(sharp, LightUnit::lumen) == Approx(2 * k_pi_d * (1 - outer)).epsilon(1e-3));

  const Light sun = lamp(LightKind::directional);
  CHECK(factor(sun, LightUnit::lux, 1000) == 1);
  CHECK(factor(sun, LightUnit::watt) == Approx(1 / 683.0));
  for (const LightUnit none : {LightUnit::candela, LightUnit::lumen, LightUnit::nit})
    CHECK_FALSE(unit_factor(sun, none, 1));
}

TEST_CASE("a picture's lumens are its luminance over the directions that it covers") {
  Light spot = lamp(LightKind::spot);
  set_picture(spot, std::make_shared<LightPicture>(make_picture(3, 2, {6, vec3(1)}, "white")));
  const vec2 half = picture_extent(spot);
  const double w{half.x}, h{half.y};
  // Solid angle of a rectangle before the middle.
  const double whole = 4 * std::asin(w * h / std::sqrt((1 + w * w) * (1 + h * h)));
  CHECK(factor(spot, LightUnit::lumen) == Approx(whole).epsilon(1e-3));
  CHECK(factor(spot, LightUnit::candela) == 1);
  set_picture(spot, std::make_shared<LightPicture>(make_picture(
                        3, 2, {vec3(0), vec3(0, 1, 0), vec3(0), vec3(0), vec3(0, 1, 0), vec3(0)}, "stripe")));
  CHECK(factor(spot, LightUnit::lumen) < 0.7152 * 0.55 * whole);
  CHECK(factor(spot, LightUnit::lumen) > 0.7152 * 0.5 * whole);
}

TEST_CASE("pictures: what is refused, and what is made of others") {
  const auto failure = [](uint32_t w, uint32_t h, std::vector<vec3> texels) {
    try {
      make_picture(w, h, std::move(texels), "file.png");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(failure(2, 2, {4, vec3(0)}) == "file.png: the picture is black");
  CHECK(failure(0, 0, {}) == "file.png: the picture has no texels");
  CHECK(failure(1, 2, {vec3(1), vec3(1, NAN, 1)}).find("a texel has the value nan") != std::string::npos);
  CHECK(failure(1, 1, {vec3(-1)}).find("a texel has the value -1") != std::string::npos);
  CHECK(failure(3000, 1, std::vector<vec3>(3000, vec3(1))).find("too long") != std::string::npos);
  const LightPicture one = make_picture(1, 1, {vec3(3)}, "x");
  CHECK((one.width == 2 && one.height == 2));
  CHECK(one.at(vec2(0.3f, 0.9f)) == vec3(3));
  std::vector<vec3> large(size_t{2048} * 1500);
  for (size_t i = 0; i < large.size(); ++i) large[i] = vec3(float(i % 2));
  const LightPicture half = make_picture(2048, 1500, large, "x");
  CHECK((half.width == 1024 && half.height == 750));
  CHECK(half.texels[5] == vec3(0.5f));
}

TEST_CASE("a measured distribution has its own lumens, and candela where it is strongest") {
  // Between 60 and 120 degrees only: nothing on its axis.
  const auto profile = std::make_shared<LightProfile>(sampled_profile(
      [](double polar, double) { return 250 * std::pow(std::sin(glm::radians(polar)), 2); }, true));
  Light light = lamp(LightKind::point);
  set_profile(light, profile);
  light.intensity = vec3(float(profile->peak));
  CHECK(strength_in(light, LightUnit::candela, 1).value() == Approx(250));
  // The integral of sin^2 over the sphere is 8 pi / 3.
  CHECK(strength_in(light, LightUnit::lumen, 1).value() == Approx(250 * 8 * k_pi_d / 3).epsilon(1e-4));
  CHECK(strength_in(light, LightUnit::lumen, 1).value() == Approx(profile->lumens()));
  CHECK(strength_in(light, LightUnit::lux, 5).value() == Approx(10));
  CHECK_FALSE(strength_in(light, LightUnit::nit, 1));
}

TEST_CASE("shapes: pi A L lumens of a flat one, and the area that is seen from the front") {
  const double w = 1.2f, h = 0.4f, r = 0.3f;
  const auto nits = [](const Light& light) { return factor(light, LightUnit::nit); };
  Light rectangle = lamp(LightKind::rectangle), disk = lamp(LightKind::disk);
  CHECK(factor(rectangle, LightUnit::lumen) / nits(rectangle) == Approx(k_pi_d * w * h));
  CHECK(factor(disk, LightUnit::lumen) / nits(disk) == Approx(k_pi_d * k_pi_d * r * r));
  rectangle.two_sided = disk.two_sided = true;
  CHECK(factor(rectangle, LightUnit::lumen) / nits(rectangle) == Approx(2 * k_pi_d * w * h));
  const Light sphere = lamp(LightKind::sphere), tube = lamp(LightKind::tube);
  CHECK(factor(sphere, LightUnit::lumen) / nits(sphere) == Approx(k_pi_d * 4 * k_pi_d * r * r));
  CHECK(factor(tube, LightUnit::lumen) / nits(tube) == Approx(k_pi_d * 2 * k_pi_d * r * w));
  // The renderer's radiance.
  for (const Light& light : {rectangle, disk, sphere, tube})
    CHECK(nits(light) == Approx(double{radiance_of(light).x}));
}

TEST_CASE("lux of shapes near by are sums over their surfaces") {
  const double w = 1.2f, h = 0.4f, r = 0.3f;
  constexpr int k_n = 400;
  for (const double d : {0.5, 0.8, 3.0}) {
    INFO(d);
    double rectangle = 0, disk = 0, sphere = 0, tube = 0;
    for (int i = 0; i < k_n; ++i)
      for (int j = 0; j < k_n; ++j) {
        const double u = (i + 0.5) / k_n, v = (j + 0.5) / k_n, share = 1.0 / (k_n * k_n);
        const double a = 2 * k_pi_d * v, z = 2 * u - 1, ring = std::sqrt(1 - z * z);
        rectangle += patch({w * (u - 0.5), h * (v - 0.5), 0}, {0, 0, 1}, w * h * share, d, 1);
        disk += patch({r * std::sqrt(u) * std::cos(a), r * std::sqrt(u) * std::sin(a), 0}, {0, 0, 1},
                      k_pi_d * r * r * share, d, 1);
        const glm::dvec3 n(ring * std::cos(a), ring * std::sin(a), z), m(0, std::sin(a), std::cos(a));
        sphere += patch(r * n, n, 4 * k_pi_d * r * r * share, d, 1);
        tube += patch(r * m + glm::dvec3(w * (u - 0.5), 0, 0), m, 2 * k_pi_d * r * w * share, d, 1);
      }
    const auto per_nit = [&](LightKind kind) {
      return factor(lamp(kind), LightUnit::lux, d) / factor(lamp(kind), LightUnit::nit);
    };
    CHECK(per_nit(LightKind::rectangle) == Approx(rectangle).epsilon(2e-3));
    CHECK(per_nit(LightKind::disk) == Approx(disk).epsilon(2e-3));
    CHECK(per_nit(LightKind::sphere) == Approx(sphere).epsilon(5e-3));
    CHECK(per_nit(LightKind::tube) == Approx(tube).epsilon(5e-3));
  }
  for (const LightKind kind : {LightKind::rectangle, LightKind::disk, LightKind::sphere, LightKind::tube})
    CHECK(factor(lamp(kind), LightUnit::lux, 1e3) == Approx(1e-6).epsilon(1e-3));
  // An endless tube: pi r / d nits.
  Light endless = lamp(LightKind::tube);
  endless.width = 1e4f;
  CHECK(factor(endless, LightUnit::lux, 0.6) / factor(endless, LightUnit::nit) ==
        Approx(k_pi_d * 0.5).epsilon(1e-4));
  // Inside there is no front.
  CHECK_FALSE(unit_factor(lamp(LightKind::sphere), LightUnit::lux, 0.3));
  CHECK_FALSE(unit_factor(lamp(LightKind::tube), LightUnit::lux, 0.2));
}

TEST_CASE("an emitting mesh has the lumens of its placed area") {
  Scene s;
  Primitive square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back({"square", {square}});
  s.materials.resize(1);
  for (const float size : {1.0f, 2.0f, 3.0f}) {
    Instance instance{.mesh = 0, .hidden = size == 3};
    instance.to_world[0][0] = instance.to_world[1][1] = size;
    s.instances.push_back(instance);
  }
  CHECK(emitting_area(s, 0) == Approx(5));
  s.materials[0].double_sided = true;
  CHECK(emitting_area(s, 0) == Approx(10));
  CHECK(unit_factor(5, LightUnit::lumen).value() == Approx(5 * k_pi_d));
  CHECK(unit_factor(5, LightUnit::watt).value() == Approx(5 * k_pi_d / 683));
  CHECK(unit_factor(5, LightUnit::nit).value() == 1);
  CHECK_FALSE(unit_factor(5, LightUnit::candela));
  CHECK_FALSE(unit_factor(5, LightUnit::lux));
}

TEST_CASE("a strength is given to the colour's luminance, and one that it has changes no bit") {
  Light light = lamp(LightKind::spot);
  light.intensity = vec3(12.3f, 4.7f, 0.9f);
  for (const LightUnitInfo& info : k_unit_table) {
    const auto f = unit_factor(light, info.unit, 0.7);
    if (!f) continue;
    INFO(info.word);
    const float now = float(strength_in(light, info.unit, 0.7).value());
    CHECK(with_strength(light.intensity, *f, now) == light.intensity);
    Light twice = light;
    twice.intensity = with_strength(light.intensity, *f, 2 * double{now});
    CHECK(strength_in(twice, info.unit, 0.7).value() == Approx(2 * double{now}));
    CHECK(twice.intensity.y / twice.intensity.x == Approx(4.7 / 12.3));
    CHECK(unit_named(info.word) == info.unit);
  }
  CHECK(with_strength(vec3(0, 0, 5), 1, 7.22).z == Approx(100));
  CHECK(with_strength(vec3(0), 2, 10) == vec3(5));
  CHECK(with_strength(vec3(3, 2, 1), 2, 0) == vec3(0));
  CHECK_FALSE(unit_named("candela"));

  CHECK(shown_unit(light, LightUnit::nit, 1) == LightUnit::candela);
  CHECK(shown_unit(light, LightUnit::lumen, 1) == LightUnit::lumen);
  CHECK(shown_unit(lamp(LightKind::directional), LightUnit::lumen, 1) == LightUnit::lux);
  CHECK(shown_unit(lamp(LightKind::sphere), LightUnit::lux, 0.1) == LightUnit::candela);
  CHECK(unit_symbol(lamp(LightKind::directional), LightUnit::watt) == std::string("W/m\xC2\xB2"));
}

}  // namespace light_units_tests
