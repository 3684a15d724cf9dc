// links: upload
// Directions through portals: the density integrates to 1 over what is seen through the rectangle, draws
// follow it, and the density of a draw is the density returned for hitting the sky in that direction.
#include <array>
#include <catch2/catch.hpp>

#include "kernels/light_support.h"
#include "shaders/shared/portals.h"

namespace portals_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

struct Through {
  vec3 direction;
  float pdf, again;
  uint32_t portal;
};

/// Portals of a scene on the device.
class Portals {
 public:
  explicit Portals(const scene::Scene& scene)
      : flat(upload::flatten(scene)), scene_(device(), flat, {}), portals(scene.portals) {
    frame.light_count = uint32_t(flat.lights.size() / shared::k_light_texels);
    frame.environment_radiance = flat.environment_radiance;
    frame.environment_width = flat.environment_width, frame.environment_height = flat.environment_height;
    frame.environment_rotation = flat.environment_rotation;
    frame.environment_light_pmf = flat.environment_light_pmf;
    frame_.write(&frame, sizeof frame);
    scene_.bind(resources_);
    resources_.set("FrameBlock", frame_);
  }
  std::vector<Through> draw(uint32_t portal, const vec3& from, uint32_t count) {
    return run("0", portal, from, count);
  }
  std::vector<Through> light(const vec3& from, uint32_t count) { return run("2", 0, from, count); }
  std::vector<Through> pdf(uint32_t portal, const vec3& from, const std::vector<vec3>& directions) {
    std::vector<vec4> questions;
    for (const vec3& d : directions) questions.emplace_back(d, 0);
    questions_ = gpu::Buffer(device(), {"questions", questions.size() * sizeof(vec4)});
    questions_.write(std::span<const vec4>(questions));
    return run("1", portal, from, uint32_t(directions.size()));
  }

  upload::FlatScene flat;
  shared::Frame frame{};

 private:
  struct Push {
    uint32_t count, portal;
    vec3 position;
  };
  std::vector<Through> run(const char* what, uint32_t portal, const vec3& from, uint32_t count) {
    static gpu::ShaderCompiler compiler;
    gpu::Defines defines = scene_.defines();
    defines["TEST_ASK"] = what;
    const gpu::Kernel kernel(device(), compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/portal_probe.comp",
                             defines);
    const gpu::Buffer results(device(), {"answers", count * sizeof(Through)});
    resources_.set("Questions", questions_);
    resources_.set("Answers", results);
    gpu::Stream stream(device());
    stream.dispatch(kernel, resources_, Push{count, portal, from}, gpu::groups_for(count, 64));
    stream.run();
    return results.read_all<Through>();
  }

  upload::DeviceScene scene_;
  gpu::Buffer frame_{device(), {"frame", sizeof(shared::Frame)}};
  gpu::Buffer questions_{device(), {"questions", 16}};
  gpu::Resources resources_;

 public:
  std::vector<scene::Portal> portals;
};

/// Three portals under a sky with a sun: one turned about all axes, one that faces up into a floor, and one
/// that overlaps the first.
scene::Scene openings(scene::Scene s) {
  const vec3 x = glm::normalize(vec3(1, 0.2f, -0.3f)),
             y = glm::normalize(glm::cross(vec3(0.1f, -0.3f, 1), x));
  s.portals.push_back({"first", {0, 2, -3}, 1.2f * x, 0.7f * y});
  s.portals.push_back({"hatch", {2, 0, 2}, {0, 0, 0.5f}, {0.4f, 0, 0}});
  s.portals.push_back({"other", {0.5f, 2.1f, -3.1f}, 0.9f * x, 0.8f * y});
  return s;
}

double jacobian(double mx, double my) {
  const double x = mx / (1 - std::abs(mx)), y = my / (1 - std::abs(my));
  return std::pow((1 + std::abs(x)) * (1 + std::abs(y)), 2) / std::pow(1 + x * x + y * y, 1.5);
}
double map_of(double x) { return x / (1 + std::abs(x)); }

