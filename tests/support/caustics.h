#pragma once
// For tests of light focused by mirrors and glass, by any solver: a scene with a closed form, and means of a
// component with their noise.
#include "support/render.h"
#include "support/rooms.h"

namespace lucerna::test {

inline Settings with(Settings settings, const Settings& more) {
  for (const auto& [key, value] : more) settings[key] = value;
  return settings;
}

/// A sun along +x that a mirror of that colour reflects straight down onto a floor, which it lights evenly.
inline scene::Scene turned_sun(const vec3& mirror = {0.9f, 0.8f, 0.7f}) {
  scene::Scene s;
  s.name = "turned sun";
  s.materials = {diffuse({0.8f, 0.5f, 0.2f}), {}};
  s.materials[1].metallic = 1, s.materials[1].roughness = 0, s.materials[1].base_color = vec4(mirror, 1);
  s.materials[1].double_sided = true;
  add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0);
  add_quad(s, {-1, 3, -1}, {2, -2, 0}, {0, 0, 2}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = {3, 4, 5}}};
  s.lights[0].direction = {1, 0, 0};
  s.cameras = {looking_down({0, 0.9f, 0}, 0.8f)};
  s.environment.given = true;
  return s;
}

struct MeanOf {
  glm::dvec3 value{0}, noise{0};
};
/// Mean of a component over some pixels; its noise from the two halves, which contain separate passes if
/// light comes in passes, so correlation between neighbouring pixels is included.
inline MeanOf mean_of(const film::Image& image, int component, uint32_t x0, uint32_t y0, uint32_t x1,
                      uint32_t y1) {
  MeanOf m;
  glm::dvec3 odd(0), squares(0);
  const double n = double(x1 - x0) * (y1 - y0);
  for (uint32_t y = y0; y < y1; ++y)
    for (uint32_t x = x0; x < x1; ++x) {
      const size_t i = size_t{y} * image.width + x;
      const glm::dvec3 all(image.components[size_t(component)][i]),
          half(image.odd_half[size_t(component)][i]);
      m.value += all / n, odd += half / n;
      squares += (all - half) * (all - half);
    }
  m.noise = glm::max(glm::abs(m.value - odd), glm::sqrt(squares) / n);
  return m;
}
inline MeanOf mean_of(const film::Image& image, int component) {
  return mean_of(image, component, 0, 0, image.width, image.height);
}

}  // namespace lucerna::test
