#include "scene/io/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scene/io/accessor.h"

namespace lucerna::scene {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

dmat4 trs(const dvec3& t, const glm::dquat& r, const dvec3& s) {
  const dmat3 rotation = glm::mat3_cast(r);
  return dmat4(dvec4(rotation[0] * s.x, 0), dvec4(rotation[1] * s.y, 0), dvec4(rotation[2] * s.z, 0),
               dvec4(t, 1));
}

// Singular as far as single precision can tell, which is what the renderer computes with.
bool singular(const dmat4& m) {
  double largest = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r]) || std::abs(m[c][r]) > 1e18) return true;
      if (c < 3) largest = std::max(largest, std::abs(m[c][r]));
    }
  const auto determinant = static_cast<float>(glm::determinant(dmat3(m)));
  if (!std::isnormal(determinant)) return true;
  return std::abs(glm::determinant(dmat3(m) / largest)) < 1e-12;
}

dvec3 unit(const dvec4& column) { return glm::normalize(dvec3(column)); }

class Walker {
 public:
  Walker(Document& document, Scene& scene) : document_(document), scene_(scene), root_(document.root()) {}

  void walk() {
    std::vector<std::pair<uint32_t, dmat4>> stack;
    const std::vector<uint32_t> roots = find_roots();
    for (size_t i = roots.size(); i-- > 0;) stack.emplace_back(roots[i], dmat4(1));
    while (!stack.empty()) {
      const auto [index, parent] = stack.back();
      stack.pop_back();
      const tinygltf::Node& node = document_.model.nodes[index];
      const Item item = root_.at("nodes").at(index);
      const dmat4 local = local_matrix(node, item);
      // The first singular matrix on the way down is the culprit; what hangs below decides whether it
      // matters.
      if (singular(local) && holds_anything(index))
        item.fail(
            "the node's matrix is singular or not finite, but the node or one below holds a mesh, camera or "
            "light");
      const dmat4 world = parent * local;
      visit(index, node, item, world);
      for (size_t i = node.children.size(); i-- > 0;)
        stack.emplace_back(static_cast<uint32_t>(node.children[i]), world);
    }
  }

 private:
  std::vector<uint32_t> find_roots() const {
    std::vector<uint32_t> roots;
    if (const auto scene = default_scene(document_)) {
      if (const auto nodes = scene->find("nodes"))
        for (size_t i = 0; i < nodes->size(); ++i)
          roots.push_back(nodes->at(i).index(document_.model.nodes.size(), "nodes"));
      return roots;
    }
    std::vector<bool> is_child(document_.model.nodes.size());
    for (const tinygltf::Node& node : document_.model.nodes)
      for (int child : node.children) is_child[static_cast<size_t>(child)] = true;
    for (uint32_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) roots.push_back(i);
    return roots;
  }

  std::optional<Item> light_of(uint32_t index) const {
    const auto extensions = root_.at("nodes").at(index).find("extensions");
    return extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
  }

  bool holds_anything(uint32_t index) const {
    std::vector<uint32_t> stack{index};
    while (!stack.empty()) {
      const uint32_t at = stack.back();
      stack.pop_back();
      const tinygltf::Node& node = document_.model.nodes[at];
      if (node.mesh >= 0 || node.camera >= 0 || light_of(at)) return true;
      for (int child : node.children) stack.push_back(static_cast<uint32_t>(child));
    }
    return false;
  }

