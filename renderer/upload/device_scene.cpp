#include "upload/device_scene.h"

#include <utility>

namespace lucerna::upload {
namespace {

template <class T>
gpu::Buffer upload(gpu::Device& device, const char* name, const std::vector<T>& values, bool texel = true) {
  gpu::Buffer buffer(
      device, {.name = name, .bytes = std::max<uint64_t>(16, values.size() * sizeof(T)), .texel = texel});
  if (!values.empty()) buffer.write(std::span<const T>(values));
  return buffer;
}

/// The environment's texels for shaders, radiance and density (shaders/shared/scene.h); in chunks, because
/// maps are large.
gpu::Buffer upload_environment(gpu::Device& device, const FlatLights& flat) {
  constexpr size_t k_piece = 1 << 16;
  const size_t count = flat.environment_texels.size();
  gpu::Buffer buffer(
      device, {.name = "environment", .bytes = std::max<uint64_t>(16, count * sizeof(vec4)), .texel = true});
  std::vector<vec4> piece;
  for (size_t first = 0; first < count; first += piece.size()) {
    piece.resize(std::min(k_piece, count - first));
    for (size_t i = 0; i < piece.size(); ++i)
      piece[i] = vec4(flat.environment_texels[first + i], flat.environment.density[first + i]);
    buffer.write(std::span<const vec4>(piece), first);
  }
  return buffer;
}

std::shared_ptr<const EnvironmentBuffers> environment_of(gpu::Device& device, const FlatLights& flat,
                                                         const LightBuffers& before) {
  if (before.environment && before.environment->holds(flat)) return before.environment;
  return std::make_shared<EnvironmentBuffers>(device, flat);
}

std::shared_ptr<const SharedTable> table_of(gpu::Device& device, const char* name,
                                            const SharedVector<vec4>& values,
                                            const std::shared_ptr<const SharedTable>& before) {
  if (before && before->of.shares_with(values)) return before;
  return std::make_shared<SharedTable>(device, name, values);
}

std::vector<vec4> joined(std::vector<vec4> a, const std::vector<vec4>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// With room at the end, so that their bytes make texels.
std::vector<uint8_t> whole_texels(std::vector<uint8_t> bytes) {
  bytes.resize((bytes.size() + 15) / 16 * 16);
  return bytes;
}

}  // namespace

EnvironmentBuffers::EnvironmentBuffers(gpu::Device& device, const FlatLights& flat)
    : texels(upload_environment(device, flat)),
      alias(upload<vec4>(device, "environment table", flat.environment.alias)),
      sun_cells(upload<vec4>(device, "sun table", flat.environment.sun_cells)),
      of_texels_(flat.environment_texels),
      of_(flat.environment) {}

bool EnvironmentBuffers::holds(const FlatLights& flat) const {
  return of_texels_.shares_with(flat.environment_texels) && of_.alias.shares_with(flat.environment.alias) &&
         of_.density.shares_with(flat.environment.density) &&
         of_.sun_cells.shares_with(flat.environment.sun_cells);
}

SharedTable::SharedTable(gpu::Device& device, const char* name, const SharedVector<vec4>& values)
    : texels(upload<vec4>(device, name, values)), of(values) {}

LightBuffers::LightBuffers(gpu::Device& device, const FlatLights& flat, const LightBuffers& before)
    : lights(upload(device, "lights", flat.lights)),
      alias(upload(device, "light table", joined(flat.light_alias, flat.lamp_alias))),
      pmf(upload(device, "light probabilities", flat.primitive_light_pmf, false)),
      groups(upload(device, "groups of lights", whole_texels(flat.emissive_groups))),
      sun_density(upload(device, "sun densities", flat.sun_density)),
      portals(upload(device, "portals", flat.portals.portals)),
      portal_sums(upload<uint32_t>(device, "portal tables", flat.portals.sums)),
      environment(environment_of(device, flat, before)),
      irradiance(
          table_of(device, "irradiance of the environment", flat.environment_irradiance, before.irradiance)),
      profiles(table_of(device, "distributions of lamps", flat.profiles, before.profiles)),
      pictures(table_of(device, "pictures of spots", flat.pictures, before.pictures)) {}

MaterialBuffers::MaterialBuffers(gpu::Device& device, const FlatMaterials& flat)
    : materials(upload(device, "scene materials", flat.materials)),
      tables(upload(device, "albedo tables", flat.bsdf_tables)),
      media(upload(device, "volumes", flat.media)) {}

DeviceScene::DeviceScene(gpu::Device& device, const FlatScene& flat, const bvh::BvhData& tree)
    : triangles_(upload(device, "scene triangles", flat.triangles)),
      vertices_(upload(device, "scene vertices", flat.vertices)),
      tangents_(upload(device, "scene tangents", flat.tangents)),
      extra_(upload(device, "scene vertex colours", flat.extra)),
      nodes_(upload(device, "BVH nodes", tree.nodes)),
      bvh_triangles_(upload(device, "BVH triangles", tree.triangles)),
      materials_(device, flat),
      lights_(device, flat),
      effects_(flat.effects) {
  for (size_t b = 0; b < flat.buckets.size(); ++b) {
    const Bucket& bucket = flat.buckets[b];
    gpu::TextureArray array(device,
                            {.name = fmt::format("textures, pages of {}x{}", bucket.width, bucket.height),
                             .width = bucket.width,
                             .height = bucket.height,
                             .layers = uint32_t(bucket.layers.size()),
                             .format = bucket.floats ? gpu::TexelFormat::rgba32f
                                       : bucket.srgb ? gpu::TexelFormat::rgba8_srgb
                                                     : gpu::TexelFormat::rgba8_unorm});
    for (size_t layer = 0; layer < bucket.layers.size(); ++layer)
      array.write_layer(uint32_t(layer), bucket.layers[layer].data());
    buckets_.push_back(std::move(array));
  }
}

LightBuffers DeviceScene::exchange(LightBuffers lights, const Effects& effects) noexcept {
  effects_ = effects;
  return std::exchange(lights_, std::move(lights));
}

MaterialBuffers DeviceScene::exchange(MaterialBuffers materials, const Effects& effects) noexcept {
  effects_ = effects;
  return std::exchange(materials_, std::move(materials));
}

void DeviceScene::bind(gpu::Resources& r) const {
  r.set("scene_triangles", triangles_);
  r.set("scene_vertices", vertices_);
  r.set("scene_tangents", tangents_);
  r.set("scene_extra", extra_);
  r.set("scene_materials", materials_.materials);
  r.set("scene_lights", lights_.lights);
  r.set("light_alias", lights_.alias);
  r.set("PrimitiveLightPmf", lights_.pmf);
  r.set("emissive_groups", lights_.groups);
  r.set("light_profiles", lights_.profiles->texels);
  r.set("light_pictures", lights_.pictures->texels);
  r.set("environment_texels", lights_.environment->texels);
  r.set("environment_irradiance", lights_.irradiance->texels);
  r.set("environment_alias", lights_.environment->alias);
  r.set("sun_cells", lights_.environment->sun_cells);
  r.set("sun_density", lights_.sun_density);
  r.set("scene_portals", lights_.portals);
  r.set("portal_sums", lights_.portal_sums);
  r.set("bsdf_table", materials_.tables);
  r.set("scene_media", materials_.media);
  r.set("bvh_nodes", nodes_);
  r.set("bvh_triangles", bvh_triangles_);
  for (size_t b = 0; b < buckets_.size(); ++b) r.set(fmt::format("texture_bucket_{}", b), buckets_[b]);
}

gpu::Defines DeviceScene::defines() const {
  const Effects& e = effects_;
  gpu::Defines d;
  const auto set = [&](const char* name, bool on) { d[name] = on ? "1" : "0"; };
  set("LUCERNA_LIGHTS", e.lights);
  set("LUCERNA_EMISSIVE", e.emissive);
  set("LUCERNA_SHAPES", e.shapes);
  set("LUCERNA_PROFILES", e.profiles);
  set("LUCERNA_PICTURES", e.pictures);
  set("LUCERNA_PLAIN_EMITTERS", e.plain_emitters);
  set("LUCERNA_ENVIRONMENT_MAP", e.environment_map);
  set("LUCERNA_SEPARATE_SKY", e.separate_sky);
  set("LUCERNA_SUN", e.sun);
  d["LUCERNA_PORTALS"] = std::to_string(e.portals);
  d["LUCERNA_LAMP_CANDIDATES"] = std::to_string(e.lamp_candidates);
  d["LUCERNA_LIGHT_GROUPS"] = std::to_string(e.light_groups);
  set("LUCERNA_GROUP_SUMS", e.has_compact_groups());
  d["LUCERNA_WORD_LAYERS"] = std::to_string(e.layers);
  set("LUCERNA_SPECULAR", e.specular);
  set("LUCERNA_SOLID_GLASS", e.solid_glass);
  set("LUCERNA_THIN_GLASS", e.thin_glass);
  set("LUCERNA_GLASS_SPECULAR", e.glass_specular);
  set("LUCERNA_DIFFUSE_TRANSMISSION", e.diffuse_transmission);
  set("LUCERNA_VOLUMES", e.volumes);
  d["LUCERNA_MEDIA"] = std::to_string(e.media);
  set("LUCERNA_UNLIT", e.unlit);
  set("LUCERNA_ALPHA", e.alpha);
  set("LUCERNA_NORMAL_MAPS", e.normal_maps);
  set("LUCERNA_VERTEX_EXTRA", e.vertex_extra);
  set("LUCERNA_TEX_BASE", e.tex_base);
  set("LUCERNA_TEX_METALLIC_ROUGHNESS", e.tex_metallic_roughness);
  set("LUCERNA_TEX_EMISSION", e.tex_emission);
  set("LUCERNA_TEX_SPECULAR", e.tex_specular);
  set("LUCERNA_TEX_TRANSMISSION", e.tex_transmission);
  set("LUCERNA_TEX_DIFFUSE_TRANSMISSION", e.tex_diffuse_transmission);
  set("LUCERNA_TANGENTS", e.tangents);
  set("LUCERNA_CLEARCOAT", e.clearcoat);
  set("LUCERNA_TEX_CLEARCOAT", e.tex_clearcoat);
  set("LUCERNA_CLEARCOAT_NORMALS", e.clearcoat_normals);
  set("LUCERNA_SHEEN", e.sheen);
  set("LUCERNA_TEX_SHEEN", e.tex_sheen);
  set("LUCERNA_ANISOTROPY", e.anisotropy);
  set("LUCERNA_TEX_ANISOTROPY", e.tex_anisotropy);
  set("LUCERNA_DISPERSION", e.dispersion);
  set("LUCERNA_ROUGH_DIFFUSE", e.rough_diffuse);
  set("LUCERNA_TEX_DIFFUSE_ROUGHNESS", e.tex_diffuse_roughness);
  set("LUCERNA_HEIGHTS", e.heights);
  set("LUCERNA_PARALLAX", e.deep_relief);
  set("LUCERNA_CATCHER", e.catcher);
  set("LUCERNA_IRIDESCENCE", e.iridescence);
  set("LUCERNA_TEX_IRIDESCENCE", e.tex_iridescence);
  set("LUCERNA_UV_TRANSFORMS", e.uv_transforms);
  set("LUCERNA_TEX_NEAREST", e.tex_nearest);
  set("LUCERNA_TEX_WRAPS", e.tex_wraps);
  static constexpr const char* k_masks[] = {"LUCERNA_BASE_BUCKETS",
                                            "LUCERNA_METALLIC_ROUGHNESS_BUCKETS",
                                            "LUCERNA_NORMAL_BUCKETS",
                                            "LUCERNA_EMISSION_BUCKETS",
                                            "LUCERNA_SPECULAR_BUCKETS",
                                            "LUCERNA_SPECULAR_COLOR_BUCKETS",
                                            "LUCERNA_TRANSMISSION_BUCKETS",
                                            "LUCERNA_DIFFUSE_T_BUCKETS",
                                            "LUCERNA_DIFFUSE_T_COLOR_BUCKETS",
                                            "LUCERNA_CLEARCOAT_BUCKETS",
                                            "LUCERNA_CLEARCOAT_ROUGHNESS_BUCKETS",
                                            "LUCERNA_CLEARCOAT_NORMAL_BUCKETS",
                                            "LUCERNA_SHEEN_COLOR_BUCKETS",
                                            "LUCERNA_SHEEN_ROUGHNESS_BUCKETS",
                                            "LUCERNA_ANISOTROPY_BUCKETS",
                                            "LUCERNA_IRIDESCENCE_BUCKETS",
                                            "LUCERNA_IRIDESCENCE_THICKNESS_BUCKETS",
                                            "LUCERNA_DIFFUSE_ROUGHNESS_BUCKETS",
                                            "LUCERNA_HEIGHT_BUCKETS"};
  static_assert(std::size(k_masks) == shared::k_texture_uses);
  for (uint32_t use = 0; use < shared::k_texture_uses; ++use)
    d[k_masks[use]] = fmt::format("{}u", e.texture_buckets[use]);
  d["LUCERNA_BUCKETS"] = std::to_string(buckets_.size());
  return d;
}

}  // namespace lucerna::upload
