// Layout of the scene in device buffers. Read by C++ and GLSL. All buffers of this header are texel buffers
// (RGBA32F); integers are stored as bit patterns.
#ifndef LUCERNA_SHARED_SCENE_H
#define LUCERNA_SHARED_SCENE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// scene_triangles: one texel a primitive: bits (vertex 0, vertex 1, vertex 2, material | k_triangle_*).
LUCERNA_CONST uint k_triangle_material_mask = 0x00ffffffu;
LUCERNA_CONST uint k_triangle_flipped =
    0x80000000u;  ///< instance with a negative determinant: the front is clockwise

// scene_vertices: 2 texels a vertex: (position, u0) (normal, v0), world space, normals unit.
// scene_tangents: 1 texel a vertex, only in scenes with normal maps or brushed surfaces: (tangent,
// handedness). scene_extra:    2 texels a vertex, only in scenes with vertex colours or a second UV set:
// (rgba) (u1, v1, 0, 0).

// scene_materials: k_material_texels a material.
LUCERNA_CONST uint k_material_texels = 69u;
LUCERNA_CONST uint k_material_base = 0u;       ///< base colour rgba
LUCERNA_CONST uint k_material_emission = 1u;   ///< radiance rgb, bits: flags
LUCERNA_CONST uint k_material_surface = 2u;    ///< metallic, roughness, ior, specular
LUCERNA_CONST uint k_material_specular = 3u;   ///< specular colour rgb, transmission
LUCERNA_CONST uint k_material_volume = 4u;     ///< absorption rgb [1/m], glass table row (-1: none)
LUCERNA_CONST uint k_material_diffuse_t = 5u;  ///< diffuse transmission colour rgb, factor
LUCERNA_CONST uint k_material_detail = 6u;  ///< normal scale, alpha cutoff, medium of a solid (scene_media),
                                            ///< bits of the kind of hits on it
LUCERNA_CONST uint k_material_coat = 7u;       ///< clear coat: strength, roughness, normal scale; dispersion
LUCERNA_CONST uint k_material_sheen = 8u;      ///< sheen colour rgb, roughness
LUCERNA_CONST uint k_material_grain = 9u;      ///< anisotropy, cosine and sine of its rotation; diffuse
                                               ///< roughness
LUCERNA_CONST uint k_material_film = 10u;      ///< iridescence, index, minimum and maximum thickness [nm]
LUCERNA_CONST uint k_material_relief = 11u;    ///< height [m], 1: deep relief; size of a texel of the height
                                               ///< texture in its coordinates
LUCERNA_CONST uint k_material_textures = 12u;  ///< then k_texture_texels for each use:
// (rectangle on the page: x, y, width, height over the page's size) (bits:texture, m2, m5, 0) (m0 m1 m3 m4)
LUCERNA_CONST uint k_texture_texels = 3u;

// Texture uses, in order.
LUCERNA_CONST uint k_use_base = 0u;
LUCERNA_CONST uint k_use_metallic_roughness = 1u;
LUCERNA_CONST uint k_use_normal = 2u;
LUCERNA_CONST uint k_use_emission = 3u;
LUCERNA_CONST uint k_use_specular = 4u;
LUCERNA_CONST uint k_use_specular_color = 5u;
LUCERNA_CONST uint k_use_transmission = 6u;
LUCERNA_CONST uint k_use_diffuse_t = 7u;
LUCERNA_CONST uint k_use_diffuse_t_color = 8u;
LUCERNA_CONST uint k_use_clearcoat = 9u;
LUCERNA_CONST uint k_use_clearcoat_roughness = 10u;
LUCERNA_CONST uint k_use_clearcoat_normal = 11u;
LUCERNA_CONST uint k_use_sheen_color = 12u;
LUCERNA_CONST uint k_use_sheen_roughness = 13u;
LUCERNA_CONST uint k_use_anisotropy = 14u;
LUCERNA_CONST uint k_use_iridescence = 15u;
LUCERNA_CONST uint k_use_iridescence_thickness = 16u;
LUCERNA_CONST uint k_use_diffuse_roughness = 17u;
LUCERNA_CONST uint k_use_height = 18u;
LUCERNA_CONST uint k_texture_uses = 19u;

// Texture bits: 0-10 page (layer), 11-15 bucket, 16-17 wrap u, 18-19 wrap v (0 repeat, 1 clamp, 2 mirror), 20
// nearest, 21 second UV set, 31 present.
LUCERNA_CONST uint k_texture_nearest = 1u << 20;
LUCERNA_CONST uint k_texture_uv1 = 1u << 21;
LUCERNA_CONST uint k_texture_present = 1u << 31;
LUCERNA_CONST uint k_max_buckets = 6u;

