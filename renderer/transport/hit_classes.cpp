#include "transport/hit_classes.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "shaders/shared/transport.h"
#include "upload/material_kinds.h"

namespace lucerna::transport {

using namespace shared;
using namespace upload;

HitClasses choose_hit_classes(std::span<const uint32_t> features, std::span<const uint64_t> hits) {
  HitClasses chosen;
  const double all = double(std::accumulate(hits.begin(), hits.end(), uint64_t{0}));
  const size_t kinds = std::min({features.size(), hits.size(), size_t{k_hit_kinds}});
  std::vector<uint32_t> by_hits(kinds);
  std::iota(by_hits.begin(), by_hits.end(), 0u);
  std::stable_sort(by_hits.begin(), by_hits.end(), [&](uint32_t a, uint32_t b) { return hits[a] > hits[b]; });
  for (const uint32_t kind : by_hits) {
    if (hits[kind] == 0) continue;
    if (double(hits[kind]) >= k_least_class_share * all && chosen.classes.size() + 1 < k_hit_classes) {
      chosen.classes.push_back(kind == k_kind_sky ? HitClass{0, true} : HitClass{features[kind], false});
      chosen.of_kind[kind] = uint32_t(chosen.classes.size());
      continue;
    }
    if (kind == k_kind_sky) continue;
    int least = 33;
    for (size_t c = 0; c < chosen.classes.size(); ++c) {
      const HitClass& candidate = chosen.classes[c];
      if (candidate.sky || (features[kind] & ~candidate.features) != 0) continue;
      const int more = std::popcount(candidate.features & ~features[kind]);
      if (more < least) least = more, chosen.of_kind[kind] = uint32_t(c + 1);
    }
  }
  // Mean number of features per hit that these kernels omit relative to the kernel for all hits.
  uint32_t compiled = 0;
  for (size_t kind = 0; kind < kinds; ++kind) compiled |= features[kind];
  compiled &= ~(k_feature_emission | k_feature_light_samples);
  double left_out = 0;
  for (size_t kind = 0; kind < kinds; ++kind)
    if (const uint32_t c = chosen.of_kind[kind]; c > 0)
      left_out += double(hits[kind]) * std::popcount(compiled & ~chosen.classes[c - 1].features);
  return left_out < k_least_left_out * all ? HitClasses{} : chosen;
}

std::array<uint32_t, 4> packed(const HitClasses& classes) {
  static_assert(k_hit_kinds * k_class_bits == 4 * 32 && k_hit_classes <= 1u << k_class_bits);
  constexpr uint32_t k_in_word = 32 / k_class_bits;
  std::array<uint32_t, 4> words{};
  for (uint32_t kind = 0; kind < k_hit_kinds; ++kind)
    words[kind / k_in_word] |= classes.of_kind[kind] << k_class_bits * (kind % k_in_word);
  return words;
}

DarkKinds dark_kinds(std::span<const uint32_t> features, const gpu::Defines& all) {
  for (const char* name : {"LUCERNA_PATH_EVENTS", "LUCERNA_SHAPES", "LUCERNA_NO_AUTOMATON"})
    if (const auto found = all.find(name); found != all.end() && found->second != "0") return {};
  constexpr uint32_t k_not_dark = k_feature_emission | k_feature_unlit | k_feature_alpha |
                                  k_feature_thin_glass | k_feature_catcher | k_feature_deep_relief;
  constexpr uint32_t k_diffuse = k_feature_light_samples | k_feature_base_texture | k_feature_normal_map |
                                 k_feature_relief | k_feature_diffuse_transmission |
                                 k_feature_diffuse_transmission_texture | k_feature_rough_diffuse |
                                 k_feature_diffuse_roughness_texture;
  DarkKinds kinds;
  for (uint32_t kind = k_kind_first; kind < features.size(); ++kind) {
    if ((features[kind] & k_not_dark) == 0) kinds.all |= 1u << kind;
    if ((features[kind] & ~k_diffuse) == 0) kinds.diffuse |= 1u << kind;
  }
  return kinds;
}

gpu::Defines defines_of(const HitClass& hits, const gpu::Defines& all) {
  gpu::Defines d = all;
  const auto on = [&](const char* name) {
    const auto found = all.find(name);
    return found != all.end() && found->second != "0";
  };
  const auto keep = [&](const char* name, bool kept) {
    if (!kept) d[name] = "0";
  };
  const auto needs = [&](uint32_t features) { return (hits.features & features) != 0; };
  const bool glass = needs(k_feature_solid_glass | k_feature_thin_glass);
  // Features of emissive triangles for light samples remain (LUCERNA_LIGHT_SURFACE).
  const bool reads_lights = !hits.sky && on("LUCERNA_EMISSIVE") && !on("LUCERNA_PLAIN_EMITTERS") &&
                            (on("LUCERNA_TEX_EMISSION") || on("LUCERNA_ALPHA") || on("LUCERNA_VERTEX_EXTRA"));
  d["LUCERNA_SCENE_GLOSSY"] =
      on("LUCERNA_SPECULAR") || on("LUCERNA_SOLID_GLASS") || on("LUCERNA_THIN_GLASS") ? "1" : "0";
  d["LUCERNA_HITS_SKY"] = hits.sky ? "1" : "0";
  d["LUCERNA_HITS_SURFACES"] = hits.sky ? "0" : "1";
  d["LUCERNA_HITS_EMISSIVE"] = on("LUCERNA_EMISSIVE") && needs(k_feature_emission) ? "1" : "0";
  d["LUCERNA_HITS_LIT"] = on("LUCERNA_LIGHTS") && needs(k_feature_light_samples) ? "1" : "0";
  keep("LUCERNA_SPECULAR", needs(k_feature_specular));
  keep("LUCERNA_SOLID_GLASS", needs(k_feature_solid_glass));
  keep("LUCERNA_THIN_GLASS", needs(k_feature_thin_glass));
  keep("LUCERNA_GLASS_SPECULAR", glass && needs(k_feature_glass_specular));
  keep("LUCERNA_DIFFUSE_TRANSMISSION", needs(k_feature_diffuse_transmission));
  keep("LUCERNA_UNLIT", needs(k_feature_unlit));
  keep("LUCERNA_ALPHA", needs(k_feature_alpha) || reads_lights);
  keep("LUCERNA_NORMAL_MAPS", needs(k_feature_normal_map));
  keep("LUCERNA_TEX_BASE", needs(k_feature_base_texture) || reads_lights);
  keep("LUCERNA_TEX_METALLIC_ROUGHNESS", needs(k_feature_metallic_roughness_texture));
  keep("LUCERNA_TEX_EMISSION", needs(k_feature_emission_texture) || reads_lights);
  keep("LUCERNA_TEX_SPECULAR", needs(k_feature_specular_texture));
  keep("LUCERNA_TEX_TRANSMISSION", needs(k_feature_transmission_texture));
  keep("LUCERNA_TEX_DIFFUSE_TRANSMISSION", needs(k_feature_diffuse_transmission_texture));
  keep("LUCERNA_CLEARCOAT", needs(k_feature_clearcoat));
  keep("LUCERNA_TEX_CLEARCOAT", needs(k_feature_clearcoat_texture));
  keep("LUCERNA_CLEARCOAT_NORMALS", needs(k_feature_clearcoat_normal));
  keep("LUCERNA_SHEEN", needs(k_feature_sheen));
  keep("LUCERNA_TEX_SHEEN", needs(k_feature_sheen_texture));
  keep("LUCERNA_ANISOTROPY", needs(k_feature_anisotropy));
  keep("LUCERNA_TEX_ANISOTROPY", needs(k_feature_anisotropy_texture));
  keep("LUCERNA_DISPERSION", needs(k_feature_dispersion));
  keep("LUCERNA_ROUGH_DIFFUSE", needs(k_feature_rough_diffuse));
  keep("LUCERNA_TEX_DIFFUSE_ROUGHNESS", needs(k_feature_diffuse_roughness_texture));
  keep("LUCERNA_CATCHER", needs(k_feature_catcher));
  keep("LUCERNA_HEIGHTS", needs(k_feature_relief));
  keep("LUCERNA_PARALLAX", needs(k_feature_deep_relief));
  keep("LUCERNA_IRIDESCENCE", needs(k_feature_iridescence));
  keep("LUCERNA_TEX_IRIDESCENCE", needs(k_feature_iridescence_texture));
  return d;
}

}  // namespace lucerna::transport
