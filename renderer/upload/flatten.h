#pragma once
// Converts a scene to the device's arrays (shaders/shared/scene.h). Pure host code, so that it is testable
// and can be written to a file for the stand-alone ray bench.
#include <array>
#include <bit>
#include <memory>
#include <string>
#include <vector>

#include "scene/light_groups.h"
#include "scene/scene.h"
#include "shaders/shared/scene.h"
#include "upload/environment_tables.h"
#include "upload/portal_tables.h"

namespace lucerna::upload {

/// A whole number as it is stored in a texel of floats.
inline float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

/// Features that the scene needs; become #defines, so that nothing else is compiled in.
struct Effects {
  bool lights = false, emissive = false, environment_map = false, specular = false, solid_glass = false,
       thin_glass = false, diffuse_transmission = false, volumes = false, unlit = false, alpha = false,
       glass_specular = false, normal_maps = false, vertex_extra = false, tex_base = false,
       tex_metallic_roughness = false, tex_emission = false, tex_specular = false, tex_transmission = false,
       tex_diffuse_transmission = false, tangents = false, clearcoat = false, sheen = false,
       anisotropy = false, iridescence = false, dispersion = false, tex_clearcoat = false,
       clearcoat_normals = false, tex_sheen = false, tex_anisotropy = false, tex_iridescence = false,
       rough_diffuse = false, tex_diffuse_roughness = false, heights = false, deep_relief = false,
       catcher = false;
  bool plain_emitters = true;  ///< no emissive surface has an emission texture or alpha transparency
  /// Number of lamps from which a light sample is resampled by their light at the point; 0: few lamps.
  uint32_t lamp_candidates = 0;
  bool shapes = false;    ///< there are lamps with a shape, on or off
  bool profiles = false;  ///< there are lamps with a measured distribution, on or off
  bool pictures = false;  ///< there are spots with a picture, on or off

