#include "scene/io/save_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <vector>

#include "base/base64.h"
#include "scene/io/node_tree.h"
#include "scene/lamp.h"
#include "scene/solar.h"

namespace lucerna::scene {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec3;

constexpr const char* k_punctual = "KHR_lights_punctual";
constexpr const char* k_ies = "EXT_lights_ies";

bool has_profile(const Light& light) { return light.kind == LightKind::profile; }
const char* extension_of(const Light& light) { return has_profile(light) ? k_ies : k_punctual; }

/// The rotation of a node whose -Z axis has that direction (unit).
dquat turned_to(const dvec3& direction) {
  const dvec3 rest(0, 0, -1);
  const double cosine = glm::dot(rest, direction);
  if (cosine < -0.999999) {
    // About +X by half a turn, then the small rest.
    const dquat half(0, 1, 0, 0);
    const dvec3 back = glm::inverse(half) * direction;
    const dvec3 axis = glm::cross(rest, back);
    return half * glm::normalize(dquat(1 + glm::dot(rest, back), axis.x, axis.y, axis.z));
  }
  const dvec3 axis = glm::cross(rest, direction);
  return glm::normalize(dquat(1 + cosine, axis.x, axis.y, axis.z));
}

/// The rotation of a node whose -Z axis has that direction, and whose X axis is `right` as far as it is
/// perpendicular.
dquat turned_to(const dvec3& direction, const dvec3& right) {
  const dvec3 x = glm::normalize(right - direction * glm::dot(direction, right));
  return glm::normalize(glm::quat_cast(dmat3(x, glm::cross(-direction, x), -direction)));
}

/// Whether a light's node turns it.
bool has_direction(const Light& light) {
  return light.kind != LightKind::point && light.kind != LightKind::sphere;
}

EditedJson json_of(const dvec3& v) { return EditedJson::array({v.x, v.y, v.z}); }
EditedJson json_of(const dquat& q) { return EditedJson::array({q.x, q.y, q.z, q.w}); }

std::vector<double> numbers(const EditedJson& node, const char* key) {
  const auto found = node.find(key);
  return found != node.end() && found->is_array() ? found->get<std::vector<double>>() : std::vector<double>();
}

class LightWriter {
 public:
  LightWriter(EditedJson& root, const Scene& loaded, const Scene& edited)
      : root_(root), loaded_(loaded), edited_(edited), tree_(root) {}

  void write() {
    if (loaded_.lights == edited_.lights) return;
    for (const Light& before : loaded_.lights)
      if (std::none_of(edited_.lights.begin(), edited_.lights.end(),
                       [&](const Light& l) { return l.id == before.id; }))
        remove(before.id);
    for (const Light& light : edited_.lights) {
      const auto before = std::find_if(loaded_.lights.begin(), loaded_.lights.end(),
                                       [&](const Light& l) { return l.id == light.id; });
      if (before == loaded_.lights.end())
        add(light);
      else if (has_profile(*before) != has_profile(light))
        remove(before->id), add(light);
      else if (*before != light)
        change(*before, light);
    }
    drop_unused();
  }

 private:
  EditedJson& node(size_t index) { return root_["nodes"][index]; }
  EditedJson& definitions() { return array_at(extension_at(root_, root_, k_punctual), "lights"); }
  EditedJson& reference(size_t index) { return node(index)["extensions"][k_punctual]["light"]; }

  void remove(Id index) {
    for (const char* extension : {k_punctual, k_ies}) remove_extension(node(index), extension);
    for (const char* key : {"enabled", "off_intensity", "sun", "right"}) remove_own(node(index), key);
  }