  static dmat4 local_matrix(const tinygltf::Node& node, const Item& item) {
    if (node.matrix.size() == 16) {
      dmat4 m;
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) m[c][r] = node.matrix[static_cast<size_t>(4 * c + r)];
      const dvec4 last(m[0][3], m[1][3], m[2][3], m[3][3] - 1);
      if (glm::length(last) > 1e-4) item.at("matrix").fail("the last row is not 0 0 0 1");
      m[0][3] = m[1][3] = m[2][3] = 0;
      m[3][3] = 1;
      return m;
    }
    dvec3 t(0), s(1);
    glm::dquat r(1, 0, 0, 0);
    if (node.translation.size() == 3) t = {node.translation[0], node.translation[1], node.translation[2]};
    if (node.scale.size() == 3) s = {node.scale[0], node.scale[1], node.scale[2]};
    if (node.rotation.size() == 4) {
      r = glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      const double length = glm::length(r);
      if (!(length > 1e-6) || !std::isfinite(length))
        item.at("rotation").fail("a quaternion of length 0 is no rotation");
      r = r / length;
    }
    return trs(t, r, s);
  }

  void visit(uint32_t index, const tinygltf::Node& node, const Item& item, const dmat4& world) {
    const auto extensions = item.find("extensions");
    const auto light = light_of(index);
    const bool holds = node.mesh >= 0 || node.camera >= 0 || light;
    if (holds && singular(world)) item.fail("the node's matrix in the world is singular or not finite");
    const std::string name = node.name.empty() ? fmt::format("node {}", index) : node.name;
    const std::string group = light_group(item);
    if (node.mesh >= 0) {
      const size_t before = scene_.instances.size();
      const auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
      if (instancing)
        add_instances(*instancing, name, static_cast<Id>(node.mesh), world);
      else
        add_instance(name, static_cast<Id>(node.mesh), world);
      for (size_t i = before; !group.empty() && i < scene_.instances.size(); ++i)
        scene_.instances[i].group = group;
    }
    if (node.camera >= 0) add_camera(name, static_cast<size_t>(node.camera), world);
    if (light) add_light(*light, name, world, group);
  }

  void add_instance(const std::string& name, Id mesh, const dmat4& world) {
    scene_.instances.push_back({name, mesh, mat4(world), glm::determinant(dmat3(world)) < 0, {}});
  }

  void add_instances(const Item& extension, const std::string& name, Id mesh, const dmat4& world) {
    const Item attributes = extension.at("attributes");
    std::optional<AccessorReader> readers[3];
    const char* keys[3] = {"TRANSLATION", "ROTATION", "SCALE"};
    size_t count = 0;
    for (int k = 0; k < 3; ++k) {
      const auto found = attributes.find(keys[k]);
      if (!found) continue;
      readers[k].emplace(document_, found->index(document_.model.accessors.size(), "accessors"));
      const int expected = k == 1 ? 4 : 3;
      if (readers[k]->components() != expected)
        found->fail("{} components, expected {}", readers[k]->components(), expected);
      if (count != 0 && readers[k]->count() != count)
        found->fail("{} elements, but another attribute has {}", readers[k]->count(), count);
      count = readers[k]->count();
    }
    if (count > 0 && std::none_of(std::begin(readers), std::end(readers),
                                  [](const auto& reader) { return reader && reader->backed(); }))
      attributes.fail("{} instances, of which no attribute has a buffer view", count);
    const size_t text = name.size() + 1 + std::to_string(count).size();
    document_.budget.take(count * (sizeof(Instance) + (text > 15 ? text + 17 : 0)), extension.where(),
                          "{} instances", count);
    scene_.instances.reserve(scene_.instances.size() + count);
    for (size_t i = 0; i < count; ++i) {
      vec3 t(0), s(1);
      vec4 q(0, 0, 0, 1);
      if (readers[0]) readers[0]->read(i, &t[0], 3);
      if (readers[1]) readers[1]->read(i, &q[0], 4);
      if (readers[2]) readers[2]->read(i, &s[0], 3);
      const glm::dquat r(q.w, q.x, q.y, q.z);
      const dmat4 to_world = world * trs(dvec3(t), r / glm::length(r), dvec3(s));
      if (singular(to_world)) extension.fail("the matrix of instance {} is singular or not finite", i);
      add_instance(fmt::format("{} #{}", name, i), mesh, to_world);
    }
  }

  void add_camera(const std::string& node, size_t index, const dmat4& world) {
    const Item item = root_.at("cameras").at(index);
    Camera camera;
    camera.name = item.text("name", node);
    if (camera.name.empty()) camera.name = node;
    // Right angles and unit lengths: a camera has no scale, though a mirrored one stays mirrored.
    const dvec3 z = unit(world[2]);
    const dvec3 y = glm::normalize(dvec3(world[1]) - z * glm::dot(z, dvec3(world[1])));
    const dvec3 x = glm::cross(y, z) * (glm::determinant(dmat3(world)) < 0 ? -1.0 : 1.0);
    camera.to_world = mat4(dmat4(dvec4(x, 0), dvec4(y, 0), dvec4(z, 0), world[3]));
    const std::string& type = item.at("type").text();
    const auto positive = [](const Item& parent, const char* key, double most) {
      const double value = parent.at(key).number();
      if (!(value > 0) || value > most) parent.at(key).fail("{} is not above 0 and at most {}", value, most);
      return static_cast<float>(value);
    };
    if (type == "perspective") {
      const Item p = item.at("perspective");
      camera.yfov = positive(p, "yfov", 3.14);
      if (p.find("aspectRatio")) camera.aspect = positive(p, "aspectRatio", 1e4);
    } else if (type == "orthographic") {
      const Item o = item.at("orthographic");
      camera.orthographic = true;
      camera.xmag = positive(o, "xmag", 1e9);
      camera.ymag = positive(o, "ymag", 1e9);
      camera.aspect = camera.xmag / camera.ymag;
    } else {
      item.at("type").fail("'{}', expected perspective or orthographic", type);
    }
    scene_.cameras.push_back(camera);
  }

  void add_light(const Item& reference, const std::string& node, const dmat4& world,
                 const std::string& group) {
    const auto extensions = root_.find("extensions");
    const auto punctual = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    const auto lights = punctual ? punctual->find("lights") : std::nullopt;
    if (!lights) reference.fail("the file has no extensions.KHR_lights_punctual.lights");
    const Item item = lights->at(reference.at("light").index(lights->size(), "lights"));
    Light light;
    light.name = item.text("name", node);
    if (light.name.empty()) light.name = node;
    light.group = group.empty() ? light_group(item) : group;
    const std::string& type = item.at("type").text();
    if (type == "point") {
      light.kind = LightKind::point;
    } else if (type == "spot") {
      light.kind = LightKind::spot;
    } else if (type == "directional") {
      light.kind = LightKind::directional;
    } else {
      item.at("type").fail("'{}', expected point, spot or directional", type);
    }
    const auto color = item.find("color");
    const vec3 value = (color ? color->rgb() : vec3(1)) * static_cast<float>(item.number("intensity", 1));
    light.intensity = glm::clamp(value, vec3(0), vec3(1e30f));
    if (value != light.intensity)
      document_.warnings.add("{} lights with a negative or endless intensity: clamped", item.path());
    light.position = vec3(world[3]);
    light.direction = vec3(-unit(world[2]));
    if (const auto spot = item.find("spot"); spot && light.kind == LightKind::spot) {
      const double outer = spot->number("outerConeAngle", glm::radians(45.0));
      const double inner = spot->number("innerConeAngle", 0);
      const double half_turn = glm::radians(90.0);
      light.outer_cone = static_cast<float>(std::clamp(outer, 1e-4, half_turn));
      light.inner_cone = std::clamp(static_cast<float>(inner), 0.0f, light.outer_cone);
      // A float pi / 2 written in decimal may lie a rounding above pi / 2.
      if (outer <= 0 || outer > half_turn + 1e-6 || inner < 0 || inner > outer)
        document_.warnings.add("{} spot lights whose cone angles are not 0 <= inner < outer <= pi/2: clamped",
                               spot->path());
    }
    scene_.lights.push_back(light);
  }

  Document& document_;
  Scene& scene_;
  Item root_;
};

}  // namespace

std::optional<Item> default_scene(const Document& document) {
  const Item root = document.root();
  const auto scenes = root.find("scenes");
  if (!scenes || scenes->size() == 0) return std::nullopt;
  return scenes->at(
      static_cast<size_t>(root.integer("scene", 0, 0, static_cast<int64_t>(scenes->size()) - 1)));
}

void load_nodes(Document& document, Scene& scene) { Walker(document, scene).walk(); }

}  // namespace lucerna::scene
