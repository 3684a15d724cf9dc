#pragma once
// Scene -> arrays as the device wants them (shaders/shared/scene.h): pure host code, no device, so that it is
// testable and can be written to a file for the stand-alone ray bench.
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scene/light_groups.h"
#include "scene/scene.h"
#include "shaders/shared/scene.h"
#include "upload/environment_tables.h"

namespace lucerna::upload {

/// What the scene calls for; becomes #defines, so that nothing else is compiled in.
struct Effects {
  bool lights = false, emissive = false, environment_map = false, specular = false, solid_glass = false,
       thin_glass = false, diffuse_transmission = false, volumes = false, unlit = false, alpha = false,
       glass_specular = false, normal_maps = false, vertex_extra = false, tex_base = false,
       tex_metallic_roughness = false, tex_emission = false, tex_specular = false, tex_transmission = false,
       tex_diffuse_transmission = false;
  bool plain_emitters = true;  ///< no emissive surface has a texture of emission or is transparent by alpha
  /// Lamps that a light sample is drawn from by what each sends there, besides its power; 0: there are few.
  uint32_t lamp_candidates = 0;
  bool separate_sky = false, sun = false;  ///< FlatScene::sun_threshold; texels that are brighter
  uint32_t media = 0;                      ///< that solids hold, where any absorbs (upload/media.h)
  uint32_t light_groups = 1;               ///< that are kept apart (FlatScene::groups)
  bool group_components = true;            ///< ... by component, too
  bool uv_transforms = false;              ///< a use of a texture that is scaled, turned or shifted
  bool tex_nearest = false;                ///< a texture that is not filtered
  bool tex_wraps = false;                  ///< a texture that does not repeat
  std::array<uint32_t, shared::k_hit_kinds> kinds{};  ///< features, by kind of hits (upload/material_kinds.h)
  std::array<uint32_t, shared::k_texture_uses> texture_buckets{};  ///< by use: bit b: bucket b may be read
  bool transparent() const { return alpha || thin_glass; }
  /// Groups of lights are kept apart, all components of one together (film::GroupStorage::compact).
  bool has_compact_groups() const { return light_groups > 1 && !group_components; }
};

/// A texture array: pages of one size and format that hold textures of all sizes (upload/textures.h).
struct Bucket {
  uint32_t width = 0, height = 0;
  bool floats = false, srgb = false;
  std::vector<std::vector<uint8_t>> layers;  ///< rgba8, or rgba32f bytes
};

/// What of the scene an entry of the light table is.
struct LightEntry {
  uint32_t kind = 0;  ///< shared::k_light_*
  /// Primitive of an emissive triangle; lamp in scene::Scene::lights (k_none: one that is dark, so that the
  /// table is not empty); of the environment 0.
  uint32_t index = 0;
};

/// By what lights are chosen, and with which probability: flatten_light_distribution(). Nothing of it needs
/// to be as bright as what it is about: samples are divided by the probabilities, whatever they are.
struct LightDistribution {
  std::vector<LightEntry> entries;         ///< of the light table; emissive triangles first
  std::vector<std::string> lamp_names;     ///< by scene::Scene::lights, as the scene calls them; may be ""
  std::vector<vec4> light_alias;           ///< of these
  std::vector<float> primitive_light_pmf;  ///< pmf / area [1/m^2]
  std::vector<vec4> lamp_alias;  ///< of the lamps among the entries, which lie together, by the same weights
  uint32_t first_lamp = 0;       ///< of the entries
  float lamp_pmf = 0;            ///< that a lamp is chosen at all
  float environment_light_pmf = 0;
  EnvironmentTables environment;
  std::vector<vec4> sun_density;  ///< EnvironmentTables::sun_density, with the sun's own pmf
  /// Luminance of the flux that each entry sends into the scene [W], for paths that begin at lights: of
  /// distant ones through the scene's disk, of textured triangles by 16 points of each.
  std::vector<double> light_power;
  double sky_power = 0;  ///< of an environment that is no entry
};

/// What lights emit and from where: flatten_emission().
struct Emission {
  std::vector<vec4> lights;                                ///< the light table
  std::vector<uint8_t> emissive_groups;                    ///< by primitive; empty: they are not kept apart
  SharedVector<vec3> environment_texels;                   ///< radiance, without the factor
  std::optional<EnvironmentSource> environment_source;     ///< of these
  uint32_t environment_width = 0, environment_height = 0;  ///< 0: it is dark
  vec3 environment_radiance{0};                            ///< factor of the texels
  float environment_rotation = 0;                          ///< radians
};

/// What flatten_lights() makes.
struct FlatLights : LightDistribution, Emission {};

struct SolidShells;  // upload/media.h

/// What flatten_factors() makes, with the uses of textures.
struct FlatMaterials {
  std::vector<vec4> materials;
  std::vector<vec4> bsdf_tables;
  std::vector<float> glass_iors;              ///< that they are for
  std::vector<vec4> media;                    ///< scene_media; empty: no solid absorbs
  std::shared_ptr<const SolidShells> shells;  ///< that `media` is made of
};

struct FlatScene : FlatLights, FlatMaterials {
  // Geometry (one entry a primitive, world space).
  std::vector<vec3> positions;  ///< 3 a primitive; input of the BVH
  std::vector<uint8_t> non_opaque;
  std::vector<uvec4> triangles;  ///< scene_triangles
  std::vector<vec4> vertices, tangents, extra;
  std::vector<Bucket> buckets;
  /// Above 0: the environment is two emitters (shared/scene.h), its sun the texels of more than so many times
  /// its mean luminance.
  float sun_threshold = 0;
  std::shared_ptr<const scene::LightGroups> groups;  ///< whose light is kept apart; null: no groups are
  bool group_components = true;  ///< by component, too; else all light of a group in one (film::GroupStorage)
  vec3 scene_centre{0};
  float scene_radius = 1;  ///< of a sphere around that which holds all surfaces
  /// The same without what stands far away from the rest (scene::core_of()): what sizes are measured by,
  /// where one is needed that is the scene's.
  vec3 core_centre{0};
  float core_radius = 1;
  Effects effects;
};

/// How lights are told apart: FlatScene's fields of these names.
struct LightSeparation {
  float sun_threshold = 0;
  std::shared_ptr<const scene::LightGroups> groups;
  bool group_components = true;
  bool operator==(const LightSeparation& o) const {
    return sun_threshold == o.sun_threshold && group_components == o.group_components &&
           (groups == o.groups || (groups && o.groups && *groups == *o.groups));
  }
};
LightSeparation light_separation(const FlatScene& flat);
void set_light_separation(FlatScene& flat, const LightSeparation& separation);

/// Everything. Throws Error when the scene exceeds what indices or texture arrays can hold.
FlatScene flatten(const scene::Scene& scene, const LightSeparation& separation);
FlatScene flatten(const scene::Scene& scene, float sun_threshold = 0);
/// Materials without their textures only (after an edit that leaves textures, alpha mode and transmission as
/// they were); flatten_lights() then, if emission has changed. `flat` must come from the same scene.
void flatten_factors(const scene::Scene& scene, FlatScene& flat);
/// Lights and environment only (after an edit of them, or of flat.sun_threshold): distribution, then
/// emission. `flat` must come from the same scene.
void flatten_lights(const scene::Scene& scene, FlatScene& flat);
/// By power; of the environment by the luminance of its texels, and with a share of all that an interior
/// needs.
void flatten_light_distribution(const scene::Scene& scene, FlatScene& flat);
/// For the distribution that `flat` has. That may have been made for other strengths, colours and another
/// rotation of the environment, where all that emits now has done so then: samples then bring the same light
/// on average, with more noise.
void flatten_emission(const scene::Scene& scene, FlatScene& flat);

}  // namespace lucerna::upload
