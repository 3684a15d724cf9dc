// links: upload
// Lamps with a shape through shaders/lib/shapes.glsl: their samples, densities and hits, and their light on a
// plane compared with closed forms.
#include <functional>
#include <optional>

#include "kernels/light_support.h"
#include "scene/lamp.h"

namespace shape_lights_tests {

using namespace lucerna;
using namespace lucerna::test;
using scene::LightKind;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;
constexpr uint32_t k_draws = 1 << 17;

scene::Light lamp(LightKind kind) {
  scene::Light l;
  l.kind = kind;
  l.position = {0.3f, 2, -0.2f};
  l.intensity = {3, 2, 1};
  l.width = 1.4f, l.height = 0.6f, l.radius = 0.5f;
  if (kind == LightKind::tube) l.radius = 0.2f, l.width = 2;
  if (kind == LightKind::sphere) return l;
  l.direction = vec3(glm::normalize(glm::dvec3(0.2, -1, 0.1)));
  l.right = scene::rolled(l.direction, 25);
  return l;
}

scene::Scene with(std::vector<scene::Light> lights) {
  scene::Scene s;
  s.lights = std::move(lights);
  return s;
}

/// A point of the emitting surface for parameters in 0..1, its normal, and area per parameter.
struct Patch {
  glm::dvec3 point, normal;
  double area;
};
Patch patch(const scene::Light& l, double a, double b) {
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n), c(l.position);
  const glm::dvec2 half(scene::half_size(l));
  const double phi = 2 * k_pi_d * a;
  switch (l.kind) {
    case LightKind::sphere: {
      const double z = 2 * b - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
      const glm::dvec3 out(r * std::cos(phi), r * std::sin(phi), z);
      return {c + half.x * out, out, 4 * k_pi_d * half.x * half.x};
    }
    case LightKind::tube: {
      const glm::dvec3 out = std::cos(phi) * n + std::sin(phi) * y;
      return {c + half.x * (2 * b - 1) * x + half.y * out, out, 4 * k_pi_d * half.x * half.y};
    }
    case LightKind::disk: {
      const double r = half.x * std::sqrt(b);
      return {c + r * (std::cos(phi) * x + std::sin(phi) * y), n, k_pi_d * half.x * half.x};
    }
    default:
      return {c + half.x * (2 * a - 1) * x + half.y * (2 * b - 1) * y, n, 4 * half.x * half.y};
  }
}
/// The inverse of patch(), for points on the surface.
glm::dvec2 parameters(const scene::Light& l, const glm::dvec3& p) {
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n), d = p - glm::dvec3(l.position);
  const glm::dvec2 half(scene::half_size(l));
  const auto turns = [](double s, double c) {
    const double t = std::atan2(s, c) / (2 * k_pi_d);
    return t < 0 ? t + 1 : t;
  };
  switch (l.kind) {
    case LightKind::sphere:
      return {turns(d.y, d.x), 0.5 * (d.z / half.x + 1)};
    case LightKind::tube:
      return {turns(glm::dot(d, y), glm::dot(d, n)), 0.5 * (glm::dot(d, x) / half.x + 1)};
    case LightKind::disk:
      return {turns(glm::dot(d, y), glm::dot(d, x)), glm::dot(d, d) / (half.x * half.x)};
    default:
      return 0.5 * (glm::dvec2(glm::dot(d, x), glm::dot(d, y)) / half + 1.0);
  }
}
/// Integral over parameters [a0, a1] x [b0, b1] of f times the solid angle seen from `at`.
double over(const scene::Light& l, const glm::dvec3& at, const glm::dvec4& cell, int steps,
            const std::function<double(const glm::dvec3&)>& f) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const Patch p =
          patch(l, glm::mix(cell.x, cell.y, (i + 0.5) / steps), glm::mix(cell.z, cell.w, (k + 0.5) / steps));
      const glm::dvec3 to = p.point - at;
      const double d = glm::length(to), cosine = -glm::dot(p.normal, to) / d;
      if (cosine > 0) sum += f(to / d) * cosine / (d * d) * p.area;
    }
  return sum * (cell.y - cell.x) * (cell.w - cell.z) / (double(steps) * steps);
}

const std::vector<LightKind> k_kinds{LightKind::sphere, LightKind::rectangle, LightKind::disk,
                                     LightKind::tube};
/// Near, beside, far away, and close to the surface.
const std::vector<vec3> k_places{{0.1f, 0.4f, 0.2f}, {2.5f, 0.5f, -1}, {-9, -20, 14}, {0.35f, 1.42f, -0.15f}};

}  // namespace