  bool separate_sky = false, sun = false;  ///< FlatScene::sun_threshold; there are brighter texels
  uint32_t media = 0;                      ///< number of media, if a solid absorbs (upload/media.h)
  uint32_t light_groups = 1;               ///< number of separate groups (FlatScene::groups)
  bool group_components = true;            ///< groups are separated by component too
  uint32_t layers = 0;                     ///< number of layers by path expressions (paths/layers.h)
  uint32_t portals = 0;                    ///< number of portals through which the sky is sampled
  bool uv_transforms = false;              ///< a texture is scaled, rotated or shifted
  bool tex_nearest = false;                ///< a texture is not filtered
  bool tex_wraps = false;                  ///< a texture does not repeat
  std::array<uint32_t, shared::k_hit_kinds> kinds{};  ///< features by kind of hits (upload/material_kinds.h)
  std::array<uint32_t, shared::k_texture_uses> texture_buckets{};  ///< by use: bit b: bucket b may be read
  bool transparent() const { return alpha || thin_glass; }
  /// No surface reflects or passes light other than diffusely: no path has a glossy or specular event.
  bool only_diffuse() const { return !specular && !solid_glass && !thin_glass; }
  /// Separate light groups with all components together (film::GroupStorage::compact).
  bool has_compact_groups() const { return light_groups > 1 && !group_components; }
};

/// A texture array: pages of one size and format that hold textures of all sizes (upload/textures.h).
struct Bucket {
  uint32_t width = 0, height = 0;
  bool floats = false, srgb = false;
  std::vector<std::vector<uint8_t>> layers;  ///< rgba8, or rgba32f bytes
};

/// Origin of an entry of the light table in the scene.
struct LightEntry {
  uint32_t kind = 0;  ///< shared::k_light_*
  /// Primitive of an emissive triangle; index of a lamp in scene::Scene::lights (k_none: a dark one, so that
  /// the table is not empty); 0 for the environment.
  uint32_t index = 0;
};

/// Probabilities of light selection: flatten_light_distribution(). They need not match the lights' present
/// brightness: samples are divided by them.
struct LightDistribution {
  std::vector<LightEntry> entries;         ///< entries of the light table; emissive triangles first
  std::vector<std::string> lamp_names;     ///< by scene::Scene::lights: scene::display_name()
  std::vector<vec4> light_alias;           ///< alias table of the entries
  std::vector<float> primitive_light_pmf;  ///< pmf / area [1/m^2]
  std::vector<vec4>
      lamp_alias;  ///< alias table of the lamps, which are consecutive entries, with the same weights
  uint32_t first_lamp = 0, lamp_count = 0;    ///< entries of lamps
  float lamp_pmf = 0;                         ///< probability of choosing a lamp
  uint32_t first_shape = 0, shape_count = 0;  ///< entries of lamps with a shape, the last of the lamps
  float environment_light_pmf = 0;
  EnvironmentTables environment;
  PortalTables portals;           ///< none if the sun is separate
  std::vector<vec4> sun_density;  ///< EnvironmentTables::sun_density, with the sun's own pmf
  /// Luminance of the flux of each entry [W], for light paths: of distant lights through the scene's disk, of
  /// textured triangles from 16 points of each.
  std::vector<double> light_power;
  double sky_power = 0;  ///< of an environment without an entry
  /// Displayed name of a lamp; "lamp" for the dark entry of a scene without lights.
  std::string lamp_name(uint32_t lamp) const { return lamp < lamp_names.size() ? lamp_names[lamp] : "lamp"; }
};

/// Profiles of the scene's lamps, each once.
using Profiles = std::vector<std::shared_ptr<const scene::LightProfile>>;

using Pictures = std::vector<std::shared_ptr<const scene::LightPicture>>;

/// Emission of lights: flatten_emission().
struct Emission {
  std::vector<vec4> lights;                                ///< the light table
  std::vector<uint8_t> emissive_groups;                    ///< by primitive; empty: groups are not separate
  Profiles profiles_in_table;                              ///< those of light_profiles, in its order
  SharedVector<vec4> profiles;                             ///< light_profiles; made again for others only
  Pictures pictures_in_table;                              ///< likewise of light_pictures
  SharedVector<vec4> pictures;                             ///< light_pictures
  SharedVector<vec3> environment_texels;                   ///< radiance, without the factor
  SharedVector<vec4> environment_irradiance;               ///< of them, if there is a shadow catcher
  std::optional<EnvironmentSource> environment_source;     ///< source of the texels
  uint32_t environment_width = 0, environment_height = 0;  ///< 0: dark
  vec3 environment_radiance{0};                            ///< factor of the texels
  float environment_rotation = 0;                          ///< radians
};

/// Result of flatten_lights().
struct FlatLights : LightDistribution, Emission {};

struct SolidShells;  // upload/media.h

/// Result of flatten_factors(), with the uses of textures.
struct FlatMaterials {
  std::vector<vec4> materials;
  std::vector<vec4> bsdf_tables;
  std::vector<float> glass_iors;              ///< indices of refraction of the tables
  bool has_sheen = false;                     ///< the tables have that of sheen
  std::vector<vec4> media;                    ///< scene_media; empty: no solid absorbs
  std::shared_ptr<const SolidShells> shells;  ///< shells from which `media` is made
};

struct FlatScene : FlatLights, FlatMaterials {
  // Geometry (one entry a primitive, world space).
  std::vector<vec3> positions;  ///< 3 a primitive; input of the BVH
  std::vector<uint8_t> non_opaque;
  std::vector<uvec4> triangles;  ///< scene_triangles
  std::vector<vec4> vertices, tangents, extra;
  std::vector<Bucket> buckets;
  /// Above 0: the environment is two emitters (shared/scene.h); the sun consists of texels above this times
  /// the mean luminance.
  float sun_threshold = 0;
  std::shared_ptr<const scene::LightGroups> groups;  ///< separate groups; null: none
  bool group_components = true;  ///< separate by component too; else one sum per group (film::GroupStorage)
  uint32_t layers = 0;           ///< Effects::layers
  vec3 scene_centre{0};
  float scene_radius = 1;  ///< radius of a sphere around the centre that contains all surfaces [m]
  /// Likewise, without distant outliers (scene::core_of()): the scene's size for all other purposes.
  vec3 core_centre{0};
  float core_radius = 1;
  Effects effects;
};

/// Separation of lights: FlatScene's fields of these names.
struct LightSeparation {
  float sun_threshold = 0;
  std::shared_ptr<const scene::LightGroups> groups;
  bool group_components = true;
  uint32_t layers = 0;
  bool operator==(const LightSeparation& o) const {
    return sun_threshold == o.sun_threshold && group_components == o.group_components && layers == o.layers &&
           (groups == o.groups || (groups && o.groups && *groups == *o.groups));
  }
};
LightSeparation light_separation(const FlatScene& flat);
void set_light_separation(FlatScene& flat, const LightSeparation& separation);

/// Flattens everything. Throws Error if the scene exceeds the range of indices or of texture arrays.
FlatScene flatten(const scene::Scene& scene, const LightSeparation& separation);
FlatScene flatten(const scene::Scene& scene, float sun_threshold = 0);
/// Only materials without their textures, after an edit that leaves textures, alpha mode and transmission
/// unchanged; requires flatten_lights() afterwards if emission has changed. `flat` must be of the same scene.
void flatten_factors(const scene::Scene& scene, FlatScene& flat);
/// Only lights and environment, after an edit of them or of flat.sun_threshold: distribution, then emission.
/// `flat` must be of the same scene.
void flatten_lights(const scene::Scene& scene, FlatScene& flat);
/// Selection by power; of the environment by the luminance of its texels, with a share of all selections that
/// suits interiors.
void flatten_light_distribution(const scene::Scene& scene, FlatScene& flat);
/// Emission for the existing distribution of `flat`, which may be of other strengths, colours and another
/// rotation of the environment if all present emitters emitted then: samples are unbiased, with more noise.
void flatten_emission(const scene::Scene& scene, FlatScene& flat);

}  // namespace lucerna::upload
