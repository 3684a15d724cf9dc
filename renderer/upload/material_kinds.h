#pragma once
// Kinds of materials by the shading features they need: materials with equal features are of one kind. Hits
// are counted by kind, and shaded by kernels that compile in nothing else (transport/hit_classes.h).
#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "shaders/shared/scene.h"

namespace lucerna::upload {

/// Bits of a set of features. Shading of a material without a bit is bit-identical if that part is not
/// compiled in.
enum MaterialFeature : uint32_t {
  k_feature_specular = 1u << 0,  ///< conductor, or a dielectric's coat
  k_feature_solid_glass = 1u << 1,
  k_feature_thin_glass = 1u << 2,
  k_feature_glass_specular = 1u << 3,  ///< specular factor or colour of glass
  k_feature_diffuse_transmission = 1u << 4,
  k_feature_unlit = 1u << 5,
  k_feature_alpha = 1u << 6,  ///< mask or blend
  k_feature_emission = 1u << 7,
  k_feature_normal_map = 1u << 8,
  k_feature_base_texture = 1u << 9,
  k_feature_metallic_roughness_texture = 1u << 10,
  k_feature_emission_texture = 1u << 11,
  k_feature_specular_texture = 1u << 12,  ///< of factor or colour
  k_feature_transmission_texture = 1u << 13,
  k_feature_diffuse_transmission_texture = 1u << 14,  ///< of factor or colour
  k_feature_light_samples = 1u << 15,                 ///< a lobe that is not a delta
  k_feature_clearcoat = 1u << 16,
  k_feature_clearcoat_texture = 1u << 17,  ///< of strength or roughness
  k_feature_clearcoat_normal = 1u << 18,
  k_feature_sheen = 1u << 19,
  k_feature_sheen_texture = 1u << 20,  ///< of colour or roughness
  k_feature_anisotropy = 1u << 21,
  k_feature_anisotropy_texture = 1u << 22,
  k_feature_iridescence = 1u << 23,
  k_feature_iridescence_texture = 1u << 24,  ///< of strength or thickness
  k_feature_dispersion = 1u << 25,
  k_feature_rough_diffuse = 1u << 26,
  k_feature_diffuse_roughness_texture = 1u << 27,
  k_feature_relief = 1u << 28,
  k_feature_deep_relief = 1u << 29,
  k_feature_catcher = 1u << 30,
  k_all_features = (1u << 31) - 1u,
};

/// Whether it has a coat, sheen, brushing or a thin film: their code needs that of the specular lobe.
bool is_layered(const scene::Material& material);

uint32_t features_of(const scene::Material& material);

/// The kinds of a scene's materials.
struct MaterialKinds {
  /// By kind, from shared::k_kind_first on; kinds beyond the maximum share the last one, which has all
  /// features.
  std::array<uint32_t, shared::k_hit_kinds> features{};
  std::vector<uint32_t> of_material;
};
MaterialKinds material_kinds(const std::vector<scene::Material>& materials);

}  // namespace lucerna::upload
