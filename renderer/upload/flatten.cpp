#include "upload/flatten.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "base/alias_table.h"
#include "base/error.h"
#include "scene/core.h"
#include "upload/bsdf_table.h"
#include "upload/material_kinds.h"
#include "upload/media.h"
#include "upload/textures.h"

namespace lucerna::upload {
namespace {

using namespace shared;

bool any(const vec3& c) { return c.x > 0 || c.y > 0 || c.z > 0; }

/// Vertices, triangles and their data for lights, in instance order.
void flatten_geometry(const scene::Scene& scene, FlatScene& flat) {
  for (const scene::Material& m : scene.materials) {
    flat.effects.normal_maps |= bool(m.normal_texture);
    flat.effects.tangents |= scene::needs_tangents(m);
  }
  for (const scene::Instance& instance : scene.instances)
    for (const scene::Primitive& p : scene::shown_parts(scene, instance))
      flat.effects.vertex_extra |= !p.colors.empty() || !p.uv1.empty();
  const uint64_t count = scene::count_triangles(scene);
  if (count > (1u << 27) / 3)
    throw_error(scene.file, "{} triangles are more than the limit of {}", count, (1u << 27) / 3);
  flat.positions.reserve(3 * count);
  flat.triangles.reserve(count);
  for (const scene::Instance& instance : scene.instances) {
    const mat3 linear(instance.to_world);
    const mat3 normal_matrix = glm::transpose(glm::inverse(linear));
    for (const scene::Primitive& p : scene::shown_parts(scene, instance)) {
      const uint32_t first = uint32_t(flat.vertices.size() / 2);
      const scene::Material& material = scene.materials[p.material];
      for (size_t i = 0; i < p.positions.size(); ++i) {
        const vec3 position(instance.to_world * vec4(p.positions[i], 1));
        vec3 n = i < p.normals.size() ? normal_matrix * p.normals[i] : vec3(0);
        const float length = glm::length(n);
        n = length > 0 && std::isfinite(length) ? n / length : vec3(0);
        const vec2 uv = i < p.uv0.size() ? p.uv0[i] : vec2(0);
        flat.vertices.push_back(vec4(position, uv.x));
        flat.vertices.push_back(vec4(n, uv.y));
        if (flat.effects.tangents) {
          vec4 t(0);
          if (i < p.tangents.size() && scene::needs_tangents(material)) {
            vec3 d = linear * vec3(p.tangents[i]);
            d -= n * glm::dot(n, d);
            const float l = glm::length(d);
            if (l > 0) t = vec4(d / l, p.tangents[i].w * (instance.flipped ? -1.f : 1.f));
          }
          flat.tangents.push_back(t);
        }
        if (flat.effects.vertex_extra) {
          flat.extra.push_back(i < p.colors.size() ? p.colors[i] : vec4(1));
          flat.extra.push_back(vec4(i < p.uv1.size() ? p.uv1[i] : vec2(0), 0, 0));
        }
      }
      const bool thin = material.transmission > 0 && material.thickness <= 0;
      const bool non_opaque =
          material.alpha_mode != scene::AlphaMode::opaque || thin || material.shadow_catcher;
      for (const uvec3& t : p.triangles) {
        for (int k = 0; k < 3; ++k) flat.positions.push_back(vec3(flat.vertices[2 * size_t(first + t[k])]));
        flat.triangles.push_back(uvec4(first + t.x, first + t.y, first + t.z,
                                       p.material | (instance.flipped ? k_triangle_flipped : 0u)));
        flat.non_opaque.push_back(non_opaque);
      }
    }
  }
  const Box box = scene::bounds(scene);
  flat.scene_centre = box.empty() ? vec3(0) : box.centre();
  flat.scene_radius = box.empty() ? 1.f : std::max(box.radius(), 1e-6f);
  flat.core_centre = flat.scene_centre, flat.core_radius = flat.scene_radius;
  if (const std::optional<Box> core = scene::core_of(flat.positions))
    flat.core_centre = core->centre(), flat.core_radius = std::max(core->radius(), 1e-6f);
}

}  // namespace

void flatten_factors(const scene::Scene& scene, FlatScene& flat) {
  std::vector<float> glass_iors;
  Effects& e = flat.effects;
  e.specular = e.solid_glass = e.thin_glass = e.diffuse_transmission = false;
  e.volumes = e.unlit = e.alpha = e.glass_specular = false;
  e.clearcoat = e.sheen = e.anisotropy = e.iridescence = e.dispersion = false;
  e.rough_diffuse = e.deep_relief = e.catcher = false;
  e.plain_emitters = true;
  const MaterialKinds kinds = material_kinds(scene.materials);
  flat.materials.resize(scene.materials.size() * k_material_texels);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& m = scene.materials[i];
    const bool solid = m.transmission > 0 && m.thickness > 0, thin = m.transmission > 0 && m.thickness <= 0;
    const bool rough_glass = solid;
    float row = -1;
    if (rough_glass) {
      const float ior = std::max(m.ior, 1.f);
      auto at = std::find(glass_iors.begin(), glass_iors.end(), ior);
      row = float(at - glass_iors.begin());
      if (at == glass_iors.end()) glass_iors.push_back(ior);
    }
    uint32_t flags = 0;
    if (m.double_sided) flags |= k_flag_double_sided;
    if (m.unlit) flags |= k_flag_unlit;
    if (m.alpha_mode == scene::AlphaMode::mask) flags |= k_flag_mask;
    if (m.alpha_mode == scene::AlphaMode::blend) flags |= k_flag_blend;
    if (any(m.emission) && !m.unlit) flags |= k_flag_emissive;
    if (solid) flags |= k_flag_solid;
    if (m.shadow_catcher) flags |= k_flag_catcher;
    vec3 absorption(0);
    if (solid && std::isfinite(m.attenuation_distance) && m.attenuation_distance > 0)
      for (int k = 0; k < 3; ++k)
        absorption[k] = -std::log(std::clamp(m.attenuation_color[k], 1e-6f, 1.f)) / m.attenuation_distance;
    vec4* out = flat.materials.data() + i * k_material_texels;
    out[k_material_base] = m.base_color;
    out[k_material_emission] = vec4(m.unlit ? vec3(0) : m.emission, as_float(flags));
    out[k_material_surface] = vec4(m.metallic, m.roughness, m.ior, m.specular);
    // Unlit surfaces show their colour and are black otherwise: they transmit nothing.
    out[k_material_specular] = vec4(m.specular_color, m.unlit ? 0 : m.transmission);
    out[k_material_volume] = vec4(absorption, row);
    out[k_material_diffuse_t] = vec4(m.diffuse_transmission_color, m.diffuse_transmission);
    out[k_material_detail] = vec4(m.normal_scale, m.alpha_cutoff, 0, as_float(kinds.of_material[i]));
    out[k_material_coat] = vec4(m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale, m.dispersion);
    out[k_material_sheen] = vec4(m.sheen_color, m.sheen_roughness);
    out[k_material_grain] = vec4(m.anisotropy, std::cos(m.anisotropy_rotation),
                                 std::sin(m.anisotropy_rotation), m.diffuse_roughness);
    out[k_material_relief].x = m.height, out[k_material_relief].y = m.deep_relief ? 1 : 0;
    out[k_material_film] =
        vec4(m.iridescence, m.iridescence_ior, m.iridescence_minimum, m.iridescence_maximum);
    e.clearcoat |= m.clearcoat > 0;
    e.sheen |= any(m.sheen_color);
    e.anisotropy |= m.anisotropy > 0;
    e.iridescence |= m.iridescence > 0;
    e.rough_diffuse |= m.diffuse_roughness > 0;
    e.deep_relief |= has_relief(m) && m.deep_relief;
    e.dispersion |= solid && m.dispersion > 0;
    const bool lets_all_through = m.transmission >= 1 && !m.transmission_texture;
    e.specular |= !m.unlit && (m.metallic > 0 || (m.specular > 0 && !lets_all_through) || is_layered(m));
    e.solid_glass |= solid;
    e.thin_glass |= thin;
    e.glass_specular |=
        (solid || thin) && (m.specular != 1 || m.specular_color != vec3(1) || m.specular_texture ||
                            m.specular_color_texture || m.iridescence > 0);
    e.diffuse_transmission |= m.diffuse_transmission > 0;
    if (flags & k_flag_emissive)
      e.plain_emitters &= !m.emission_texture && m.alpha_mode == scene::AlphaMode::opaque;
    e.volumes |= any(absorption);
    e.unlit |= m.unlit;
    e.catcher |= m.shadow_catcher;
    e.alpha |= m.alpha_mode != scene::AlphaMode::opaque || m.shadow_catcher;
  }
  e.kinds = kinds.features;
  if (flat.bsdf_tables.empty() || flat.glass_iors != glass_iors || flat.has_sheen != e.sheen)
    flat.bsdf_tables = build_bsdf_tables(glass_iors, e.sheen);
  flat.has_sheen = e.sheen;
  flat.glass_iors = std::move(glass_iors);
  flatten_media(flat);
}

