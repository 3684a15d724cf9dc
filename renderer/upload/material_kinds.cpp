#include "upload/material_kinds.h"

#include <algorithm>

#include "shaders/shared/bsdf_table.h"

namespace lucerna::upload {

bool is_layered(const scene::Material& m) {
  return m.clearcoat > 0 || m.sheen_color != vec3(0) || m.anisotropy > 0 || m.iridescence > 0;
}

uint32_t features_of(const scene::Material& m) {
  const bool glass = m.transmission > 0;
  const bool smooth = m.roughness * m.roughness < shared::k_delta_alpha && !m.metallic_roughness_texture;
  const bool all_metal = m.metallic >= 1 && !m.metallic_roughness_texture;
  const bool all_glass = m.transmission >= 1 && !m.transmission_texture;
  uint32_t features = 0;
  const auto has = [&](uint32_t feature, bool on) { features |= on ? feature : 0u; };
  has(k_feature_specular, m.metallic > 0 || m.specular > 0 || is_layered(m));
  has(k_feature_solid_glass, glass && m.thickness > 0);
  has(k_feature_thin_glass, glass && m.thickness <= 0);
  has(k_feature_glass_specular,
      glass && (m.specular != 1 || m.specular_color != vec3(1) || m.specular_texture ||
                m.specular_color_texture || m.iridescence > 0));
  has(k_feature_diffuse_transmission, m.diffuse_transmission > 0);
  has(k_feature_unlit, m.unlit);
  has(k_feature_alpha, m.alpha_mode != scene::AlphaMode::opaque || m.shadow_catcher);
  has(k_feature_catcher, m.shadow_catcher);
  has(k_feature_emission, m.emission != vec3(0));
  has(k_feature_normal_map, bool(m.normal_texture));
  has(k_feature_base_texture, bool(m.base_color_texture));
  has(k_feature_metallic_roughness_texture, bool(m.metallic_roughness_texture));
  has(k_feature_emission_texture, bool(m.emission_texture));
  has(k_feature_specular_texture, m.specular_texture || m.specular_color_texture);
  has(k_feature_transmission_texture, bool(m.transmission_texture));
  has(k_feature_diffuse_transmission_texture,
      m.diffuse_transmission_texture || m.diffuse_transmission_color_texture);
  // A coat, sheen or brushing reflects light samples over a smooth metal or glass, too.
  has(k_feature_light_samples, !smooth || !(all_metal || all_glass) || is_layered(m));
  const bool coat = m.clearcoat > 0, sheen = m.sheen_color != vec3(0);
  has(k_feature_clearcoat, coat);
  has(k_feature_clearcoat_texture, coat && (m.clearcoat_texture || m.clearcoat_roughness_texture));
  has(k_feature_clearcoat_normal, coat && m.clearcoat_normal_texture);
  has(k_feature_sheen, sheen);
  has(k_feature_sheen_texture, sheen && (m.sheen_color_texture || m.sheen_roughness_texture));
  has(k_feature_anisotropy, m.anisotropy > 0);
  has(k_feature_anisotropy_texture, m.anisotropy > 0 && m.anisotropy_texture);
  has(k_feature_dispersion, glass && m.thickness > 0 && m.dispersion > 0);
  has(k_feature_rough_diffuse, m.diffuse_roughness > 0);
  has(k_feature_diffuse_roughness_texture, m.diffuse_roughness > 0 && m.diffuse_roughness_texture);
  has(k_feature_relief, scene::has_relief(m));
  has(k_feature_deep_relief, scene::has_relief(m) && m.deep_relief);
  has(k_feature_iridescence, m.iridescence > 0);
  has(k_feature_iridescence_texture,
      m.iridescence > 0 && (m.iridescence_texture || m.iridescence_thickness_texture));
  return features;
}

MaterialKinds material_kinds(const std::vector<scene::Material>& materials) {
  using namespace shared;
  MaterialKinds kinds;
  const auto first = kinds.features.begin() + k_kind_first;
  auto end = first;
  for (const scene::Material& m : materials) {
    const uint32_t features = features_of(m);
    auto at = std::find(first, end, features);
    if (at == end && end == kinds.features.end())
      *--at = k_all_features;
    else if (at == end)
      *end++ = features;
    kinds.of_material.push_back(uint32_t(at - kinds.features.begin()));
  }
  return kinds;
}

}  // namespace lucerna::upload
