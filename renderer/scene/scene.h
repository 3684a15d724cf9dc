#pragma once
// The scene: plain data with stable ids (indices into the vectors of Scene), independent of glTF, files and
// devices. Right-handed, Y up, metres; colours are linear Rec.709. One unit of radiance throughout, without
// photometric factors: emission and environment are radiance L, point and spot intensity is radiant intensity
// I (irradiance I/d^2 at distance d), directional intensity is irradiance E on a facing plane.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/shared_vector.h"
#include "scene/light_picture.h"
#include "scene/light_profile.h"
#include "scene/sky_model.h"
#include "scene/sun_time.h"

namespace lucerna::scene {

using Id = uint32_t;
inline constexpr Id k_none = 0xffffffffu;

/// Texels, row 0 at the top, 4 channels. Exactly one of `bytes` (8 bit a channel) and `floats` is filled.
struct Image {
  std::string name;  ///< file, or "scene.gltf: image 3 (name)"; for messages
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> bytes;  ///< width * height * 4, as stored in the file (not linearized)
  std::vector<float> floats;   ///< width * height * 4, linear
};

enum class Wrap : uint32_t { repeat, clamp, mirror };

/// An image and how to read it. `srgb`: 8-bit RGB texels are sRGB-encoded (colour data); alpha never is. An
/// image used both as colour and as data becomes two textures.
struct Texture {
  Id image = k_none;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;
  bool srgb = false;
};

/// A use of a texture by a material. Coordinates: uv' = (m[0]*u + m[1]*v + m[2], m[3]*u + m[4]*v + m[5]), (u,
/// v) of `uv_set` (0 or 1: Primitive::uv0 or uv1), v downwards from the top row as in glTF.
struct TextureUse {
  Id texture = k_none;
  uint32_t uv_set = 0;
  std::array<float, 6> m{1, 0, 0, 0, 1, 0};
  bool operator==(const TextureUse&) const = default;
  explicit operator bool() const { return texture != k_none; }
};

enum class AlphaMode : uint32_t { opaque, mask, blend };

/// Numbers of a glTF metallic-roughness material with the supported extensions. Textures multiply them as in
/// glTF.
struct MaterialFactors {
  vec4 base_color{1};  ///< rgb reflectance 0..1, a = coverage
  float metallic = 1, roughness = 1;
  float normal_scale = 1;
  vec3 emission{0};  ///< emitted radiance: emissiveFactor * emissiveStrength
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;  ///< whether the back side emits; surfaces reflect on both sides anyway
  bool unlit = false;  ///< shows base_color as radiance on E[SG]*L alone; no light source, black otherwise
  float ior = 1.5f;    ///< KHR_materials_ior; 0 means F = 1 (as the extension says)
  float specular = 1;  ///< KHR_materials_specular; multiplies F0 and F90 of the dielectric
  vec3 specular_color{1};
  float transmission = 0;  ///< KHR_materials_transmission
  float thickness = 0;     ///< KHR_materials_volume; > 0: a solid that refracts and absorbs; 0: a thin wall
  vec3 attenuation_color{1};
  float attenuation_distance = k_infinity;  ///< metres
  float dispersion = 0;            ///< KHR_materials_dispersion, of solids: 20 / Abbe number; 0: none
  float diffuse_transmission = 0;  ///< KHR_materials_diffuse_transmission
  vec3 diffuse_transmission_color{1};
  float diffuse_roughness = 0;  ///< EXT_materials_diffuse_roughness: 0 is Lambert's model, 1 is sandstone
  /// Relief by the height texture: metres from black to white along the front normal, and whether it hides
  /// and shadows itself, white on the surface and all else below; if not, it only turns the shading normal.
  float height = 0;
  bool deep_relief = false;
  /// Shows what is behind it, with the shadows and reflections of objects on it (scene/variants.h).
  bool shadow_catcher = false;
  float clearcoat = 0;  ///< KHR_materials_clearcoat: strength of a coat of varnish
  float clearcoat_roughness = 0;
  float clearcoat_normal_scale = 1;
  vec3 sheen_color{0};  ///< KHR_materials_sheen: reflectance of fibres; 0: none
  float sheen_roughness = 0;
  float anisotropy = 0;           ///< KHR_materials_anisotropy: 0 equal in all directions, 1 most brushed
  float anisotropy_rotation = 0;  ///< of the brushing, from the tangent towards the bitangent, radians
  float iridescence = 0;          ///< KHR_materials_iridescence: strength of a thin film
  float iridescence_ior = 1.3f;
  /// Thickness of the film where the texture is 0 and 1; without a texture it is the maximum. Nanometres.
  float iridescence_minimum = 100, iridescence_maximum = 400;
  bool operator==(const MaterialFactors&) const = default;
};

struct Material : MaterialFactors {
  std::string name;
  vec3 off_emission{0};           ///< kept while emission is switched off, and 0: extras.lucerna.off_emission
  TextureUse base_color_texture;  ///< rgba
  TextureUse metallic_roughness_texture;  ///< g = roughness, b = metallic
  TextureUse normal_texture;
  TextureUse emission_texture;
  TextureUse specular_texture;                    ///< a
  TextureUse specular_color_texture;              ///< rgb
  TextureUse transmission_texture;                ///< r
  TextureUse diffuse_transmission_texture;        ///< a
  TextureUse diffuse_transmission_color_texture;  ///< rgb
  TextureUse clearcoat_texture;                   ///< r
  TextureUse clearcoat_roughness_texture;         ///< g
  TextureUse clearcoat_normal_texture;            ///< without it the coat follows the vertices' normals
  TextureUse sheen_color_texture;                 ///< rgb
  TextureUse sheen_roughness_texture;             ///< a
  TextureUse anisotropy_texture;                  ///< rg direction, b strength
  TextureUse iridescence_texture;                 ///< r
  TextureUse iridescence_thickness_texture;       ///< g
  TextureUse diffuse_roughness_texture;           ///< r
  TextureUse height_texture;                      ///< r: extras.lucerna.height.texture
  std::string group;  ///< light group, if it emits: extras.light_group; "": none given (light_groups.h)
  bool operator==(const Material&) const = default;
};

/// A texture of a material, by a name for people and files.
struct TextureSlot {
  const char* name;
  TextureUse Material::*use;
};
/// All of them, in the order of shared::k_use_*.
inline constexpr TextureSlot k_texture_slots[] = {
    {"base_color", &Material::base_color_texture},
    {"metallic_roughness", &Material::metallic_roughness_texture},
    {"normal", &Material::normal_texture},
    {"emission", &Material::emission_texture},
    {"specular", &Material::specular_texture},
    {"specular_color", &Material::specular_color_texture},
    {"transmission", &Material::transmission_texture},
    {"diffuse_transmission", &Material::diffuse_transmission_texture},
    {"diffuse_transmission_color", &Material::diffuse_transmission_color_texture},
    {"clearcoat", &Material::clearcoat_texture},
    {"clearcoat_roughness", &Material::clearcoat_roughness_texture},
    {"clearcoat_normal", &Material::clearcoat_normal_texture},
    {"sheen_color", &Material::sheen_color_texture},
    {"sheen_roughness", &Material::sheen_roughness_texture},
    {"anisotropy", &Material::anisotropy_texture},
    {"iridescence", &Material::iridescence_texture},
    {"iridescence_thickness", &Material::iridescence_thickness_texture},
    {"diffuse_roughness", &Material::diffuse_roughness_texture},
    {"height", &Material::height_texture},
};
/// Whether it has relief by a height texture.
inline bool has_relief(const Material& m) { return m.height_texture && m.height != 0; }
/// Whether shading needs the directions of texture coordinates on the surface: Primitive::tangents.
inline bool needs_tangents(const Material& m) {
  return m.normal_texture || m.clearcoat_normal_texture || m.anisotropy > 0;
}

/// Triangles of one material in object space. Streams are empty or have one entry per vertex. After loading:
/// positions finite, triangles in range and not degenerate, normals present (unit length), tangents present
/// (xyz unit, w = +-1) if the material needs them (needs_tangents).
struct Primitive {
  std::vector<vec3> positions;
  std::vector<vec3> normals;
  std::vector<vec4> tangents;
  std::vector<vec2> uv0, uv1;
  std::vector<vec4> colors;  ///< COLOR_0, linear; multiplies base_color
  std::vector<uvec3> triangles;
  std::vector<Id> variants;  ///< by variant of the scene: its material there; k_none or missing: `material`
  Id material = 0;           ///< always valid; glTF's default material is added where a primitive has none
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  /// What was subtracted from the vertices of the file, which are far from its origin [m].
  glm::dvec3 shift{0};
  /// Its file's node has placed the vertices in the world: by joints, or by a matrix without an inverse.
  bool is_baked = false;
};

/// A mesh placed in the world. `flipped`: the matrix has a negative determinant, so the front side is the
/// clockwise one.
struct Instance {
  std::string name;  ///< of the node
  Id mesh = k_none;
  mat4 to_world{1};
  bool flipped = false;
  std::string group{};  ///< light group of its emitting parts: the node's extras.light_group; "": none given
  bool hidden = false;  ///< it has no surface (KHR_node_visibility), and keeps its place in the list
  Id node = k_none;     ///< its node in the file, which may have several instances; k_none: not known
};

/// Thin lens of a perspective camera, for depth of field. The film is 36 mm wide, so the field of view gives
/// the focal length, and the f-number the lens's diameter.
struct Lens {
  float f_number = 0;  ///< focal length over the lens's diameter; 0: a pinhole, with everything sharp
  float focus_distance =
      0;                ///< from the eye to the plane of focus, along the view axis, metres; > 0 with a lens
  uint32_t blades = 0;  ///< corners of the aperture, on the circle of that diameter; 0: round
  float rotation = 0;   ///< of the first corner, from the camera's right towards up, radians
  bool operator==(const Lens&) const = default;
};
/// Plane that cuts the view, and not the light: camera rays that start before it begin on it.
struct Section {
  vec3 normal{0};    ///< unit, into the part that stays visible; 0: there is none
  float offset = 0;  ///< of the plane along it, metres
  bool operator==(const Section&) const = default;
  bool cuts() const { return normal != vec3(0); }
};

inline constexpr float k_film_width = 0.036f;  ///< metres

/// Projections that show directions by their angles: a panorama shows all of them, the longitude to the right
/// and the latitude up (latitude-longitude); a fisheye those up to 90 degrees from the axis, the angle as the
/// distance from the middle (equidistant).
enum class Wide : uint32_t { none, panorama, fisheye };
/// Names of projections, by Wide.
inline constexpr const char* k_projection_names[] = {"perspective", "panorama", "fisheye"};

/// Looks down its -Z, +Y up. Perspective: yfov in radians, of the picture's height. Orthographic: half
/// heights.
struct Camera {
  std::string name;
  mat4 to_world{1};
  bool orthographic = false;
  Wide wide = Wide::none;  ///< other than none: not orthographic; yfov, shift and lens are not used
  float yfov = 0.8f;
  float xmag = 1, ymag = 1;  ///< orthographic half sizes, metres
  float aspect = 0;          ///< width / height; 0: that of the picture
  Lens lens{};               ///< of perspective cameras
  /// Lens shift: moves the picture's middle from the view axis, right in its widths and up in its heights.
  vec2 shift{0};
  Section section{};  ///< in the world
  bool perspective() const { return !orthographic && wide == Wide::none; }
};

/// Sphere to tube are lamps with a shape; profile: a point with a measured distribution.
enum class LightKind : uint32_t { point, spot, directional, sphere, rectangle, disk, tube, profile };
inline bool has_shape(LightKind kind) { return kind >= LightKind::sphere && kind <= LightKind::tube; }

/// KHR_lights_punctual, or a lamp with a shape that emits the same radiance everywhere; shines down its -Z.
/// Only lamps with a shape are seen; they block no light. `intensity`: cd (lx of directional lights) before
/// the colour filters it (light_units.h), of a lamp with a shape in front of it: radiance times the area seen
/// from there. Size does not change it.
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  vec3 intensity{1};  ///< colour times intensity
  vec3 position{0};
  vec3 direction{0, 0, -1};                         ///< unit; into the scene
  float inner_cone = 0, outer_cone = 0.785398163f;  ///< radians from the axis; spot only
  bool enabled = true;
  std::string group{};  ///< extras.light_group of its node, or its own; "": none given
  /// Identifies the light among all that the scene had and will have: its node in the file, or
  /// k_first_added and more for lights added by hand. k_none: not known.
  Id id = k_none;
  std::optional<SunTime> sun{};                   ///< of a directional light: its direction follows from this
  std::shared_ptr<const LightProfile> profile{};  ///< of its kind; the intensity is then the largest one
  /// Projected by a spot, in place of its fall between the cones; null: none. The intensity is that of white.
  std::shared_ptr<const LightPicture> picture{};
  /// Of a rectangle's or picture's width, a tube's length, or a profile's +X: unit, perpendicular to the
  /// direction.
  vec3 right{1, 0, 0};
  float width = 0.5f;      ///< of a rectangle; length of a tube; metres
  float height = 0.5f;     ///< of a rectangle
  float radius = 0.05f;    ///< of a sphere, disk or tube
  bool two_sided = false;  ///< a rectangle or disk also emits to its back
  bool visible = true;     ///< the camera sees the shape; mirrors show it in any case
  bool operator==(const Light&) const = default;
};
inline constexpr Id k_first_added = 0x80000000u;

