// Nodes -> instances, cameras, lights, in world space.
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

mat4 compose(const std::vector<double>& t, const std::vector<double>& r, const std::vector<double>& s) {
  glm::dmat4 m(1);
  if (t.size() == 3) m[3] = glm::dvec4(t[0], t[1], t[2], 1);
  if (r.size() == 4) m = m * glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
  if (s.size() == 3) m = m * glm::dmat4(glm::dvec4(s[0], 0, 0, 0), glm::dvec4(0, s[1], 0, 0), glm::dvec4(0, 0, s[2], 0), glm::dvec4(0, 0, 0, 1));
  return mat4(m);
}

bool singular(const mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return true;
  const double det = glm::determinant(glm::dmat3(m));
  const glm::dmat3 l(m);
  const double scale = glm::length(l[0]) * glm::length(l[1]) * glm::length(l[2]);
  return !(scale > 0) || !(std::abs(det) > 1e-12 * scale);
}

/// World matrices of EXT_mesh_gpu_instancing, or the node's alone.
std::vector<mat4> instancing(const Document& d, const tinygltf::Node& node, const mat4& world, const std::string& element) {
  const auto at = node.extensions.find("EXT_mesh_gpu_instancing");
  if (at == node.extensions.end() || !at->second.Has("attributes")) return {world};
  const tinygltf::Value& attributes = at->second.Get("attributes");
  const auto read = [&](const char* name, int n) {
    return attributes.Has(name) ? read_floats(d, attributes.Get(name).GetNumberAsInt(), n, element + "." + name) : std::vector<float>();
  };
  const std::vector<float> t = read("TRANSLATION", 3), r = read("ROTATION", 4), s = read("SCALE", 3);
  const size_t count = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
  const auto part = [](const std::vector<float>& v, size_t i, size_t n) {
    return i * n + n <= v.size() ? std::vector<double>(v.begin() + i * n, v.begin() + i * n + n) : std::vector<double>();
  };
  std::vector<mat4> out;
  for (size_t i = 0; i < count; ++i) out.push_back(world * compose(part(t, i, 3), part(r, i, 4), part(s, i, 3)));
  return out;
}

class Walker {
 public:
  Walker(Document& d, Scene& scene) : d_(d), scene_(scene), state_(d.model.nodes.size(), 0) {}

  void walk(int index, const mat4& parent, const std::string& from, int depth = 0) {
    if (index < 0 || size_t(index) >= d_.model.nodes.size()) d_.fail(from, fmt::format("node {} does not exist", index));
    const std::string element = fmt::format("nodes[{}]", index);
    if (state_[index] == 1) d_.fail(element, "the node graph has a cycle through this node");
    if (state_[index] == 2) d_.fail(element, fmt::format("has a second parent ({}); nodes form a tree", from));
    if (depth > 4096) d_.fail(element, "nodes are nested more than 4096 deep");
    state_[index] = 1;
    const tinygltf::Node& node = d_.model.nodes[index];
    const mat4 local = node.matrix.size() == 16 ? mat4(glm::make_mat4(node.matrix.data())) : compose(node.translation, node.rotation, node.scale);
    const mat4 world = parent * local;
    const std::string name = node.name.empty() ? fmt::format("node {}", index) : node.name;
    const auto light = node.extensions.find("KHR_lights_punctual");
    const bool used = node.mesh >= 0 || node.camera >= 0 || light != node.extensions.end();
    if (used && singular(world)) d_.fail(element, "its matrix (with those of its parents) is singular or not finite");
    if (node.mesh >= 0) {
      if (size_t(node.mesh) >= scene_.meshes.size()) d_.fail(element, fmt::format("mesh {} does not exist", node.mesh));
      for (const mat4& m : instancing(d_, node, world, element)) {
        if (singular(m)) d_.fail(element, "an instance's matrix is singular or not finite");
        scene_.instances.push_back({name, Id(node.mesh), m, glm::determinant(mat3(m)) < 0});
      }
    }
    if (node.camera >= 0) add_camera(node.camera, name, world, element);
    if (light != node.extensions.end() && light->second.Has("light"))
      add_light(light->second.Get("light").GetNumberAsInt(), name, world, element);
    for (int child : node.children) walk(child, world, element, depth + 1);
    state_[index] = 2;
  }

