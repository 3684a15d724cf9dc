#pragma once
// Edits of a glTF document's JSON.
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/math.h"

namespace lucerna::scene {

/// Adding a member to an object invalidates references to the object's other members.
using EditedJson = nlohmann::ordered_json;

/// The shortest decimal number that reads as exactly this float.
EditedJson number_json(float value);
EditedJson vector_json(const vec3& value);
/// A colour of at most 1 and a factor, whose products in single precision are exactly `value`.
std::pair<vec3, float> split_strength(const vec3& value);
/// A unit vector, in double precision, that reads as exactly this direction in single precision; just
/// normalized if the direction is no rounded unit vector.
glm::dvec3 unit_within(const vec3& direction);

/// The member, an object: made if it is missing. Another value is kept as its member "value".
EditedJson& object_at(EditedJson& parent, const char* key);
/// The member, an array: made in place of anything else.
EditedJson& array_at(EditedJson& parent, const char* key);
/// Removes a member, and the object if it is then empty.
void remove_from(EditedJson& parent, const char* object, const char* key);
/// parent.extensions[name], an object, made if it is missing; notes the extension in extensionsUsed.
EditedJson& extension_at(EditedJson& root, EditedJson& parent, const char* name);
/// Removes parent.extensions[name].
void remove_extension(EditedJson& parent, const char* name);
/// extras.lucerna[key] of an object, an object itself: made if it is missing.
EditedJson& own_at(EditedJson& parent, const char* key);
/// Sets extras.lucerna[key] of an object.
void set_own(EditedJson& parent, const char* key, EditedJson value);
/// Removes extras.lucerna[key] of an object, and what is then empty.
void remove_own(EditedJson& parent, const char* key);

/// The default scene's object; made, with all root nodes, if the document has none.
EditedJson& default_scene(EditedJson& root);
/// Appends a node to the default scene's roots; its index.
size_t add_root_node(EditedJson& root, EditedJson node);
/// Removes names from extensionsUsed and extensionsRequired that the document no longer uses, if `name`.
void drop_unused_extension(EditedJson& root, const std::string& name);

/// The document as text: indented like `source`, or on one line if that is.
std::string text_like(const EditedJson& json, const std::string& source);

}  // namespace lucerna::scene