/// Light from infinitely far: constant radiance, or a latitude-longitude image:
/// u = 0.5 + atan2(z, x) / 2pi, v = acos(y) / pi from the top; rotation counter-clockwise seen from above.
struct Environment {
  vec3 radiance{0};               ///< used when image is k_none
  Id image = k_none;              ///< float texels
  float scale = 1;                ///< multiplies image or radiance
  float rotation = 0;             ///< degrees
  std::string file;               ///< as written; for messages and saving
  bool given = false;             ///< the scene or its settings name an environment, be it black
  std::optional<SkyModel> sky{};  ///< the image is made from this model (sky_image.h)
};

/// A rectangle through which the sky lights a room: a mesh marked by extras.portal. It is no surface, and a
/// hint for light sampling only: it changes noise, never the mean.
struct Portal {
  std::string name;  ///< of the node
  vec3 centre{0};
  vec3 half_width{0}, half_height{0};  ///< from the centre to the middles of two sides, perpendicular
  bool operator==(const Portal&) const = default;
};
/// Unit normal, towards the room. The sky is sampled for points on this side.
vec3 normal_of(const Portal& portal);
/// m^2
float area_of(const Portal& portal);
/// A scene has at most this number of portals.
inline constexpr size_t k_max_portals = 16;

struct Scene {
  std::string name;  ///< the file's stem
  std::string file;
  /// The point of the file that is the scene's origin [m]: 0 except for distant geometry (recentre.h). Adding
  /// it to a position gives the file's coordinates.
  glm::dvec3 origin{0};
  // Shared between copies of a scene, so that editing a lamp copies lamps only.
  SharedVector<Image> images;
  SharedVector<Texture> textures;
  SharedVector<Mesh> meshes;
  SharedVector<Instance> instances;
  std::vector<Material> materials;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Portal> portals;        ///< at most k_max_portals
  std::vector<std::string> variants;  ///< names of variants of the materials (variants.h)
  Environment environment;
  /// Render settings from settings.json beside the scene, key -> value as text, in file order; checked by
  /// plan/.
  std::vector<std::pair<std::string, std::string>> settings;
  /// Likewise from extras.lucerna.settings of the file; they override those of settings.json.
  std::vector<std::pair<std::string, std::string>> own_settings;
  std::vector<std::string> warnings;            ///< repairs and omissions during loading, one line each
  std::vector<std::string> extensions;          ///< supported glTF extensions that the file uses, sorted
  std::vector<std::string> unknown_extensions;  ///< ignored extensions (a warning each), sorted
  /// The file's JSON as read, for saving (io/save.h); null for a scene made in memory.
  std::shared_ptr<const std::string> document;
  /// By material: its index in the file, k_none for the default material. Empty for a scene made in memory.
  std::vector<Id> material_indices;
};

/// The parts of an instance that are surfaces of the scene: those of its mesh, or none if it is hidden.
const std::vector<Primitive>& shown_parts(const Scene& scene, const Instance& instance);

/// World-space bounds of all shown instances; empty for a scene without triangles.
Box bounds(const Scene& scene);
/// ... of one instance; empty if it is hidden.
Box bounds(const Scene& scene, const Instance& instance);
/// Triangles of all shown instances.
uint64_t count_triangles(const Scene& scene);
/// The camera of a scene that has none: looks at the bounds' centre from the front, slightly above.
Camera default_camera(const Scene& scene);

/// The first camera of that name, or else of that number, from 1. Throws Error, listing the names, if there
/// is none.
const Camera& find_camera(const Scene& scene, const std::string& name);

/// The initial camera: find_camera(); for an empty name the scene's first, or default_camera().
Camera starting_camera(const Scene& scene, const std::string& name);

}  // namespace lucerna::scene