// Kinds of hits, by the features of their material (renderer/upload/material_kinds.h).
LUCERNA_CONST uint k_kind_sky = 0u;    ///< paths that leave the scene
LUCERNA_CONST uint k_kind_first = 1u;  ///< first kind of materials
LUCERNA_CONST uint k_hit_kinds = 32u;

// Material flags.
LUCERNA_CONST uint k_flag_double_sided = 1u;
LUCERNA_CONST uint k_flag_unlit = 2u;
LUCERNA_CONST uint k_flag_mask = 4u;       ///< alpha mask
LUCERNA_CONST uint k_flag_blend = 8u;      ///< alpha blend
LUCERNA_CONST uint k_flag_emissive = 16u;  ///< some emission: its triangles are in the light table
LUCERNA_CONST uint k_flag_solid = 32u;     ///< transmits into a volume (thickness > 0)
LUCERNA_CONST uint k_flag_vertex_color = 64u;
LUCERNA_CONST uint k_flag_catcher = 128u;  ///< shadow catcher (lib/catcher.glsl)

// scene_lights: k_light_texels a light.
LUCERNA_CONST uint k_light_texels = 4u;
//           triangle                                punctual
// texel 0:  vertex 0, bits kind                     position (point, spot), bits kind
// texel 1:  vertex 1, area [m^2]                    intensity rgb, cos of the inner cone
// texel 2:  vertex 2, bits primitive                direction (spot, directional; unit, into the scene), cos
// of the outer cone texel 3:  radiance rgb without textures, bits:    0, bits likewise
//           k_light_both_sides, k_light_flipped,
//           group of lights << k_light_group_shift
//
// Lamps with a shape (shaders/lib/shapes.glsl): texels 0 to 2 as punctual, with half the width and half the
// height [m] in place of the cosines (rectangle; sphere and disk: radius in both; tube: half the length,
// radius); texel 3: direction of the width, or of a tube's length, unit and perpendicular to the direction,
// bits. A lamp with a measured distribution: texels 0 to 2 as punctual, with the largest intensity; texel 3:
// direction of the distribution's +X, bits: number of the distribution << k_light_profile_shift, group. A
// spot with a picture: likewise, with half the picture's width and height on a plane at distance 1 in place
// of the cosines; texel 3: direction of its width, bits: number of the picture << k_light_profile_shift,
// group.
LUCERNA_CONST uint k_light_profile_shift = 16u;
LUCERNA_CONST uint k_light_both_sides = 1u;  ///< the back side emits as well
LUCERNA_CONST uint k_light_flipped = 2u;     ///< the front is the clockwise side
LUCERNA_CONST uint k_light_hidden = 4u;      ///< a lamp with a shape that the camera does not see
LUCERNA_CONST uint k_light_group_shift = 8u;
LUCERNA_CONST uint k_light_group_mask = 0xffu;
LUCERNA_CONST uint k_light_triangle = 0u;
LUCERNA_CONST uint k_light_point = 1u;
LUCERNA_CONST uint k_light_spot = 2u;
LUCERNA_CONST uint k_light_directional = 3u;
LUCERNA_CONST uint k_light_environment = 4u;
LUCERNA_CONST uint k_light_sphere = 5u;  ///< the first kind with a shape
LUCERNA_CONST uint k_light_rectangle = 6u;
LUCERNA_CONST uint k_light_disk = 7u;
LUCERNA_CONST uint k_light_tube = 8u;        ///< the last one
LUCERNA_CONST uint k_light_profile = 9u;     ///< a point with a measured distribution
LUCERNA_CONST uint k_light_projector = 10u;  ///< a spot with a picture