/// One axis of the part of a map that is seen from a point: midpoints of intervals within texels, because the
/// density has steps between texels and at the rectangle's border.
struct Axis {
  struct Place {
    double m, width;
    int texel;
  };
  Axis(double low, double high) {
    constexpr double k_side = shared::k_portal_side;
    low = (0.5 + 0.5 * low) * k_side, high = (0.5 + 0.5 * high) * k_side;
    first = int(low), end = int(std::ceil(high));
    for (int texel = first; texel < end; ++texel) {
      const double a = std::max(low, double(texel)), b = std::min(high, texel + 1.0);
      constexpr int k_points = 4;
      for (int i = 0; i < k_points; ++i)
        places.push_back(
            {2 * (a + (b - a) * (i + 0.5) / k_points) / k_side - 1, 2 * (b - a) / k_points / k_side, texel});
    }
  }
  int bin(int texel, int bins) const {
    return std::clamp((texel - first) * bins / (end - first), 0, bins - 1);
  }
  int first, end;
  std::vector<Place> places;
};

/// What is seen of a portal from a point.
struct View {
  View(const scene::Portal& p, const vec3& from)
      : s(glm::normalize(p.half_width)),
        t(glm::normalize(p.half_height)),
        n(glm::cross(s, t)),
        off(glm::dvec3(from) - glm::dvec3(p.centre)),
        across(axis(s, double(glm::length(p.half_width)))),
        up(axis(t, double(glm::length(p.half_height)))) {}
  Axis axis(const glm::dvec3& along, double half) const {
    const double height = glm::dot(off, n), at = glm::dot(off, along);
    return {map_of((-half - at) / height), map_of((half - at) / height)};
  }
  vec3 direction(double mx, double my) const {
    return glm::normalize(mx / (1 - std::abs(mx)) * s + my / (1 - std::abs(my)) * t - n);
  }
  glm::dvec3 s, t, n, off;
  Axis across, up;
};

const std::array<vec3, 4> k_points = {
    vec3(0.3f, 1, 1), {-0.5f, 2.2f, -2.6f}, {3, 0.1f, 9}, {0.2f, 1.9f, -2.9f}};

}  // namespace

TEST_CASE("the density through a portal integrates to 1 and draws follow it") {
  for (const bool constant : {false, true}) {
    scene::Scene s = constant ? scene::Scene{} : sky(128, 64, 40);
    if (constant) s.environment.radiance = vec3(2), s.environment.given = true;
    Portals portals(openings(s));
    REQUIRE(portals.flat.effects.portals == 3);
    Jury jury;
    for (const vec3& from : k_points) {
      INFO(constant << " " << from.x);
      const View view(portals.portals[0], from);
      std::vector<vec3> directions;
      for (const Axis::Place& y : view.up.places)
        for (const Axis::Place& x : view.across.places) directions.push_back(view.direction(x.m, y.m));
      const std::vector<Through> answers = portals.pdf(0, from, directions);
      constexpr int k_bins = 16;
      const auto bin = [&](int x, int y) {
        return size_t(view.up.bin(y, k_bins) * k_bins + view.across.bin(x, k_bins));
      };
      double integral = 0;
      std::vector<double> expected(k_bins * k_bins, 0.0), observed(expected.size(), 0.0);
      size_t i = 0;
      for (const Axis::Place& y : view.up.places)
        for (const Axis::Place& x : view.across.places) {
          const double part = double(answers[i++].pdf) * jacobian(x.m, y.m) * x.width * y.width;
          integral += part;
          expected[bin(x.texel, y.texel)] += part;
        }
      CHECK(integral == Approx(1).epsilon(1e-3));
      constexpr uint32_t k_draws = 1 << 16;
      size_t apart = 0, outside = 0;
      for (const Through& a : portals.draw(0, from, k_draws)) {
        apart += !(a.pdf > 0) || std::abs(a.again / a.pdf - 1) > 1e-4f;
        const glm::dvec3 d(a.direction);
        const double height = -glm::dot(d, view.n);
        const auto texel = [&](const glm::dvec3& along) {
          return (0.5 + 0.5 * map_of(glm::dot(d, along) / height)) * shared::k_portal_side;
        };
        const double x = texel(view.s), y = texel(view.t);
        outside += !(height > 0 && x > view.across.first - 0.01 && x < view.across.end + 0.01 &&
                     y > view.up.first - 0.01 && y < view.up.end + 0.01);
        observed[bin(int(x), int(y))] += 1;
      }
      CHECK(outside == 0);
      // At borders of texels rounding can give the neighbour.
      CHECK(apart < k_draws / 500);
      for (double& e : expected) e *= k_draws / integral;
      jury.add("directions", chi_square(observed, expected).p);
    }
    CHECK(jury.verdict() == "");
  }
}

