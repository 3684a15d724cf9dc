// links: session
// Light through stacks of surfaces that transmit it undeflected: smooth thin panes and partly covered
// surfaces (alpha), in any order and in front of other objects. At normal incidence a stack transmits and
// reflects the product of its surfaces' shares, including all reflections between them, so the pictures have
// closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/render.h"
#include "support/rooms.h"

namespace null_events_tests {

using namespace lucerna;
using glm::dvec2;

namespace {

/// Transmitted and reflected share of a surface, in red and blue.
struct Share {
  dvec2 passes{0}, reflects{0};
};
/// A surface perpendicular to the light, or a solid with two such surfaces.
struct Layer {
  scene::Material material;
  std::vector<Share> shares;  ///< from front to back
  bool solid = false;
};

double mirror(double ior) { return (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1)); }
/// Both sides of a pane, including internal reflections.
double slab(double r) { return 2 * r / (1 + r); }
dvec2 red_blue(const vec3& c) { return {c.x, c.z}; }

Layer pane(const vec3& tint = vec3(1), float ior = 1.5f, float metallic = 0) {
  Layer l;
  l.material.base_color = vec4(tint, 1);
  l.material.roughness = 0, l.material.metallic = metallic, l.material.ior = ior, l.material.transmission = 1;
  const double r = slab(mirror(ior)), glass = 1 - metallic;
  l.shares = {{glass * (1 - r) * red_blue(tint), glass * dvec2(r) + double(metallic) * red_blue(tint)}};
  return l;
}
/// The layer with that coverage.
Layer partly(double coverage, Layer l) {
  l.material.alpha_mode = scene::AlphaMode::blend;
  l.material.base_color.w = float(coverage);
  for (Share& s : l.shares) s = {1 - coverage + coverage * s.passes, coverage * s.reflects};
  return l;
}
/// A black surface with that coverage.
Layer leaf(double coverage) { return partly(coverage, {test::diffuse(vec3(0)), {Share{}}}); }
/// A black surface with a mask: coverage 0 or 1.
Layer mask(float alpha, float cutoff) {
  Layer l = partly(alpha < cutoff ? 0 : 1, {test::diffuse(vec3(0)), {Share{}}});
  l.material.alpha_mode = scene::AlphaMode::mask, l.material.base_color.w = alpha;
  l.material.alpha_cutoff = cutoff;
  return l;
}
/// A smooth coat of ior 1.5 over green, a colour that is not measured.
Layer coat() {
  Layer l{test::diffuse({0, 0.8f, 0}), {{dvec2(0), dvec2(0.04)}}};
  l.material.roughness = 0, l.material.specular = 1;
  return l;
}
constexpr float k_solid_depth = 0.01f;
/// A plate of clear glass that absorbs half of the red and a fifth of the blue light.
Layer plate() {
  Layer l;
  l.material.base_color = vec4(1);
  l.material.roughness = 0, l.material.metallic = 0, l.material.transmission = 1, l.material.thickness = 1;
  l.material.attenuation_color = {0.5f, 1, 0.8f}, l.material.attenuation_distance = k_solid_depth;
  const Share face{dvec2(0.96), dvec2(0.04)};
  l.shares = {face, {dvec2(0.5, 0.8), dvec2(0)}, face};
  l.solid = true;
  return l;
}

using Stack = std::vector<Layer>;
Stack operator+(Stack a, const Stack& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
Stack operator*(int times, const Stack& of) {
  Stack s;
  for (int i = 0; i < times; ++i) s = s + of;
  return s;
}

std::vector<Share> shares_of(const Stack& stack) {
  std::vector<Share> all;
  for (const Layer& l : stack) all.insert(all.end(), l.shares.begin(), l.shares.end());
  return all;
}
/// A stack of surfaces, each the same from both sides, with any number of reflections between them.
Share together(const Stack& stack) {
  Share sum{dvec2(1), dvec2(0)};
  dvec2 from_behind(0);
  for (const Share& s : shares_of(stack)) {
    const dvec2 between = 1.0 / (1.0 - from_behind * s.reflects);
    sum.reflects += sum.passes * sum.passes * s.reflects * between;
    from_behind = s.reflects + s.passes * s.passes * from_behind * between;
    sum.passes *= s.passes * between;
  }
  return sum;
}
/// The same with at most one reflection.
Share together_once(const Stack& stack) {
  Share sum{dvec2(1), dvec2(0)};
  for (const Share& s : shares_of(stack)) {
    sum.reflects += sum.passes * sum.passes * s.reflects;
    sum.passes *= s.passes;
  }
  return sum;
}

constexpr uint32_t k_cell = 16, k_across = 4;
constexpr float k_apart = 0.02f;

/// Stacks side by side, seen along -z; red behind them all, blue behind the camera.
scene::Scene stacks_scene(const std::vector<Stack>& stacks) {
  scene::Scene s;
  s.name = "stacks", s.file = "stacks.gltf";
  s.environment.given = true;
  s.materials = {test::diffuse(vec3(0), {1, 0, 0}), test::diffuse(vec3(0), {0, 0, 1})};
  const float side = k_across, low = -side / 2;
  test::add_quad(s, {low, low, -30}, {side, 0, 0}, {0, side, 0}, 0);
  test::add_quad(s, {low, low, 20}, {0, side, 0}, {side, 0, 0}, 1);
  for (size_t i = 0; i < stacks.size(); ++i) {
    const vec3 corner(low + float(i % k_across), -low - 1 - float(i / k_across), 0);
    float depth = 0;
    for (const Layer& l : stacks[i]) {
      const auto material = scene::Id(s.materials.size());
      s.materials.push_back(l.material);
      test::add_quad(s, corner - vec3(0, 0, depth), {1, 0, 0}, {0, 1, 0}, material);
      if (l.solid)
        test::add_quad(s, corner - vec3(0, 0, depth + k_solid_depth), {0, 1, 0}, {1, 0, 0}, material);
      depth += k_apart;
    }
  }
  scene::Camera c;
  c.orthographic = true, c.xmag = c.ymag = side / 2;
  c.to_world[3] = vec4(0, 0, 10, 1);
  s.cameras = {c};
  return s;
}

/// Checks every stack's red (transmitted) and blue (reflected) light. Each path contributes a value from 0 to
/// 1, so the variance is at most that of a Bernoulli variable. |z| < 4.5 for about 30 numbers: a false alarm
/// in 5000.
void check_stacks(const std::vector<Stack>& stacks, const test::Settings& settings,
                  Share (*expected_of)(const Stack&)) {
  constexpr uint32_t k_samples = 64, k_size = k_cell * k_across;
  const film::Image image = test::render(stacks_scene(stacks), settings, k_samples, k_size).image;
  for (size_t i = 0; i < stacks.size(); ++i) {
    dvec2 mean(0);
    for (uint32_t k = 0; k < k_cell * k_cell; ++k) {
      const size_t x = i % k_across * k_cell + k % k_cell, y = i / k_across * k_cell + k / k_cell;
      mean += red_blue(test::sum_at(image, y * k_size + x)) / double(k_cell * k_cell);
    }
    const Share expected = expected_of(stacks[i]);
    for (const int channel : {0, 1}) {
      const double p = channel == 0 ? expected.passes.x : expected.reflects.y;
      const double error = std::sqrt(p * (1 - p) / (k_samples * k_cell * k_cell));
      INFO("stack " << i << (channel == 0 ? " passes " : " reflects ") << mean[channel] << " of " << p
                    << " +- " << error);
      CHECK(std::abs(mean[channel] - p) < 4.5 * error + 1e-5);
    }
  }
}

}  // namespace

TEST_CASE("stacks of panes, leaves, coats and glass transmit and reflect the product of their shares") {
  const Stack blue = {pane({0.4f, 0.6f, 0.9f})}, clear = {pane()},
              gilt = {pane({0.9f, 0.7f, 0.5f}, 1.8f, 0.3f)};
  const Stack third = {leaf(0.3)}, half = {leaf(0.5)}, half_pane = {partly(0.5, pane())};
  check_stacks(
      {clear + Stack{mask(0.6f, 0.5f)} + clear, 2 * clear, 3 * clear, 20 * clear,
       third + clear + Stack{mask(0.4f, 0.5f)} + third, 2 * (clear + half), 20 * Stack{leaf(0.1)},
       5 * (clear + blue + Stack{leaf(0.05)} + half_pane), clear + Stack{coat()},
       2 * clear + third + Stack{coat()}, clear + Stack{plate()}, third + clear + Stack{plate()} + clear,
       Stack{plate()} + clear + Stack{coat()}, 3 * gilt, 600 * Stack{leaf(0.005)},
       5 * (clear + Stack{leaf(0.1)}) + half_pane + Stack{plate(), coat()}},
      {}, together);
}

TEST_CASE("undeflected transmission is no event: the maximum depth does not count it") {
  const Stack clear = {pane()}, half_pane = {partly(0.5, pane())}, third = {leaf(0.3)};
  check_stacks({1 * clear, 2 * clear + Stack{coat()}, 3 * half_pane + Stack{coat()},
                third + clear + third + Stack{pane({0.4f, 0.6f, 0.9f})}},
               {{"path.max_depth", "1"}}, together_once);
}

TEST_CASE("light samples pass everything that paths pass") {
  // A lamp above a stack of wide layers above a floor; the camera between stack and floor sees a spot of the
  // floor.
  constexpr int k_layers = 20;
  for (const float aside : {0.0f, 4.0f}) {
    scene::Scene s;
    s.name = "stack", s.file = "stack.gltf";
    s.environment.given = true;
    s.materials = {test::diffuse({0.8f, 0.5f, 0.2f}), pane({0.7f, 0.8f, 0.9f}, 1.6f).material,
                   leaf(0.07).material};
    const vec3 corner(-20, -20, 0), u(40, 0, 0), v(0, 40, 0);
    test::add_quad(s, corner - vec3(0, 0, 2), u, v, 0);
    for (int k = 0; k < k_layers; ++k)
      test::add_quad(s, corner + vec3(0, 0, k_apart * float(k)), u, v, 1 + k % 2);
    s.lights.push_back({.name = "lamp", .intensity = vec3(10, 20, 30), .position = {aside, 0, 2}});
    scene::Camera c;
    c.yfov = 1e-3f;
    c.to_world[3] = vec4(0, 0, -1, 1);
    s.cameras = {c};
    const film::Image image = test::render(s, {}, 4, 8).image;
    const double distance2 = aside * aside + 16.0, cosine = 4 / std::sqrt(distance2);
    // Fresnel's equations, by the angles on both sides.
    const double i = std::acos(cosine), t = std::asin(std::sin(i) / 1.6);
    const double r = aside == 0 ? mirror(1.6)
                                : 0.5 * (std::pow(std::sin(i - t) / std::sin(i + t), 2) +
                                         std::pow(std::tan(i - t) / std::tan(i + t), 2));
    for (int c3 = 0; c3 < 3; ++c3) {
      const double passed =
          std::pow((1 - slab(r)) * s.materials[1].base_color[c3] * (1 - 0.07), k_layers / 2);
      const double expected =
          s.materials[0].base_color[c3] / k_pi * s.lights[0].intensity[c3] / distance2 * cosine * passed;
      for (const vec3& pixel : image.components[0]) CHECK(pixel[c3] == Approx(expected).epsilon(2e-3));
    }
  }
}

TEST_CASE("an unlit surface hides what is behind it from paths and from light samples") {
  scene::Scene s;
  s.name = "unlit", s.file = "unlit.gltf";
  s.environment.given = true;
  s.materials = {test::diffuse(vec3(0.5f)), pane().material};
  s.materials[1].unlit = true;
  test::add_quad(s, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, 0);
  test::add_quad(s, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1);
  s.lights.push_back({.name = "lamp", .intensity = vec3(10), .position = {0, 0, 2}});
  scene::Camera c;
  c.yfov = 0.5f;
  c.to_world[3] = vec4(0, 0, -1, 1);
  s.cameras = {c};
  const film::Image image = test::render(s, {}, 4, 8).image;
  for (const vec3& pixel : image.components[0]) CHECK(pixel == vec3(0));
}

}  // namespace null_events_tests