namespace {

void flatten_textures(const scene::Scene& scene, FlatScene& flat) {
  const TextureMap textures = pack_textures(scene, flat.buckets);
  Effects& e = flat.effects;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& m = scene.materials[i];
    vec4* out = flat.materials.data() + i * k_material_texels;
    static_assert(std::size(scene::k_texture_slots) == k_texture_uses);
    for (uint32_t u = 0; u < k_texture_uses; ++u) {
      const scene::TextureUse& use = m.*scene::k_texture_slots[u].use;
      const auto& x = use.m;
      vec4* texel = out + k_material_textures + k_texture_texels * u;
      texel[1] = vec4(as_float(textures.bits(use)), x[2], x[5], 0);
      texel[2] = vec4(x[0], x[1], x[3], x[4]);
      if (!use) continue;
      const TexturePlace& place = textures.place[use.texture];
      const scene::Texture& texture = scene.textures[use.texture];
      texel[0] = place.rect;
      e.uv_transforms |= use.m != scene::TextureUse().m;
      e.texture_buckets[u] |= 1u << place.bucket;
      e.tex_nearest |= texture.nearest;
      e.tex_wraps |= texture.wrap_u != scene::Wrap::repeat || texture.wrap_v != scene::Wrap::repeat;
    }
    e.tex_base |= bool(m.base_color_texture);
    e.tex_metallic_roughness |= bool(m.metallic_roughness_texture);
    e.tex_emission |= bool(m.emission_texture);
    e.tex_specular |= m.specular_texture || m.specular_color_texture;
    e.tex_transmission |= bool(m.transmission_texture);
    e.tex_diffuse_transmission |= m.diffuse_transmission_texture || m.diffuse_transmission_color_texture;
    e.tex_clearcoat |= m.clearcoat_texture || m.clearcoat_roughness_texture;
    e.clearcoat_normals |= bool(m.clearcoat_normal_texture);
    e.tex_sheen |= m.sheen_color_texture || m.sheen_roughness_texture;
    e.tex_anisotropy |= bool(m.anisotropy_texture);
    e.tex_iridescence |= m.iridescence_texture || m.iridescence_thickness_texture;
    e.tex_diffuse_roughness |= bool(m.diffuse_roughness_texture);
    e.heights |= bool(m.height_texture);
    if (const scene::TextureUse& use = m.height_texture;
        use && scene.textures[use.texture].image != scene::k_none) {
      const scene::Image& image = scene.images[scene.textures[use.texture].image];
      out[k_material_relief].z = 1 / float(image.width), out[k_material_relief].w = 1 / float(image.height);
    }
  }
}

}  // namespace

LightSeparation light_separation(const FlatScene& flat) {
  return {flat.sun_threshold, flat.groups, flat.group_components, flat.layers};
}

void set_light_separation(FlatScene& flat, const LightSeparation& separation) {
  flat.sun_threshold = separation.sun_threshold;
  flat.groups = separation.groups;
  flat.group_components = separation.group_components;
  flat.layers = separation.layers;
}

FlatScene flatten(const scene::Scene& scene, const LightSeparation& separation) {
  FlatScene flat;
  flatten_geometry(scene, flat);
  flatten_factors(scene, flat);
  flatten_textures(scene, flat);
  set_light_separation(flat, separation);
  flatten_lights(scene, flat);
  return flat;
}

FlatScene flatten(const scene::Scene& scene, float sun_threshold) {
  return flatten(scene, LightSeparation{.sun_threshold = sun_threshold, .groups = {}});
}

}  // namespace lucerna::upload
