#pragma once
// glTF 2.0 files into Scene. What is read, and what becomes of input that is not as it should be:
// - Error (the message names file and element): a missing or truncated file, JSON that does not parse, a
//   value of a wrong type, an index out of range, an accessor beyond its view or a view beyond its buffer,
//   positions that are not finite, a cyclic node graph or a node with two parents, a matrix above a mesh,
//   camera or light that is not finite, a skin that a node has and that is not as glTF asks, a required
//   extension that is not known, an environment that cannot be read, a settings.json that is not as described
//   below. A buffer or an environment outside the scene's folder (below), and more memory than LoadOptions
//   allows.
// - One line in Scene::warnings, with a count: degenerate triangles (removed), points and lines (left out),
//   textures that are missing, outside the scene's folder, cannot be decoded or have no texels (white
//   instead; flat for normal maps), values outside their range (clamped), extensions that are not known,
//   cameras that cannot be used (left out), animations (the pose of nodes and weights is shown), what nodes
//   of scale 0 hold (left out), and that the scene is far from the origin.
// Meshes of skins are where their joints are; their node's matrix is ignored. Morph targets have the node's
// weights, else the mesh's. A mesh in a node that is flat (scale 0 on one axis) is shown flat.
//
// Geometry far from the origin relative to its own extent is moved near it, with cameras and lamps
// (recentre.h): Scene::origin is the point of the file that positions are then counted from, everywhere in
// the program (bounds, cameras in commands and scripts, views kept in images). Node matrices are concatenated
// in double precision before that. A warning, `lucerna info` and its JSON name the origin.
//
// Honoured extensions: KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume,
// _diffuse_transmission, _unlit, KHR_lights_punctual (range ignored), KHR_texture_transform,
// KHR_mesh_quantization, EXT_mesh_gpu_instancing.
//
// The environment comes from the scene's extras, {"environment": {"file": .., "scale": .., "rotation": ..}}
// or
// {"environment": {"radiance": [r, g, b]}} (unknown keys are accepted there), or, overriding it as a whole,
// from a file settings.json beside the scene (there an unknown key of "environment" is an Error). Its other
// values go to Scene::settings, nested objects as dotted keys: {"film": {"ev": 1}} is "film.ev" = "1".
//
// Images: PNG, JPEG, EXR, HDR and what else OpenImageIO decodes from memory (TIFF, TGA, BMP, WebP, PNM, DDS,
// PSD ...; not SGI, ICO, RLA, FITS and others that it opens by name alone), as files, data URIs or buffer
// views; grey, grey with alpha and RGB become RGBA, alpha stays unassociated. 8-bit texels stay bytes. 16-bit
// ones become floats where every use is data (normal maps, roughness ...) and 8 bits where one use is colour;
// float formats stay floats.
//
// A scene may name files of its own folder and of those below it, whatever its URIs say: what lies elsewhere,
// by "..", an absolute path or a symbolic link, is not read unless LoadOptions::outside.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/error.h"
#include "scene/scene.h"

namespace lucerna::scene {

/// What a scene may take in memory unless LoadOptions says otherwise.
inline constexpr uint64_t k_scene_bytes = uint64_t{8} << 30;

struct LoadOptions {
  bool images = true;    ///< false: textures are neutral single texels (for tools that look at geometry only)
  bool settings = true;  ///< false: settings.json beside the scene is not looked at
  /// Files that the scene names are read wherever they are.
  bool outside = false;
  /// Bytes that files, images, geometry and its instances in the world may take together, as estimated from
  /// their numbers; a scene that asks for more is refused, with the element that went beyond.
  uint64_t most_bytes = k_scene_bytes;
};

/// Called from time to time with the fraction done (0..1) and what is being done ("textures"); false cancels.
using LoadProgress = std::function<bool(float fraction, const std::string& what)>;

/// Thrown when the progress callback cancels; not a failure.
class Cancelled : public Error {
 public:
  Cancelled() : Error("", "cancelled") {}
};

/// Reads a .gltf or .glb (told apart by content). Only what the default scene reaches is kept: meshes,
/// materials and images that it does not use are not loaded. A scene without triangles is no error; it has a
/// warning.
Scene load(const std::filesystem::path& gltf_or_glb, const LoadOptions& options = {},
           const LoadProgress& progress = {});

/// What is in a scene, for `lucerna info --json`: counts, meshes, materials and their kind, textures with
/// sizes and memory, lights, cameras, environment, extensions, bounds, warnings.
nlohmann::ordered_json describe(const Scene& scene);
/// The same for people, several lines.
std::string describe_text(const Scene& scene);

}  // namespace lucerna::scene
