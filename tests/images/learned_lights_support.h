#pragma once
// Shared by tests of learned lights: a room with a window, environments, and pictures with either way of
// choosing lights.
#include <limits>

#include "images/light_mix_support.h"
#include "support/rooms.h"

namespace lucerna::test {

/// Without a search for openings, unless `settings` has it.
inline Result with(const scene::Scene& s, const char* how, uint32_t samples, Settings settings = {},
                   uint32_t size = 32) {
  settings["lights.sampling"] = how;
  settings.insert({"lights.portals", "marked"});
  return render(s, settings, samples, size, false);
}

/// Variance of primary light after 16 samples, up to a common factor.
inline double noise(const scene::Scene& s, const char* how, Settings settings = {}) {
  for (const char* c : {"components.secondary", "components.tertiary", "components.caustic"})
    settings[c] = "off";
  const film::Image image = with(s, how, 16, settings, 96).image;
  double sum = 0;
  for (size_t i = 0; i < image.components[0].size(); ++i) {
    const double d = luminance(image.components[0][i]) - luminance(image.odd_half[0][i]);
    sum += d * d;
  }
  return sum;
}

/// A room under that environment with one opening of `wide` metres in its wall, seen from above.
inline scene::Scene window_room(scene::Image sky, bool pane, float wide = 0.5f) {
  scene::Scene s;
  s.name = "window", s.file = "window.gltf";
  s.materials = {diffuse(vec3(0.6f))};
  s.materials[0].double_sided = true;
  const float low = 0.5f - 0.5f * wide, high = 0.5f + 0.5f * wide;
  const vec3 x(2, 0, 0), y(0, 1, 0), z(0, 0, 2), o(-1, 0, -1);
  add_quad(s, o, z, x);
  add_quad(s, o + y, x, z);
  add_quad(s, o, x, y);
  add_quad(s, o + z, y, x);
  add_quad(s, o, y, z);
  // The wall with the opening.
  const vec3 w = o + x;
  add_quad(s, w, z * low, y);
  add_quad(s, w + z * high, z * (1 - high), y);
  add_quad(s, w + z * low, z * (high - low), y * 0.3f);
  add_quad(s, w + z * low + y * 0.8f, z * (high - low), y * 0.2f);
  if (pane) {
    scene::Material glass;
    glass.base_color = vec4(0.9f, 1, 0.8f, 1), glass.metallic = 0, glass.roughness = 0,
    glass.transmission = 1;
    s.materials.push_back(glass);
    add_quad(s, w + z * low + y * 0.3f, z * (high - low), y * 0.5f, 1);
  }
  s.cameras = {looking_down({-0.1f, 0.97f, 0}, 1.5f)};
  s.environment.given = true;
  if (!sky.floats.empty()) s.images.push_back(std::move(sky)), s.environment.image = 0;
  return s;
}

inline scene::Image sky(bool bad = false) {
  scene::Image image;
  image.name = "sky", image.width = 32, image.height = 16;
  for (int i = 0; i < 32 * 16; ++i) {
    const float value = i / 32 < 9 ? 1 + 0.2f * float(i % 7) : 0.1f;
    image.floats.insert(image.floats.end(), {value, 0.9f * value, 1.2f * value, 1});
  }
  if (bad) {
    image.floats[4 * (3 * 32 + 5)] = 1e7f;
    image.floats[4 * (2 * 32 + 9) + 1] = std::numeric_limits<float>::quiet_NaN();
    image.floats[4 * (4 * 32 + 1) + 2] = -50;
    image.floats[4 * (5 * 32 + 15)] = std::numeric_limits<float>::infinity();
  }
  return image;
}

}  // namespace lucerna::test
