#include "scene/hash.h"

#include <optional>

#include "base/hash.h"

// Structures are decomposed by structured bindings: a new field does not compile until it is handled here.
namespace lucerna::scene {
namespace {

template <class... Values>
void add_all(Hash& hash, const Values&... values) {
  (hash.add_value(values), ...);
}

/// Hashes of images, each found once.
class Images {
 public:
  explicit Images(const Scene& scene) : scene_(scene), known_(scene.images.size()) {}

  uint64_t of(Id id) {
    if (id >= known_.size()) return 0;
    if (known_[id]) return *known_[id];
    const auto& [name, width, height, bytes, floats] = scene_.images[id];
    Hash hash;
    add_all(hash, width, height);
    hash.add_values(bytes);
    hash.add_values(floats);
    known_[id] = hash.low();
    return hash.low();
  }
  void add(Hash& hash, const TextureUse& use) {
    const auto& [texture, uv_set, matrix] = use;
    hash.add_value(bool(use));
    if (!use) return;
    add_all(hash, uv_set, matrix);
    const auto& [image, wrap_u, wrap_v, nearest, srgb] = scene_.textures[texture];
    add_all(hash, of(image), wrap_u, wrap_v, nearest, srgb);
  }

 private:
  const Scene& scene_;
  std::vector<std::optional<uint64_t>> known_;
};

uint64_t geometry(const Scene& scene) {
  std::vector<uint64_t> meshes;
  for (const Mesh& mesh : scene.meshes) {
    Hash hash;
    for (const Primitive& primitive : mesh.primitives) {
      const auto& [positions, normals, tangents, uv0, uv1, colors, triangles, variants, material] = primitive;
      hash.add_values(positions);
      hash.add_values(normals);
      hash.add_values(tangents);
      hash.add_values(uv0);
      hash.add_values(uv1);
      hash.add_values(colors);
      hash.add_values(triangles);
      hash.add_value(material);
    }
    meshes.push_back(hash.low());
  }
  Hash hash;
  for (const Instance& instance : scene.instances) {
    const auto& [name, mesh, to_world, flipped, group, hidden, node] = instance;
    if (!hidden) add_all(hash, mesh < meshes.size() ? meshes[mesh] : 0, to_world, flipped);
  }
  if (scene.origin != glm::dvec3(0)) hash.add_value(scene.origin);
  return hash.low();
}

uint64_t materials(const Scene& scene, Images& images) {
  Hash hash;
  for (const Material& m : scene.materials) {
    const auto& [base_color, metallic, roughness, normal_scale, emission, alpha_mode, alpha_cutoff,
                 double_sided, unlit, ior, specular, specular_color, transmission, thickness,
                 attenuation_color, attenuation_distance, dispersion, diffuse_transmission,
                 diffuse_transmission_color, diffuse_roughness, height, deep_relief, shadow_catcher,
                 clearcoat, clearcoat_roughness, clearcoat_normal_scale, sheen_color, sheen_roughness,
                 anisotropy, anisotropy_rotation, iridescence, iridescence_ior, iridescence_minimum,
                 iridescence_maximum] = static_cast<const MaterialFactors&>(m);
    add_all(hash, base_color, metallic, roughness, normal_scale, emission, alpha_mode, alpha_cutoff,
            double_sided, unlit, ior, specular, specular_color, transmission, thickness, attenuation_color,
            attenuation_distance, dispersion, diffuse_transmission, diffuse_transmission_color, clearcoat,
            clearcoat_roughness, clearcoat_normal_scale, sheen_color, sheen_roughness, anisotropy,
            anisotropy_rotation, iridescence, iridescence_ior, iridescence_minimum, iridescence_maximum);
    // What came later counts where it is used, so that results that were stored for other scenes stay valid.
    if (diffuse_roughness != 0) add_all(hash, 'r', diffuse_roughness);
    if (height != 0 || deep_relief) add_all(hash, 'h', height, deep_relief);
    if (shadow_catcher) hash.add_value('c');
    constexpr size_t k_first_slots = 17;
    for (size_t s = 0; s < std::size(k_texture_slots); ++s) {
      const TextureUse& use = m.*k_texture_slots[s].use;
      if (s < k_first_slots || use) images.add(hash, use);
    }
  }
  return hash.low();
}

uint64_t lights(const Scene& scene) {
  Hash hash;
  for (const Light& light : scene.lights) {
    const auto& [name, kind, intensity, position, direction, inner_cone, outer_cone, enabled, group, id, sun,
                 profile, picture, right, width, height, radius, two_sided, visible] = light;
    hash.add_value(enabled);
    if (enabled) add_all(hash, kind, intensity, position, direction, inner_cone, outer_cone);
    if (enabled && profile) {
      add_all(hash, right, profile->rows, profile->columns);
      hash.add_values(profile->intensity);
    }
    if (enabled && picture) {
      add_all(hash, right, picture->width, picture->height);
      hash.add_values(picture->texels);
    }
    if (enabled && has_shape(kind)) add_all(hash, right, width, height, radius, two_sided, visible);
  }
  return hash.low();
}

uint64_t environment(const Scene& scene, Images& images) {
  const auto& [radiance, image, scale, rotation, file, given, sky] = scene.environment;
  Hash hash;
  if (image != k_none)
    add_all(hash, images.of(image), rotation);
  else
    hash.add_value(radiance);
  hash.add_value(scale);
  return hash.low();
}

}  // namespace

LightHash light_hash(const Scene& scene) {
  Images images(scene);
  return {geometry(scene), materials(scene, images), lights(scene), environment(scene, images)};
}

}  // namespace lucerna::scene