  void add(const Light& light) {
    EditedJson made = EditedJson::object();
    if (!light.name.empty()) made["name"] = light.name;
    if (light.kind != LightKind::directional) place(made, dmat4(1), light);
    if (has_direction(light)) turn(made, dmat4(1), light);
    if (has_profile(light)) {
      refer_to_profile(made, light, true, !light.enabled);
    } else {
      EditedJson& list = definitions();
      list.push_back(definition(light, EditedJson::object(), {.off = !light.enabled}));
      const size_t index = list.size() - 1;
      extension_at(root_, made, k_punctual)["light"] = index;
    }
    if (!light.group.empty()) object_at(made, "extras")["light_group"] = light.group;
    write_own(made, light, true);
    add_root_node(root_, std::move(made));
  }

  void change(const Light& before, const Light& after) {
    Id index = before.id;
    const bool moved = before.position != after.position && after.kind != LightKind::directional;
    const bool turned = (before.direction != after.direction || before.right != after.right ||
                         can_roll(before) != can_roll(after)) &&
                        has_direction(after);
    if ((moved || turned) && !holds_light_only(index)) index = move_to_own_node(index, after);
    const dmat4 parent = tree_.world_of(tree_.parent(index));
    if (turned) turn(node(index), parent, after);
    if (moved) place(node(index), parent, after);
    if (before.group != after.group) regroup(index, after.group);
    const bool shown = tree_.is_visible(index), off = shown && !after.enabled;
    // The first versions left the intensity of a light that is off in its definition.
    const bool lit_elsewhere =
        off && !node(index).contains(EditedJson::json_pointer("/extras/lucerna/off_intensity"));
    const bool switched = before.enabled != after.enabled || lit_elsewhere;
    write_own(node(index), after, shown);
    if (has_profile(after)) {
      if (before.name != after.name) node(index)["name"] = after.name;
      if (switched || before.intensity != after.intensity || before.profile != after.profile)
        refer_to_profile(node(index), after, before.profile != after.profile, off);
      return;
    }
    const bool defined = switched || before.name != after.name || before.kind != after.kind ||
                         before.intensity != after.intensity || before.inner_cone != after.inner_cone ||
                         before.outer_cone != after.outer_cone || before.width != after.width ||
                         before.height != after.height || before.radius != after.radius ||
                         before.two_sided != after.two_sided || before.visible != after.visible ||
                         before.picture != after.picture;
    if (!defined) return;
    own_definition(index);
    EditedJson& slot = definitions()[reference(index).get<size_t>()];
    slot = definition(after, std::move(slot), {.off = off, .keep_picture = before.picture == after.picture});
  }

  bool holds_light_only(Id index) {
    const EditedJson& n = node(index);
    for (const char* key : {"mesh", "camera", "children", "skin"})
      if (n.contains(key)) return false;
    return n.at("extensions").size() == 1 && !tree_.is_animated(index);
  }

  /// Moves the light to a new first child of its node, which keeps its place in the order of lights.
  Id move_to_own_node(Id index, const Light& light) {
    EditedJson made = EditedJson::object();
    made["name"] = light.name;
    made["extensions"][extension_of(light)] = node(index)["extensions"][extension_of(light)];
    if (const auto extras = node(index).find("extras"); extras != node(index).end() && extras->is_object())
      if (const auto group = extras->find("light_group"); group != extras->end())
        made["extras"]["light_group"] = *group;
    remove(index);
    return tree_.add_first_child(index, std::move(made));
  }

  void place(EditedJson& n, const dmat4& parent, const Light& light) {
    const dvec3 world = dvec3(light.position) + loaded_.origin;
    const dvec3 local(glm::inverse(parent) * glm::dvec4(world, 1));
    if (std::vector<double> m = numbers(n, "matrix"); m.size() == 16) {
      for (int k = 0; k < 3; ++k) m[size_t(12 + k)] = local[k];
      n["matrix"] = m;
    } else {
      n["translation"] = json_of(local);
    }
  }

  static void turn(EditedJson& n, const dmat4& parent, const Light& light) {
    const dvec3 local = glm::normalize(glm::inverse(dmat3(parent)) * unit_within(light.direction));
    const dvec3 translation(NodeTree::local_matrix(n)[3]);
    // A scale may turn the axis; a light has none.
    n.erase("matrix"), n.erase("scale");
    if (translation != dvec3(0)) n["translation"] = json_of(translation);
    if (can_roll(light))
      n["rotation"] = json_of(turned_to(local, glm::inverse(dmat3(parent)) * dvec3(light.right)));
    else
      n["rotation"] = json_of(turned_to(local));
  }