 private:
  void add_camera(int index, const std::string& node_name, const mat4& world, const std::string& element) {
    if (size_t(index) >= d_.model.cameras.size()) d_.fail(element, fmt::format("camera {} does not exist", index));
    const tinygltf::Camera& in = d_.model.cameras[index];
    Camera c;
    c.name = in.name.empty() ? node_name : in.name;
    c.to_world = world;
    if (in.type == "orthographic") {
      c.orthographic = true;
      c.xmag = float(in.orthographic.xmag);
      c.ymag = float(in.orthographic.ymag);
      if (!(c.ymag > 0) || !std::isfinite(c.ymag)) d_.fail(fmt::format("cameras[{}]", index), "ymag must be positive");
    } else {
      c.yfov = float(in.perspective.yfov);
      c.aspect = float(in.perspective.aspectRatio);
      if (!(c.yfov > 0 && c.yfov < k_pi)) d_.fail(fmt::format("cameras[{}]", index), fmt::format("yfov {} is not between 0 and pi", c.yfov));
    }
    scene_.cameras.push_back(c);
  }

  void add_light(int index, const std::string& node_name, const mat4& world, const std::string& element) {
    if (index < 0 || size_t(index) >= d_.model.lights.size()) d_.fail(element, fmt::format("light {} does not exist", index));
    const tinygltf::Light& in = d_.model.lights[index];
    Light l;
    l.name = in.name.empty() ? node_name : in.name;
    if (in.type == "point") l.kind = LightKind::point;
    else if (in.type == "spot") l.kind = LightKind::spot;
    else if (in.type == "directional") l.kind = LightKind::directional;
    else d_.fail(fmt::format("lights[{}]", index), fmt::format("type '{}' is unknown", in.type));
    vec3 tint(1);
    for (size_t k = 0; k < 3 && k < in.color.size(); ++k) tint[k] = float(in.color[k]);
    l.intensity = glm::max(vec3(0), tint * float(in.intensity));
    if (!std::isfinite(luminance(l.intensity))) d_.fail(fmt::format("lights[{}]", index), "its intensity is not finite");
    l.position = vec3(world[3]);
    l.direction = glm::normalize(-vec3(world[2]));
    if (l.kind == LightKind::spot) {
      l.inner_cone = float(in.spot.innerConeAngle);
      l.outer_cone = float(in.spot.outerConeAngle);
      if (!(l.outer_cone > 0 && l.outer_cone <= k_pi / 2 + 1e-4f && l.inner_cone >= 0 && l.inner_cone <= l.outer_cone))
        d_.fail(fmt::format("lights[{}]", index), "cone angles must be 0 <= inner <= outer <= pi/2");
    }
    scene_.lights.push_back(l);
  }

  Document& d_;
  Scene& scene_;
  std::vector<uint8_t> state_;  // 0 new, 1 being walked, 2 done
};

}  // namespace

void load_nodes(Document& d, Scene& scene) {
  Walker walker(d, scene);
  if (!d.model.scenes.empty()) {
    const int shown = d.model.defaultScene >= 0 ? d.model.defaultScene : 0;
    if (size_t(shown) >= d.model.scenes.size()) d.fail("scene", fmt::format("scene {} does not exist", shown));
    for (int node : d.model.scenes[shown].nodes) walker.walk(node, mat4(1), fmt::format("scenes[{}]", shown));
    return;
  }
  std::vector<uint8_t> child(d.model.nodes.size(), 0);
  for (size_t i = 0; i < d.model.nodes.size(); ++i)
    for (int c : d.model.nodes[i].children)
      if (c >= 0 && size_t(c) < child.size()) child[c] = 1;
  for (size_t i = 0; i < d.model.nodes.size(); ++i)
    if (!child[i]) walker.walk(int(i), mat4(1), "nodes");
}

}  // namespace lucerna::scene::io
