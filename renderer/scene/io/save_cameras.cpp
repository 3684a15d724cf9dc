#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

using glm::dvec3;

/// `camera`: the former definition, of which the rest is kept.
EditedJson definition(const Camera& c, const dvec3& origin, EditedJson camera) {
  for (const char* key : {"perspective", "orthographic"}) camera.erase(key);
  for (const char* key : {"f_number", "focus_distance", "aperture_blades", "aperture_rotation", "shift_right",
                          "shift_up", "section", "projection"})
    remove_own(camera, key);
  camera["name"] = c.name;
  camera["type"] = c.orthographic ? "orthographic" : "perspective";
  if (c.orthographic) {
    camera["orthographic"] = {
        {"xmag", number_json(c.xmag)}, {"ymag", number_json(c.ymag)}, {"zfar", 1000}, {"znear", 0.01}};
  } else {
    EditedJson lens = EditedJson::object();
    if (c.aspect > 0) lens["aspectRatio"] = number_json(c.aspect);
    lens["yfov"] = number_json(c.yfov);
    lens["znear"] = 0.01;
    camera["perspective"] = std::move(lens);
    if (c.lens.f_number > 0) {
      set_own(camera, "f_number", number_json(c.lens.f_number));
      set_own(camera, "focus_distance", number_json(c.lens.focus_distance));
      if (c.lens.blades > 0) set_own(camera, "aperture_blades", c.lens.blades);
      if (c.lens.rotation != 0) set_own(camera, "aperture_rotation", number_json(c.lens.rotation));
    }
    if (c.wide != Wide::none) set_own(camera, "projection", k_projection_names[size_t(c.wide)]);
    if (c.shift.x != 0) set_own(camera, "shift_right", number_json(c.shift.x));
    if (c.shift.y != 0) set_own(camera, "shift_up", number_json(c.shift.y));
  }
  if (c.section.cuts()) {
    const double offset = double{c.section.offset} + glm::dot(dvec3(c.section.normal), origin);
    set_own(camera, "section",
            {{"normal", vector_json(c.section.normal)}, {"offset", number_json(static_cast<float>(offset))}});
  }
  return camera;
}

EditedJson node_of(const Camera& c, const dvec3& origin, EditedJson node) {
  const glm::dmat3 axes(c.to_world);
  // A mirrored camera is a rotated one that is scaled by -1 along x.
  const bool mirrored = glm::determinant(axes) < 0;
  glm::dmat3 turned(glm::normalize(mirrored ? -axes[0] : axes[0]), glm::normalize(axes[1]),
                    glm::normalize(axes[2]));
  const glm::dquat r = glm::normalize(glm::quat_cast(turned));
  const dvec3 t = dvec3(c.to_world[3]) + origin;
  for (const char* key : {"matrix", "scale"}) node.erase(key);
  if (!node.contains("name")) node["name"] = c.name;
  node["translation"] = {t.x, t.y, t.z};
  node["rotation"] = {r.x, r.y, r.z, r.w};
  if (mirrored) node["scale"] = {-1, 1, 1};
  return node;
}

/// The node of the camera that load() gives that name; nothing if there is none.
std::optional<size_t> find_camera_node(const EditedJson& root, const std::string& name) {
  const auto nodes = root.find("nodes");
  if (nodes == root.end()) return std::nullopt;
  for (size_t i = 0; i < nodes->size(); ++i) {
    const EditedJson& node = (*nodes)[i];
    const auto camera = node.find("camera");
    if (camera == node.end()) continue;
    const EditedJson& definition = root.at("cameras")[camera->get<size_t>()];
    const std::string own = definition.value("name", std::string());
    if ((own.empty() ? node.value("name", std::string()) : own) == name) return i;
  }
  return std::nullopt;
}

/// True if the node is a root that holds nothing else, and its camera is in no other node.
bool holds_camera_only(const EditedJson& root, size_t index) {
  const EditedJson& node = root.at("nodes")[index];
  for (const char* key : {"mesh", "children", "skin", "extensions"})
    if (node.contains(key)) return false;
  size_t users = 0;
  for (const EditedJson& other : root.at("nodes")) {
    if (const auto camera = other.find("camera"); camera != other.end())
      users += camera->get<size_t>() == node.at("camera").get<size_t>();
    if (const auto children = other.find("children"); children != other.end())
      for (const EditedJson& child : *children)
        if (child.get<size_t>() == index) return false;
  }
  return users == 1;
}

}  // namespace

void write_cameras(EditedJson& root, const dvec3& origin, const std::vector<Camera>& cameras) {
  for (const Camera& camera : cameras) {
    EditedJson& list = array_at(root, "cameras");
    const auto old = find_camera_node(root, camera.name);
    if (old && holds_camera_only(root, *old)) {
      EditedJson& node = root["nodes"][*old];
      EditedJson& slot = list[node["camera"].get<size_t>()];
      slot = definition(camera, origin, slot);
      node = node_of(camera, origin, node);
      continue;
    }
    if (old) root["nodes"][*old].erase("camera");
    list.push_back(definition(camera, origin, EditedJson::object()));
    EditedJson node = node_of(camera, origin, EditedJson::object());
    node["camera"] = list.size() - 1;
    add_root_node(root, std::move(node));
  }
}

}  // namespace lucerna::scene