  void regroup(Id index, const std::string& group) {
    if (!group.empty()) {
      object_at(node(index), "extras")["light_group"] = group;
      return;
    }
    remove_from(node(index), "extras", "light_group");
    if (!node(index)["extensions"].contains(k_punctual)) return;
    own_definition(index);
    remove_from(definitions()[reference(index).get<size_t>()], "extras", "light_group");
  }

  /// `shown`: nothing hides the node. A light that is switched off has intensity 0 in the file, for programs
  /// that do not read these extras.
  static void write_own(EditedJson& n, const Light& light, bool shown) {
    if (light.enabled == shown)
      remove_own(n, "enabled");
    else
      set_own(n, "enabled", light.enabled);
    if (shown && !light.enabled)
      set_own(n, "off_intensity", vector_json(light.intensity));
    else
      remove_own(n, "off_intensity");
    if (can_roll(light) && has_direction(light))
      set_own(n, "right", vector_json(light.right));
    else
      remove_own(n, "right");
    if (!light.sun) return remove_own(n, "sun");
    const SunTime& t = *light.sun;
    set_own(n, "sun",
            {{"date", date_text(t)},
             {"time", t.hours},
             {"zone", t.zone},
             {"latitude", t.latitude},
             {"longitude", t.longitude},
             {"north", t.north}});
  }

  /// Writes the node's multiplier and colour; `fresh`: with a new definition of the distribution; `off`: with
  /// multiplier 0.
  void refer_to_profile(EditedJson& n, const Light& light, bool fresh, bool off) {
    const auto [color, strength] = split_strength(light.intensity);
    if (fresh) {
      EditedJson& list = array_at(extension_at(root_, root_, k_ies), "lights");
      const auto [place, is_new] = written_.try_emplace(light.profile, list.size());
      if (is_new)
        list.push_back({{"uri", "data:application/x-ies-lm-63;base64," + base64(light.profile->text)},
                        {"mimeType", "application/x-ies-lm-63"},
                        {"name", light.profile->name}});
      extension_at(root_, n, k_ies)["light"] = place->second;
    }
    EditedJson& reference = extension_at(root_, n, k_ies);
    reference["multiplier"] = off ? 0.0 : double{strength} / light.profile->peak;
    reference["color"] = vector_json(color);
  }

  /// Gives the light a definition that no other node uses.
  void own_definition(Id index) {
    const auto used = reference(index).get<size_t>();
    size_t users = 0;
    for (const EditedJson& n : root_["nodes"])
      if (const auto e = n.find("extensions"); e != n.end() && e->contains(k_punctual))
        users += e->at(k_punctual).at("light").get<size_t>() == used;
    if (users < 2) return;
    EditedJson copy = definitions()[used];
    definitions().push_back(std::move(copy));
    reference(index) = definitions().size() - 1;
  }

  /// As read_own_shape() reads it.
  static void write_shape(EditedJson& n, const Light& light, bool keep_picture) {
    for (const char* key : {"shape", "radius", "width", "height", "length", "two_sided", "visible"})
      remove_own(n, key);
    if (!keep_picture) write_picture(n, light);
    if (!has_shape(light.kind)) return;
    set_own(n, "shape", kind_name(light.kind));
    if (light.kind == LightKind::rectangle) {
      set_own(n, "width", number_json(light.width));
      set_own(n, "height", number_json(light.height));
    } else {
      if (light.kind == LightKind::tube) set_own(n, "length", number_json(light.width));
      set_own(n, "radius", number_json(light.radius));
    }
    if (light.two_sided) set_own(n, "two_sided", true);
    if (!light.visible) set_own(n, "visible", false);
  }