// light_pictures: a texel a picture (bits: its first texel, width, height, 0), then the pictures
// (renderer/scene/light_picture.h): a texel a point, by rows from the top (rgb; density of the cell from it
// to the next row and column, over the picture's area), then a texel a cell (threshold and bits of the alias
// of an alias table of the cells, 0, 0).
//
// light_profiles: a texel a distribution (bits: first texel of its grid, rows, columns, 0), then the grids, a
// row of polar angles after the other (renderer/scene/light_profile.h): a texel a point (relative intensity;
// of the cell from it to the next row and column: threshold and bits of the alias of an alias table of the
// cells, density of its directions per solid angle).
//
// light_alias: one texel a light: (threshold, bits alias, pmf of this light, pmf of the alias). It is
// followed by a table of the lamps alone, numbered from Frame::first_lamp. environment_texels: one a texel:
// (radiance rgb, density of the directions through it as environment_alias chooses them, per solid angle).
// environment_alias: like light_alias.
//
// If records store the environment's light (LUCERNA_SEPARATE_SKY), it is two emitters: the sun, texels
// brighter than a threshold, and the sky, the others; filtered between texels, each has its share of a
// direction's radiance. The density and the alias table above are then the sky's, the density's sign bit
// marks texels of the sun, and the sky is no entry of scene_lights: light samples select it with a separate
// probability. The sun (LUCERNA_SUN) is the entry of k_light_environment, with bits of the number of its
// cells in texel 1 x. Its cells are those from which bilinear filtering reaches a texel of the sun.
// sun_cells: alias table of the cells, like light_alias, then bits of each cell's texel. sun_density: four
// texels each: density of the texel's directions as the sun's, times the sun's pmf in light_alias.
// environment_irradiance: one texel a normal (renderer/upload/environment_irradiance.h).
LUCERNA_CONST uint k_irradiance_width = 48u, k_irradiance_height = 24u;
//
// bsdf_table: see renderer/upload/bsdf_table.h.
//
// scene_media, if a solid absorbs: media, and the closed shells around them (renderer/upload/media.h).
//   0: bits of the first node's texel, the number of nodes, and the first triangle's texel
//   1 ...: absorption rgb [1/m] of each medium, the medium's number being the texel's
//   2 a node, in depth-first order: (low corner, bits of the node behind all below it | k_media_around)
//                                   (high corner, bits 0 of an inner node, else first triangle << 3 |
//                                   triangles)
//   3 a triangle: its vertices, counter-clockwise from outside; the first with the medium
LUCERNA_CONST uint k_media_around = 0x80000000u;  ///< visited if the position lies in the box; other nodes:
                                                  ///< if the ray hits it. A shell begins at such a node
/// Upper bound, exclusive, of the numbers of stacks of media (shaders/lib/media.glsl).
LUCERNA_CONST uint k_media_stacks = 1u << 20;

/// Parameters of the frame for all kernels. Lengths in metres, angles in radians.
/// Projections of the camera (lib/projection.glsl).
LUCERNA_CONST uint k_projection_perspective = 0u, k_projection_orthographic = 1u, k_projection_panorama = 2u,
                   k_projection_fisheye = 3u;

struct Frame {
  vec3 camera_origin;
  uint width;
  vec3 camera_right;  ///< half the picture's width at distance 1 (perspective), half width (orthographic), or
                      ///< half angle
  uint height;
  vec3 camera_up;       ///< likewise, half the height
  uint projection;      ///< k_projection_*
  vec3 camera_forward;  ///< to the middle of the picture; its part along camera_axis is 1 (lens shift)
  uint seed;
  vec3 camera_axis;           ///< unit, across camera_right and camera_up; depths are along it
  vec3 section_normal;        ///< unit, into the part that the camera sees; 0: the view is not cut
  float section_offset;       ///< of the plane along it [m]
  float lens_radius;          ///< of the circle around the lens [m]; 0: a pinhole, which kernels without
                              ///< LUCERNA_THIN_LENS assume
  float focus_distance;       ///< of the plane of focus, along camera_forward [m]
  uint lens_blades;           ///< corners of the lens; 0: round
  float lens_rotation;        ///< of its first corner, from camera_right towards camera_up
  vec3 environment_radiance;  ///< factor of the environment map
  uint light_count;
  uint first_lamp, lamp_count;    ///< lamps among the lights
  uint first_shape, shape_count;  ///< lamps with a shape among the lights (LUCERNA_SHAPES)
  float lamp_pmf;                 ///< probability that the light sampler chooses a lamp
  uint environment_width, environment_height;  ///< 0: there is none
  float environment_rotation;                  ///< radians
  float environment_light_pmf;  ///< probability that the light sampler chooses the environment, or the sky
                                ///< (0: not sampled)
  uint max_depth;
  uint roulette_depth;
  uint most_branches;  ///< maximum branches of a split path (VertexOut.branches)
  float scene_radius;
  uint camera_in_solids;      ///< 1: paths from the camera may start inside a solid
  uint sky_group, sun_group;  ///< light groups of the environment and of its sun, if lights are separated
  vec3 learned_origin;        ///< of the grid of shared/learned_lights.h (LUCERNA_LEARNED)
  float learned_scale;        ///< its cells a metre
  uint light_clusters, sky_clusters;  ///< number of all clusters, and of the sky's, which are the first
  uint learning;                      ///< 1: light samples are recorded
  uint automaton[64];                 ///< paths::pack; k_automaton_states
};

LUCERNA_SHARED_END
#endif
