#include "bench/edit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "base/color.h"
#include "base/error.h"

namespace lucerna::bench {
namespace {

using scene::Scene;

std::optional<uint32_t> brightest_lamp(const Scene& s) {
  std::optional<uint32_t> best;
  for (uint32_t i = 0; i < s.lights.size(); ++i)
    if (s.lights[i].enabled &&
        (!best || luminance(s.lights[i].intensity) > luminance(s.lights[*best].intensity)))
      best = i;
  return best;
}

/// The material with the largest product of weight and surface area, of weight above 0.
template <class Weight>
std::optional<uint32_t> heaviest_material(const Scene& s, const Weight& weight) {
  std::vector<double> area(s.materials.size(), 0);
  for (const scene::Instance& i : s.instances)
    for (const scene::Primitive& p : scene::shown_parts(s, i))
      for (const uvec3& t : p.triangles) {
        vec3 v[3];
        for (int k = 0; k < 3; ++k) v[k] = vec3(i.to_world * vec4(p.positions[t[k]], 1));
        area[p.material] += 0.5 * length(cross(v[1] - v[0], v[2] - v[0]));
      }
  std::optional<uint32_t> best;
  double most = 0;
  for (uint32_t m = 0; m < area.size(); ++m)
    if (const double w = area[m] * weight(s.materials[m]); w > most) best = m, most = w;
  return best;
}

/// The opaque diffuse material without textures that has the largest surface.
std::optional<uint32_t> largest_plain_material(const Scene& s) {
  return heaviest_material(s, [](const scene::Material& x) {
    const bool plain = !x.base_color_texture && x.metallic < 1 && x.transmission == 0 && !x.unlit &&
                       luminance(vec3(x.base_color)) > 0 && luminance(x.emission) == 0;
    return plain ? 1.0 : 0.0;
  });
}

/// The material that emits most light.
std::optional<uint32_t> brightest_emitter(const Scene& s) {
  return heaviest_material(
      s, [](const scene::Material& x) { return x.unlit ? 0.0 : double(luminance(x.emission)); });
}

/// Fixed, so that the amounts of a seed stay the same when there are more edits.
constexpr uint64_t k_draws_per_seed = 8;

/// Amounts of edits.
class Draw {
 public:
  Draw(Edit edit, uint64_t seed) : fixed_(seed == 0), bits_(seed * k_draws_per_seed + size_t(edit)) {}

  /// In lo..hi, or `usual` for seed 0.
  float between(float lo, float hi, float usual) {
    const double u = double(bits_() >> 11) * 0x1p-53;
    return fixed_ ? usual : float(lo + u * (hi - lo));
  }
  /// 1 or -1; 1 for seed 0.
  float sign() { return between(-1, 1, 1) < 0 ? -1.0f : 1.0f; }

 private:
  bool fixed_;
  std::mt19937_64 bits_;
};

mat4 turned(float degrees) { return glm::rotate(mat4(1), glm::radians(degrees), vec3(0, 1, 0)); }

}  // namespace

Edit edit_of(const std::string& name) {
  const auto at = std::find(k_edit_names.begin(), k_edit_names.end(), name);
  if (at == k_edit_names.end())
    throw_error("bench latency", "there is no edit '{}'; there are {}", name, fmt::join(k_edit_names, ", "));
  return Edit(at - k_edit_names.begin());
}

std::optional<Change> change_of(Edit edit, const Scene& s, const scene::Camera& camera, uint64_t seed) {
  const Box box = scene::bounds(s);
  const float radius = 0.5f * length(box.hi - box.lo);
  Draw draw(edit, seed);
  Change c;
  if (edit == Edit::camera) {
    c.camera = camera;
    const float aside = draw.sign() * draw.between(0.005f, 0.04f, 0.02f) * radius;
    const float turn = draw.sign() * draw.between(4, 20, 12);
    c.camera->to_world =
        glm::translate(mat4(1), aside * vec3(camera.to_world[0])) * camera.to_world * turned(turn);
  } else if (edit == Edit::strength || edit == Edit::move) {
    const float factor = std::exp2(draw.sign() * draw.between(-2, -0.7f, std::log2(1 / 3.0f)));
    const std::optional<uint32_t> lamp = brightest_lamp(s);
    if (!lamp) {
      const std::optional<uint32_t> emitter = brightest_emitter(s);
      if (!emitter || edit == Edit::move) return std::nullopt;
      scene::Material other = s.materials[*emitter];
      other.emission *= factor;
      c.material = {*emitter, other};
      return c;
    }
    scene::Light light = s.lights[*lamp];
    if (edit == Edit::strength)
      light.intensity *= factor;
    else if (light.kind == scene::LightKind::directional)
      light.direction = vec3(turned(draw.sign() * draw.between(8, 40, 25)) * vec4(light.direction, 0));
    else
      light.position += draw.sign() * draw.between(0.03f, 0.2f, 0.1f) * radius * vec3(camera.to_world[0]);
    c.light = {*lamp, light};
  } else if (edit == Edit::sky) {
    if (s.environment.image == scene::k_none) return std::nullopt;
    c.environment = {s.environment.scale, s.environment.rotation + draw.between(20, 340, 90)};
  } else if (edit == Edit::material) {
    const std::optional<uint32_t> index = largest_plain_material(s);
    if (!index) return std::nullopt;
    scene::Material other = s.materials[*index];
    const auto channel = [&](float usual) { return draw.between(0.1f, 0.8f, usual); };
    const float r = channel(0.7f), g = channel(0.15f), b = channel(0.1f);
    other.base_color = vec4(r, g, b, other.base_color.w);
    c.material = {*index, other};
  }
  return c;
}

Change reverse_of(const Change& change, const Scene& s, const scene::Camera& camera) {
  Change back;
  if (change.camera) back.camera = camera;
  if (change.light) back.light = {change.light->first, s.lights[change.light->first]};
  if (change.environment) back.environment = {s.environment.scale, s.environment.rotation};
  if (change.material) back.material = {change.material->first, s.materials[change.material->first]};
  return back;
}

}  // namespace lucerna::bench