  /// As own_picture() finds it.
  static void write_picture(EditedJson& n, const Light& light) {
    if (!light.picture) return remove_own(n, "picture");
    const std::vector<uint8_t>& file = light.picture->file;
    const std::string uri = "data:application/octet-stream;base64," +
                            base64({reinterpret_cast<const char*>(file.data()), file.size()});
    set_own(n, "picture", {{"uri", uri}, {"name", light.picture->name}});
  }

  struct DefinitionOptions {
    bool off = false;           ///< intensity 0
    bool keep_picture = false;  ///< as `from` names it
  };
  /// `from`, with this light.
  static EditedJson definition(const Light& light, EditedJson from, const DefinitionOptions& o) {
    // Of shapes, the kind whose light is the most like theirs.
    static constexpr const char* k_types[] = {"point", "spot", "directional", "point",
                                              "spot",  "spot", "point",       "point"};
    if (!light.name.empty()) from["name"] = light.name;
    from["type"] = k_types[static_cast<size_t>(light.kind)];
    write_shape(from, light, o.keep_picture);
    const auto [color, strength] = split_strength(light.intensity);
    from["color"] = vector_json(color);
    from["intensity"] = o.off ? EditedJson(0.0) : number_json(strength);
    if (from["type"] != "spot") {
      from.erase("spot");
      return from;
    }
    if (has_shape(light.kind)) {
      from["spot"] = {{"innerConeAngle", 0.0}, {"outerConeAngle", glm::radians(90.0)}};
      return from;
    }
    EditedJson& spot = object_at(from, "spot");
    // A float may be a little above pi / 2, and the inner cone must be the smaller one.
    double outer{light.outer_cone}, inner{light.inner_cone};
    outer = std::min(outer, glm::radians(90.0));
    if (inner >= outer) inner = outer * (1 - 1e-12);
    spot["innerConeAngle"] =
        light.inner_cone < light.outer_cone ? number_json(light.inner_cone) : EditedJson(inner);
    spot["outerConeAngle"] =
        outer < double{light.outer_cone} ? EditedJson(outer) : number_json(light.outer_cone);
    return from;
  }

  /// Definitions that lights of the loaded scene used, and no node uses any more.
  void drop_unused() {
    const auto extensions = root_.find("extensions");
    if (extensions == root_.end() || !extensions->contains(k_punctual)) return;
    EditedJson& list = definitions();
    std::vector<bool> used(list.size());
    for (const EditedJson& n : root_["nodes"])
      if (const auto e = n.find("extensions"); e != n.end() && e->contains(k_punctual))
        used[e->at(k_punctual).at("light").get<size_t>()] = true;
    // Animations may point at definitions by number.
    const EditedJson& names = root_["extensionsUsed"];
    const bool pointed = std::find(names.begin(), names.end(), "KHR_animation_pointer") != names.end();
    if (pointed || std::find(used.begin(), used.end(), false) == used.end()) return;
    std::vector<size_t> places(used.size());
    EditedJson kept = EditedJson::array();
    for (size_t i = 0; i < used.size(); ++i) {
      places[i] = kept.size();
      if (used[i]) kept.push_back(std::move(list[i]));
    }
    for (EditedJson& n : root_["nodes"])
      if (const auto e = n.find("extensions"); e != n.end() && e->contains(k_punctual))
        (*e)[k_punctual]["light"] = places[(*e)[k_punctual]["light"].get<size_t>()];
    if (!kept.empty()) {
      list = std::move(kept);
      return;
    }
    remove_extension(root_, k_punctual);
    drop_unused_extension(root_, k_punctual);
  }

  EditedJson& root_;
  const Scene &loaded_, &edited_;
  NodeTree tree_;
  std::map<std::shared_ptr<const LightProfile>, size_t> written_;  // their definitions
};

}  // namespace

void write_lights(EditedJson& root, const Scene& loaded, const Scene& edited) {
  LightWriter(root, loaded, edited).write();
}

}  // namespace lucerna::scene