TEST_CASE("the solid angle through a portal under a constant sky is that of the rectangle") {
  scene::Scene s;
  s.environment.radiance = vec3(1), s.environment.given = true;
  Portals portals(openings(s));
  const scene::Portal& p = portals.portals[0];
  for (const vec3& from : k_points) {
    // By an integral over the rectangle's area, which does not know the map.
    constexpr int k_grid = 400;
    double solid_angle = 0;
    const double area = double(area_of(p)) / k_grid / k_grid;
    for (int i = 0; i < k_grid * k_grid; ++i) {
      const float a = 2 * (float(i % k_grid) + 0.5f) / k_grid - 1,
                  b = 2 * (float(i / k_grid) + 0.5f) / k_grid - 1;
      const glm::dvec3 to(p.centre + a * p.half_width + b * p.half_height - from);
      const double d2 = glm::dot(to, to);
      solid_angle += area * std::abs(glm::dot(to / std::sqrt(d2), glm::dvec3(normal_of(p)))) / d2;
    }
    // The mean of 1 / density over draws is the solid angle.
    double mean = 0;
    const std::vector<Through> draws = portals.draw(0, from, 1 << 16);
    for (const Through& a : draws) mean += 1 / double(a.pdf) / double(draws.size());
    CHECK(mean == Approx(solid_angle).epsilon(5e-3));
  }
}

TEST_CASE("nothing is sampled from behind a portal and in its plane") {
  Portals portals(openings(sky(128, 64, 0)));
  const scene::Portal& p = portals.portals[1];
  for (const vec3& from :
       {p.centre - vec3(0, 1, 0), p.centre, p.centre + vec3(3, 0, 0), p.centre - vec3(0.1f, 2, 9)}) {
    for (const Through& a : portals.draw(1, from, 512)) {
      REQUIRE(a.pdf == 0);
      REQUIRE(std::abs(glm::length(a.direction) - 1) < 1e-4f);
    }
    std::vector<vec3> directions;
    for (int i = 0; i < 512; ++i) {
      const float z = 1 - (2 * float(i) + 1) / 512, phi = 2.4f * float(i);
      directions.push_back(vec3(std::cos(phi), 0, std::sin(phi)) * std::sqrt(1 - z * z) + vec3(0, z, 0));
    }
    for (const Through& a : portals.pdf(1, from, directions)) REQUIRE(a.pdf == 0);
  }
  // The sky below the horizon of this map is dark: the hatch has no share.
  CHECK(portals.flat.portals.shares[1] < 0.05);
}

TEST_CASE("the density of a light sample by power is the sum over all ways to draw it") {
  for (const bool constant : {false, true}) {
    scene::Scene s = constant ? scene::Scene{} : sky(128, 64, 100);
    if (constant) s.environment.radiance = vec3(2), s.environment.given = true;
    Portals portals(openings(s));
    for (const vec3& from : k_points) {
      constexpr uint32_t k_draws = 1 << 17;
      size_t apart = 0, through = 0;
      double solid_angle = 0;
      for (const Through& a : portals.light(from, k_draws)) {
        if (!(a.pdf > 0)) continue;
        apart += std::abs(a.again / a.pdf - 1) > 1e-4f;
        through += a.portal < 3;
        solid_angle += 1 / double(a.pdf) / k_draws;
      }
      CHECK(apart < k_draws / 500);
      CHECK(through > k_draws / 5);
      // The integral of 1 over all directions that are sampled. Its standard error is below 0.4 %.
      if (constant) CHECK(solid_angle == Approx(2 * k_tau).epsilon(0.02));
    }
  }
}

}  // namespace portals_tests
