#include "scene/default_light.h"

#include <algorithm>
#include <cmath>

namespace lucerna::scene {
namespace {

bool any(const vec3& c) { return c.x > 0 || c.y > 0 || c.z > 0; }

/// A round light of this angular radius [radians], its edge soft over a fifth of it.
struct Softbox {
  vec3 towards, radiance;
  float radius;
  vec3 seen_from(vec3 direction) const {
    const float angle = std::acos(std::clamp(glm::dot(direction, glm::normalize(towards)), -1.0f, 1.0f));
    const float t = std::clamp((1.1f * radius - angle) / (0.2f * radius), 0.0f, 1.0f);
    return radiance * t * t * (3 - 2 * t);
  }
};

Image studio() {
  const Softbox boxes[] = {{vec3(-0.55f, 0.75f, 0.65f), vec3(5.2f, 5.0f, 4.7f), 0.42f},  // key
                           {vec3(0.9f, 0.25f, 0.55f), vec3(0.9f, 1.0f, 1.15f), 0.55f},   // fill
                           {vec3(0.35f, 0.55f, -0.9f), vec3(2.6f, 2.8f, 3.0f), 0.30f}};  // rim
  Image image;
  image.name = "studio";
  image.width = 256;
  image.height = 128;
  image.floats.reserve(size_t(image.width) * image.height * 4);
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const float phi = (float(x) + 0.5f - 0.5f * float(image.width)) / float(image.width) * 2 * k_pi;
      const float theta = (float(y) + 0.5f) / float(image.height) * k_pi;
      const vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      // Floor to ceiling, without an edge at the horizon.
      const float up = 0.5f + 0.5f * d.y;
      vec3 radiance =
          glm::mix(vec3(0.10f, 0.098f, 0.095f), vec3(0.42f, 0.43f, 0.45f), up * up * (3 - 2 * up));
      for (const Softbox& box : boxes) radiance += box.seen_from(d);
      image.floats.insert(image.floats.end(), {radiance.x, radiance.y, radiance.z, 1});
    }
  return image;
}

}  // namespace

bool has_light(const Scene& scene) {
  const Environment& e = scene.environment;
  if (e.scale > 0 && (e.image != k_none || any(e.radiance))) return true;
  for (const Light& light : scene.lights)
    if (light.enabled && any(light.intensity)) return true;
  for (const Instance& instance : scene.instances)
    for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
      const Material& material = scene.materials[primitive.material];
      if (!material.unlit && any(material.emission) && !material.emission_texture) return true;
    }
  return false;
}

bool add_default_light(Scene& scene) {
  if (scene.environment.given || has_light(scene)) return false;
  const auto unlit = [](const Material& m) { return m.unlit; };
  if (std::all_of(scene.materials.begin(), scene.materials.end(), unlit)) return false;
  scene.environment.image = Id(scene.images.size());
  scene.environment.file = "studio";
  scene.images.push_back(studio());
  scene.warnings.push_back(
      scene.file +
      ": the scene has no light: a studio environment is used (name another in settings.json: "
      "{\"environment\": {\"file\": ..., \"radiance\": ...}})");
  return true;
}

}  // namespace lucerna::scene
