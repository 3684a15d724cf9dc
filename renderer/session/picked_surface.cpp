#include "session/picked_surface.h"

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace lucerna::session {
namespace {

float wrapped(float u, scene::Wrap wrap) {
  switch (wrap) {
    case scene::Wrap::clamp:
      return std::clamp(u, 0.0f, 1.0f);
    case scene::Wrap::mirror:
      return std::abs(std::remainder(u, 2.0f));
    case scene::Wrap::repeat:
      break;
  }
  return u - std::floor(u);
}

}  // namespace

vec4 texel_at(const scene::Scene& scene, const scene::TextureUse& use, const vec2& uv) {
  if (!use) return vec4(1);
  const scene::Texture& texture = scene.textures[use.texture];
  if (texture.image >= scene.images.size()) return vec4(1);
  const scene::Image& image = scene.images[texture.image];
  if (image.width == 0 || image.height == 0) return vec4(1);
  const auto& m = use.m;
  float u = m[0] * uv.x + m[1] * uv.y + m[2], v = m[3] * uv.x + m[4] * uv.y + m[5];
  if (!std::isfinite(u) || !std::isfinite(v)) return vec4(1);
  u = wrapped(u, texture.wrap_u), v = wrapped(v, texture.wrap_v);
  const auto column = std::min(static_cast<uint32_t>(u * static_cast<float>(image.width)), image.width - 1);
  const auto row = std::min(static_cast<uint32_t>(v * static_cast<float>(image.height)), image.height - 1);
  const size_t texel = (size_t{row} * image.width + column) * 4;
  vec4 value(1);
  for (int c = 0; c < 4; ++c) {
    const size_t at = texel + static_cast<size_t>(c);
    if (at < image.floats.size()) value[c] = image.floats[at];
    if (at >= image.bytes.size()) continue;
    value[c] = static_cast<float>(image.bytes[at]) / 255;
    if (texture.srgb && c < 3) value[c] = linear_from_srgb(value[c]);
  }
  return value;
}

PickedSurface surface_at(const scene::Scene& scene, const Picked& picked) {
  const scene::Instance& instance = scene.instances[picked.instance];
  const scene::Primitive& p = scene.meshes[instance.mesh].primitives[picked.primitive];
  const scene::Material& m = scene.materials[picked.material];
  const uvec3& t = p.triangles[picked.triangle];
  const float b = picked.barycentric.x, c = picked.barycentric.y, a = 1 - b - c;
  const auto between = [&](const auto& values) {
    return a * values[t.x] + b * values[t.y] + c * values[t.z];
  };
  const auto texel = [&](const scene::TextureUse& use) {
    const std::vector<vec2>& uv = use.uv_set == 1 ? p.uv1 : p.uv0;
    return uv.empty() ? vec4(1) : texel_at(scene, use, between(uv));
  };
  PickedSurface s{.normal = picked.normal};
  if (!p.normals.empty()) {
    const vec3 n = glm::transpose(glm::inverse(glm::mat3(instance.to_world))) * between(p.normals);
    const float length = glm::length(n);
    // A vertex normal that looks away from the geometric one on this side is of no use.
    if (length > 0 && std::abs(glm::dot(n, picked.normal)) > 1e-3f * length)
      s.normal = glm::dot(n, picked.normal) > 0 ? n / length : -n / length;
  }
  s.base_color = vec3(m.base_color) * vec3(texel(m.base_color_texture));
  if (!p.colors.empty()) s.base_color *= vec3(between(p.colors));
  const vec4 rough = texel(m.metallic_roughness_texture);
  s.roughness = m.roughness * rough.y;
  s.metallic = m.metallic * rough.z;
  s.clearcoat = m.clearcoat * texel(m.clearcoat_texture).x;
  s.coat_roughness = m.clearcoat_roughness * texel(m.clearcoat_roughness_texture).y;
  return s;
}

}  // namespace lucerna::session
