#pragma once
// extras.lucerna: what no glTF extension covers, read from nodes, scenes and cameras. save.h writes it.
#include "scene/io/document.h"

namespace lucerna::scene {

/// Of a node with a light: {"enabled": false, "off_intensity": [r, g, b]}, whose light has intensity 0 in the
/// file; another intensity there counts more. And of a sun {"sun": {"date": "2024-06-21", "time": 12.5,
/// "zone": 1, "latitude": 48.1, "longitude": 11.6, "north": 0}} (sun_time.h; time in hours). A place of the
/// sun that does not fit the node's rotation within 0.01 degrees is ignored: the node was turned elsewhere.
/// Throws a located Error for wrong types and values.
/// Of a shape {"right": [x, y, z]}: the direction of its width in the world, if that is the node's X axis
/// within 0.01 degrees, so that it keeps all digits.
void read_own_extras(const Item& node, Light& light);

/// Of a node with a mesh, 16 numbers by columns:
/// - "to_world": Instance::to_world as this program had it, used if it differs from what the nodes give by
///   rounding alone: so it keeps all digits. A node that was moved elsewhere has another matrix.
/// - "skin_to_world": places a skinned mesh, whose node's matrix does nothing, after its joints; in the
///   file's coordinates.
/// Nothing if it is not given. Throws a located Error for other types and numbers.
std::optional<glm::dmat4> own_matrix(const Item& node, const char* key);

/// Of a light in KHR_lights_punctual: {"shape": "sphere" | "disk", "radius": m}, {"shape": "rectangle",
/// "width": m, "height": m}, {"shape": "tube", "length": m, "radius": m}; optional "two_sided" (false) and
/// "visible" (true). Gives the light that kind; unchanged without a shape. Throws a located Error for other
/// types and values.
void read_own_shape(const Item& definition, Light& light);

/// Of a spot in KHR_lights_punctual: {"picture": {"uri": file or data, "name": text}}; nothing without.
std::optional<Item> own_picture(const Item& definition);

/// Of a material {"off_emission": [r, g, b]}: emission that is switched off. Ignored beside other emission.
void read_own_emission(const Item& item, Material& material);

/// Of a material {"height": {"texture": textureInfo, "height": metres, "deep": false}}: Material::height; or
/// nothing.
std::optional<Item> own_height(const Item& item);

/// Of a material {"shadow_catcher": true}.
void read_own_catcher(const Item& item, Material& material);

/// Of a camera: {"section": {"normal": [x, y, z], "offset": metres}}, in the file's coordinates.
void read_own_section(const Item& camera, Camera& result);

/// {"kind": "preetham", "turbidity": 3, "ground": 0.2, "to_sun": [x, y, z], "unit": "cd/m2"}; "cie_clear",
/// "cie_overcast".
SkyModel read_sky(const Item& item);
/// Factor on Sky::radiance() by its "unit": 1 for "cd/m2"; 0.001 for "kcd/m2", and without one, as first
/// versions wrote it.
float sky_unit(const Item& item);
/// Its name in files and commands.
const char* name_of(SkyKind kind);

/// extras.lucerna.environment of the default scene, or nothing: {"file" | "radiance" | "sky", "scale",
/// "rotation"}.
std::optional<Item> own_environment(const Document& document);
/// extras.lucerna.settings of the default scene: {"film.ev": "1", ...}, to Scene::own_settings.
void read_own_settings(const Document& document, Scene& scene);

}  // namespace lucerna::scene
