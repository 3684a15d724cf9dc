#pragma once
// Loads glTF 2.0 files into a Scene. Invalid input leads to one of two reactions:
// - An Error that names file and element: a missing or truncated file, JSON that does not parse, a wrong
//   type, an index out of range, an accessor beyond its view or a view beyond its buffer, non-finite
//   positions, a cyclic node graph or a node with two parents, a non-finite matrix above a mesh, camera or
//   light, an invalid skin, an unknown required extension, an unreadable environment, an invalid
//   settings.json, a buffer or environment outside the scene's folder, more memory than LoadOptions allows.
// - One line in Scene::warnings, with a count: degenerate triangles (removed), points and lines (skipped),
//   textures that are missing, outside the scene's folder, undecodable or empty (white instead; flat for
//   normal maps), values out of range (clamped), unknown extensions, unusable cameras (skipped), animations
//   (the pose of nodes and weights is shown), nodes of scale 0 (skipped), and a scene far from the origin.
//
// Skinned meshes are placed by their joints; their node's matrix is ignored. Morph targets have the node's
// weights, else the mesh's. A mesh in a flat node (scale 0 on one axis) is shown flat.
//
// Geometry far from the origin relative to its own extent is moved near it, with cameras and lamps
// (recentre.h). Scene::origin is the point of the file that becomes the origin, everywhere in the program
// (bounds, cameras in commands and scripts, views stored in images). Node matrices are concatenated in double
// precision before. A warning and `lucerna info` report the origin.
//
// Supported extensions: KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume,
// _diffuse_transmission, _clearcoat (which does not dim emission below it), _sheen, _anisotropy,
// _iridescence, _unlit, _variants, KHR_lights_punctual (range ignored), EXT_lights_ies,
// KHR_texture_transform, KHR_mesh_quantization, EXT_mesh_gpu_instancing, KHR_node_visibility (what it hides
// is loaded as hidden instances and lights that are off).
//
// The environment comes from the scene's extras, {"environment": {"file": .., "scale": .., "rotation": ..}}
// or {"environment": {"radiance": [r, g, b]}} (unknown keys are accepted there), or, overriding it as a
// whole, from settings.json beside the scene (an unknown key of "environment" is an Error there). Other
// values of settings.json go to Scene::settings, nested objects as dotted keys: {"film": {"ev": 1}} is
// "film.ev" = "1".
//
// extras.lucerna of the default scene, which save.h writes, overrides both: "environment", also with a sky by
// formula ("sky"), and "settings", flat, to Scene::own_settings. extras.lucerna of a light's node: whether it
// is off, and the date and place of a sun; of a node with a mesh: all digits of its matrix (own_extras.h).
//
// Perspective cameras with extras {"lucerna": {"f_number": .., "focus_distance": ..}} have a lens (Lens),
// with "aperture_blades" and "aperture_rotation" [radians] if given; "shift_right" and "shift_up" are
// Camera::shift, "section" is Camera::section; "projection": "panorama" or "fisheye" is Camera::wide. An
// invalid lens is left out with a warning.
//
// Nodes or meshes with extras {"portal": true} are portals of the sky instead of surfaces (portals.h).
//
// Images: PNG, JPEG, EXR, HDR and other formats that OpenImageIO decodes from memory (TIFF, TGA, BMP, WebP,
// PNM, DDS, PSD ...; not SGI, ICO, RLA, FITS and others that it opens by name only), as files, data URIs or
// buffer views. Grey, grey with alpha and RGB become RGBA; alpha stays unassociated. 8-bit texels stay bytes.
// 16-bit texels become floats if every use is data (normal maps, roughness ...), 8 bits if any use is colour.
// Float formats stay floats.
//
// A scene may name files in its own folder and below. Files elsewhere ("..", absolute paths, symbolic links)
// are not read unless LoadOptions::outside.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/error.h"
#include "scene/scene.h"

namespace lucerna::scene {

/// Default limit of a scene's memory.
inline constexpr uint64_t k_scene_bytes = uint64_t{8} << 30;

struct LoadOptions {
  bool images = true;    ///< false: textures are neutral single texels (for tools that need geometry only)
  bool settings = true;  ///< false: settings.json is ignored
  /// Also reads files outside the scene's folder.
  bool outside = false;
  /// Largest estimated size in bytes of files, images, geometry and its instances in the world together. A
  /// larger scene is refused; the message names the element that exceeds the limit.
  uint64_t most_bytes = k_scene_bytes;
};

/// Called regularly with the fraction done (0..1) and the current step ("textures"); false cancels.
using LoadProgress = std::function<bool(float fraction, const std::string& what)>;

/// Thrown when the progress callback cancels; not a failure.
class Cancelled : public Error {
 public:
  Cancelled() : Error("", "cancelled") {}
};

/// Reads a .gltf or .glb (detected by content). Only what the default scene uses is loaded. A scene without
/// triangles is not an error; it has a warning.
Scene load(const std::filesystem::path& gltf_or_glb, const LoadOptions& options = {},
           const LoadProgress& progress = {});

/// The contents of a scene for `lucerna info --json`: counts, meshes, materials and their kind, textures with
/// sizes and memory, lights, cameras, environment, extensions, bounds, warnings.
nlohmann::ordered_json describe(const Scene& scene);
/// Likewise, as text of several lines.
std::string describe_text(const Scene& scene);

}  // namespace lucerna::scene