TEST_CASE("samples of shapes lie on them, uniform in solid angle, with the density of a hit") {
  constexpr int k_side = 10;
  Jury jury;
  for (const LightKind kind : k_kinds) {
    const scene::Light l = lamp(kind);
    Lights lights(with({l}));
    const glm::dvec3 radiance(scene::radiance_of(l));
    for (const vec3& at : k_places) {
      const auto draws = lights.draw(at, k_draws, 5);
      std::vector<vec4> questions;
      std::vector<double> observed(k_side * k_side, 0.0), expected;
      size_t off_surface = 0, bad_light = 0, bad_direction = 0, bad_pdf = 0, missed = 0;
      Mean angle;
      for (const Draw& d : draws) {
        bad_direction += std::abs(glm::length(d.direction) - 1) > 1e-5f || d.delta != 0 ||
                         d.primitive != shared::k_no_hit || !(d.pdf > 0);
        const bool hit = d.radiance.x > 0;
        angle.add(hit ? 1 / double(d.pdf) : 0);
        if (!hit) {
          ++missed;
          continue;
        }
        bad_light += glm::length(glm::dvec3(d.radiance) / radiance - 1.0) > 1e-4;
        // Shadow rays end a little before the lamp.
        const glm::dvec3 p = glm::dvec3(at) + glm::dvec3(d.direction) * (double(d.distance) / (1 - 1e-4));
        const glm::dvec2 where = parameters(l, p);
        const Patch on = patch(l, where.x, where.y);
        const double reach = glm::distance(glm::dvec3(at), p);
        off_surface += !(glm::distance(on.point, p) < 3e-4 * reach) || where.y < -1e-3 || where.y > 1.001 ||
                       glm::dot(on.normal, glm::dvec3(d.direction)) > 0.02;
        observed[size_t(std::clamp(int(where.x * k_side), 0, k_side - 1) * k_side +
                        std::clamp(int(where.y * k_side), 0, k_side - 1))] += 1;
        questions.emplace_back(d.direction, 0.f);
      }
      INFO(scene::kind_name(kind) << " from " << at.x << " " << at.y << " " << at.z);
      CHECK(bad_direction == 0);
      CHECK(bad_light == 0);
      CHECK(off_surface == 0);
      CHECK(missed < (kind == LightKind::disk || kind == LightKind::tube ? k_draws / 2 : 1));
      // The density of a hit is that of the sample, but for samples on the very rim.
      const auto answers = lights.shapes(at, questions);
      size_t next = 0, no_hit = 0;
      for (const Draw& d : draws)
        if (d.radiance.x > 0) {
          const Answer& a = answers[next++];
          no_hit += !(a.value.x > 0);
          if (a.value.x > 0)
            bad_pdf +=
                !(std::abs(a.pdf / d.pdf - 1) < 2e-3f) || !(std::abs(a.value.x / d.distance - 1) < 1e-3f);
        }
      CHECK(bad_pdf == 0);
      CHECK(no_hit < k_draws / 2000);
      const auto one = [](const glm::dvec3&) { return 1.0; };
      double whole = 0;
      for (int i = 0; i < k_side; ++i)
        for (int k = 0; k < k_side; ++k) {
          const double cell = over(l, at, glm::dvec4(i, i + 1, k, k + 1) / double(k_side), 24, one);
          whole += cell;
          expected.push_back(cell);
        }
      jury.add(fmt::format("{}: solid angle {} +- {}, right {}", scene::kind_name(kind), angle.value(),
                           angle.error(), whole),
               mean_tail(angle, whole, 2e-3 * whole));
      // Uniform: the share of a cell is that of its solid angle. Far away samples are uniform in area.
      for (double& e : expected) e *= double(k_draws - missed) / whole;
      if (whole > 0.02)
        jury.add(fmt::format("{}: places", scene::kind_name(kind)), chi_square(observed, expected).p);
    }
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("light of shapes on a plane, by closed forms") {
  // Irradiance of a plane y = 0 at the origin, per radiance.
  struct Form {
    scene::Light light;
    double irradiance;
  };
  std::vector<Form> forms;
  // A sphere above the horizon: pi (r / d)^2 cosine.
  scene::Light sphere = lamp(LightKind::sphere);
  const double d = glm::length(glm::dvec3(sphere.position));
  forms.push_back({sphere, k_pi_d * std::pow(0.5 / d, 2) * 2 / d});
  // A parallel disk, off its axis (M. F. Modest, Radiative Heat Transfer, view factor 13).
  scene::Light disk = lamp(LightKind::disk);
  disk.direction = {0, -1, 0}, disk.right = {1, 0, 0};
  const double h = 2, r = double(disk.radius), a2 = 0.3 * 0.3 + 0.2 * 0.2, s = h * h + a2 + r * r;
  forms.push_back({disk, 0.5 * k_pi_d * (1 - (h * h + a2 - r * r) / std::sqrt(s * s - 4 * a2 * r * r))});
  // A polygon: half the sum over its edges of angle times the edge's normal (J. H. Lambert 1760).
  scene::Light rectangle = lamp(LightKind::rectangle);
  double edges = 0;
  for (int k = 0; k < 4; ++k) {
    const auto corner = [&](int i) {
      const double x = (i % 4 == 0 || i % 4 == 3) ? 0 : 1, y = i % 4 < 2 ? 0 : 1;
      return glm::normalize(patch(rectangle, x, y).point);
    };
    const glm::dvec3 a = corner(k), b = corner(k + 1), across = glm::cross(a, b);
    edges += std::acos(glm::dot(a, b)) * across.y / glm::length(across);
  }
  forms.push_back({rectangle, 0.5 * std::abs(edges)});
  // A tube parallel to the plane, the point below one end (J. R. Howell, A Catalog of Radiation Heat Transfer
  // Configuration Factors, B-31).
  scene::Light tube = lamp(LightKind::tube);
  tube.direction = {0, -1, 0}, tube.right = {1, 0, 0};
  tube.position = {0.5f * tube.width, 1, 0};
  const double L = double(tube.width) / double(tube.radius), H = 1 / double(tube.radius),
               X = (1 + H) * (1 + H) + L * L, Y = (1 - H) * (1 - H) + L * L;
  const double factor =
      std::atan(L / std::sqrt(H * H - 1)) / (k_pi_d * H) +
      L / k_pi_d *
          ((X - 2 * H) / (H * std::sqrt(X * Y)) * std::atan(std::sqrt(X * (H - 1) / (Y * (H + 1)))) -
           std::atan(std::sqrt((H - 1) / (H + 1))) / H);
  forms.push_back({tube, k_pi_d * factor});
  Jury jury;
  for (const Form& form : forms) {
    const char* name = scene::kind_name(form.light.kind);
    // Two lamps share the samples: the other one is behind the plane.
    scene::Light below = form.light;
    below.position.y -= 10;
    Lights lights(with({form.light, below}));
    Mean mean;
    for (const Draw& draw : lights.draw(vec3(0), k_draws, 11))
      mean.add(draw.pdf > 0
                   ? double(draw.radiance.y) * std::max(0.0, double(draw.direction.y)) / double(draw.pdf)
                   : 0);
    const double right = form.irradiance * double(scene::radiance_of(form.light).y);
    const double integral = over(form.light, glm::dvec3(0), {0, 1, 0, 1}, 400,
                                 [](const glm::dvec3& w) { return std::max(0.0, w.y); });
    INFO(name << ": " << mean.value() << " +- " << mean.error() << ", closed form " << right);
    CHECK(integral == Approx(form.irradiance).epsilon(2e-3));
    CHECK(mean.error() < 0.01 * right);
    jury.add(name, mean_tail(mean, right, 5e-4 * right));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("shapes send their power: intensity in front, behind only with two sides, nothing inside") {
  for (const LightKind kind : k_kinds) {
    scene::Light l = lamp(kind);
    INFO(scene::kind_name(kind));
    // Seen from far in front, radiance times solid angle is intensity over distance squared.
    const vec3 far = l.position + 300.0f * l.direction;
    const auto mean_at = [&](const scene::Light& light, const vec3& at) {
      Lights lights(with({light}));
      Mean mean;
      for (const Draw& d : lights.draw(at, 1 << 14, 3))
        mean.add(d.pdf > 0 ? double(d.radiance.x) / double(d.pdf) : 0);
      return mean;
    };
    const Mean front = mean_at(l, far);
    CHECK(std::abs(front.value() * 300 * 300 - 3) < 0.003 + 4 * 300 * 300 * front.error());
    const vec3 behind = l.position - 300.0f * l.direction;
    const bool flat = kind == LightKind::rectangle || kind == LightKind::disk;
    CHECK((mean_at(l, behind).value() > 0) == !flat);
    l.two_sided = true;
    CHECK(mean_at(l, behind).value() > 0);
    if (!flat) CHECK(mean_at(l, l.position).value() == 0);
  }
}

TEST_CASE("candela of a measured distribution arrive at the angles where they were measured") {
  scene::Light l = lamp(LightKind::rectangle);
  l.kind = LightKind::profile;
  l.profile = std::make_shared<scene::LightProfile>(scene::sampled_profile(
      [](double polar, double around) {
        return polar > 150 ? 0 : 200 + polar + 50 * std::cos(around * k_pi_d / 180);
      },
      false));
  l.intensity = vec3(float(l.profile->peak));
  scene::Light other = l;
  other.position += vec3(3, 0, 0), other.profile = std::make_shared<scene::LightProfile>(*l.profile);
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n);
  for (const double polar : {0.0, 17.5, 60.0, 90.0, 120.0, 170.0})
    for (const double around : {0.0, 45.0, 133.0, 271.0}) {
      const double a = polar * k_pi_d / 180, b = around * k_pi_d / 180;
      const glm::dvec3 to = std::sin(a) * (std::cos(b) * x + std::sin(b) * y) + std::cos(a) * n;
      const double candela = polar > 150 ? 0 : 200 + polar + 50 * (polar > 0 ? std::cos(b) : 0);
      Lights lights(with({l, other}));
      INFO("polar " << polar << ", around " << around);
      for (const Draw& d : lights.draw(vec3(glm::dvec3(l.position) + 2.0 * to), 64, 2)) {
        if (std::abs(d.distance - 2) > 1e-4f) continue;
        CHECK(double(d.radiance.x) == Approx(candela / 4).epsilon(1e-3).margin(1e-6));
        CHECK(d.delta == 1);
      }
    }
}

TEST_CASE("the light of a projector is that of its picture, upright and in three channels") {
  scene::Light l = lamp(LightKind::rectangle);
  l.kind = LightKind::spot, l.outer_cone = glm::radians(40.0f), l.inner_cone = 0;
  const std::vector<vec3> texels{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0, 0}, {2, 2, 2}, {0, 0.25f, 0}};
  set_picture(l, std::make_shared<scene::LightPicture>(scene::make_picture(3, 2, texels, "x")));
  l.right = scene::rolled(l.direction, 25);
  scene::Light other = l;
  other.position += vec3(3, 0, 0);
  other.picture = std::make_shared<scene::LightPicture>(scene::make_picture(2, 2, {4, vec3(1)}, "y"));
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n);
  const glm::dvec2 half(scene::picture_extent(l));
  CHECK(glm::length(half) == Approx(std::tan(40 * k_pi_d / 180)));
  CHECK(half.x / half.y == Approx(1.5));
  Lights lights(with({l, other}));
  const auto arrives = [&](double u, double v) {
    const glm::dvec3 to = glm::normalize((2 * u - 1) * half.x * x + (1 - 2 * v) * half.y * y + n);
    std::optional<vec3> light;
    for (const Draw& d : lights.draw(vec3(glm::dvec3(l.position) + 2.0 * to), 64, 2)) {
      if (std::abs(d.distance - 2) > 1e-4f) continue;
      light = d.radiance * 4.0f;
      CHECK(d.delta == 1);
    }
    REQUIRE(light);
    return *light;
  };
  const auto check = [&](double u, double v, const vec3& relative) {
    INFO(u << " " << v);
    const vec3 light = arrives(u, v);
    for (int k = 0; k < 3; ++k)
      CHECK(light[k] == Approx(l.intensity[k] * relative[k]).epsilon(2e-3).margin(2e-3));
  };
  // Corners, a little inside; the middle of the upper border; between two points; the middle.
  check(1e-4, 1e-4, {1, 0, 0}), check(0.9999, 1e-4, {0, 0, 1}), check(1e-4, 0.9999, {0.5f, 0, 0});
  check(0.9999, 0.9999, {0, 0.25f, 0}), check(0.5, 1e-4, {0, 1, 0}), check(0.25, 1e-4, {0.5f, 0.5f, 0});
  check(0.5, 0.5, {1, 1.5f, 1});
  for (const vec2& outside : {vec2(-0.01f, 0.5f), vec2(1.01f, 0.5f), vec2(0.5f, -0.01f), vec2(0.5f, 1.01f)})
    check(double(outside.x), double(outside.y), vec3(0));
  // Behind the lamp there is nothing, though the plane's point is the same.
  for (const Draw& d : lights.draw(vec3(glm::dvec3(l.position) - 2.0 * n), 64, 2))
    if (std::abs(d.distance - 2) < 1e-4f) CHECK(d.radiance == vec3(0));
}

TEST_CASE("there were no validation messages: shape lights") { CHECK(device().validation_messages() == 0); }

}  // namespace shape_lights_tests
