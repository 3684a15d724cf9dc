#include "scene/io/json_edit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "base/color.h"
#include "base/json_text.h"

namespace lucerna::scene {
namespace {

/// A factor for `strength` whose product with it is `value`, or nothing near.
bool find_factor(float value, float strength, float& factor) {
  factor = value / strength;
  for (const float f : {factor, std::nextafter(factor, 0.0f), std::nextafter(factor, 2.0f)})
    if (f <= 1 && f * strength == value) {
      factor = f;
      return true;
    }
  return false;
}

bool uses_extension(const EditedJson& value, const std::string& name) {
  if (!value.is_structured()) return false;
  if (value.is_object())
    if (const auto found = value.find("extensions"); found != value.end() && found->is_object())
      if (found->contains(name)) return true;
  for (const auto& [key, child] : value.items())
    if (key != "extras" && uses_extension(child, name)) return true;
  return false;
}

}  // namespace

EditedJson number_json(float value) {
  char text[64];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  double shortest = 0;
  std::from_chars(text, end, shortest);
  if (static_cast<float>(shortest) != value) shortest = double{value};
  // Whole numbers without a fraction, like most exporters.
  if (shortest == std::floor(shortest) && std::abs(shortest) < 1e15 && !std::signbit(shortest))
    return static_cast<int64_t>(shortest);
  return shortest;
}

EditedJson vector_json(const vec3& v) {
  return EditedJson::array({number_json(v.x), number_json(v.y), number_json(v.z)});
}

std::pair<vec3, float> split_strength(const vec3& value) {
  const float strength = strength_of(value);
  if (!(strength > 0)) return {vec3(1), 0};
  vec3 color(0);
  bool exact = true;
  for (int k = 0; k < 3; ++k) exact = find_factor(value[k], strength, color[k]) && exact;
  if (exact) return {color, strength};
  // Products with a power of two are exact.
  int exponent = 0;
  std::frexp(strength, &exponent);
  const float power = std::ldexp(1.0f, exponent);
  return {value / power, power};
}

glm::dvec3 unit_within(const vec3& direction) {
  const glm::dvec3 d(direction);
  const double missing = 1 - glm::dot(d, d);
  // Each component may move within half of its last place: by `share` of that, all in the same sense.
  glm::dvec3 half(0);
  double reach = 0;
  for (int k = 0; k < 3; ++k) {
    const float a = std::abs(direction[k]);
    half[k] = 0.5 * (double{std::nextafter(a, 2.0f)} - double{a});
    reach += 2 * std::abs(d[k]) * half[k];
  }
  const double share = reach > 0 ? missing / reach : 2;
  if (!(std::abs(share) < 0.999)) return glm::normalize(d);
  glm::dvec3 unit(0);
  for (int k = 0; k < 3; ++k) unit[k] = d[k] + (d[k] < 0 ? -1 : 1) * (d[k] == 0 ? 0 : share * half[k]);
  return unit;
}

EditedJson& object_at(EditedJson& parent, const char* key) {
  EditedJson& member = parent[key];
  if (member.is_null()) member = EditedJson::object();
  if (!member.is_object()) member = EditedJson{{"value", member}};
  return member;
}

EditedJson& array_at(EditedJson& parent, const char* key) {
  EditedJson& list = parent[key];
  if (!list.is_array()) list = EditedJson::array();
  return list;
}

void remove_from(EditedJson& parent, const char* object, const char* key) {
  const auto found = parent.find(object);
  if (found == parent.end() || !found->is_object()) return;
  found->erase(key);
  if (found->empty()) parent.erase(object);
}

EditedJson& extension_at(EditedJson& root, EditedJson& parent, const char* name) {
  EditedJson& used = array_at(root, "extensionsUsed");
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
  return object_at(object_at(parent, "extensions"), name);
}

void remove_extension(EditedJson& parent, const char* name) { remove_from(parent, "extensions", name); }

EditedJson& own_at(EditedJson& parent, const char* key) {
  return object_at(object_at(object_at(parent, "extras"), "lucerna"), key);
}

void set_own(EditedJson& parent, const char* key, EditedJson value) {
  object_at(object_at(parent, "extras"), "lucerna")[key] = std::move(value);
}

void remove_own(EditedJson& parent, const char* key) {
  const auto extras = parent.find("extras");
  if (extras == parent.end() || !extras->is_object() || !extras->contains("lucerna")) return;
  remove_from(*extras, "lucerna", key);
  if (extras->empty()) parent.erase("extras");
}

EditedJson& default_scene(EditedJson& root) {
  if (const auto scenes = root.find("scenes"); scenes == root.end() || scenes->empty()) {
    std::vector<bool> is_child(root.contains("nodes") ? root["nodes"].size() : 0);
    if (root.contains("nodes"))
      for (const EditedJson& node : root["nodes"])
        if (const auto children = node.find("children"); children != node.end())
          for (const EditedJson& child : *children) is_child[child.get<size_t>()] = true;
    EditedJson roots = EditedJson::array();
    for (size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) roots.push_back(i);
    EditedJson scene = EditedJson::object();
    if (!roots.empty()) scene["nodes"] = std::move(roots);
    root["scenes"] = EditedJson::array({std::move(scene)});
    root["scene"] = 0;
  }
  const auto chosen = root.find("scene");
  return root["scenes"][chosen == root.end() ? 0 : chosen->get<size_t>()];
}

size_t add_root_node(EditedJson& root, EditedJson node) {
  const size_t index = array_at(root, "nodes").size();
  EditedJson& scene = default_scene(root);
  root["nodes"].push_back(std::move(node));
  array_at(scene, "nodes").push_back(index);
  return index;
}

void drop_unused_extension(EditedJson& root, const std::string& name) {
  if (uses_extension(root, name)) return;
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const auto found = root.find(list);
    if (found == root.end() || !found->is_array()) continue;
    const auto at = std::find(found->begin(), found->end(), name);
    if (at != found->end()) found->erase(at);
    if (found->empty()) root.erase(list);
  }
}

std::string text_like(const EditedJson& json, const std::string& source) {
  const size_t line = source.find('\n');
  if (line == std::string::npos) return json_text(json);
  const size_t first = source.find_first_not_of(" \t\r\n", line);
  const size_t spaces = first == std::string::npos ? 2 : first - source.find_last_of('\n', first) - 1;
  const bool tabs = first != std::string::npos && first > 0 && source[first - 1] == '\t';
  return json_text(json, tabs ? 2 : static_cast<int>(std::clamp<size_t>(spaces, 1, 8))) + "\n";
}

}  // namespace lucerna::scene
