#include "scene/io/nodes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/io/accessor.h"
#include "scene/io/node_lights.h"
#include "scene/io/node_matrix.h"
#include "scene/io/own_extras.h"
#include "scene/range.h"

namespace lucerna::scene {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

enum class Kind {
  regular,  // invertible in single precision, in which the renderer computes
  flat,     // takes volumes to areas
  nothing,  // takes areas to lines or points
  endless,  // beyond single precision's range
};

Kind kind_of(const dmat4& m) {
  double largest = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r]) || std::abs(m[c][r]) > 1e18) return Kind::endless;
      if (c < 3) largest = std::max(largest, std::abs(m[c][r]));
    }
  if (largest == 0) return Kind::nothing;
  const dmat3 linear(m), unit = linear / largest;
  if (std::isnormal(static_cast<float>(glm::determinant(linear))) &&
      std::abs(glm::determinant(unit)) >= 1e-12)
    return Kind::regular;
  double area = 0;
  for (int c = 0; c < 3; ++c) area = std::max(area, glm::length(glm::cross(unit[c], unit[(c + 1) % 3])));
  return area < 1e-12 ? Kind::nothing : Kind::flat;
}

class Walker {
 public:
  Walker(Document& document, Scene& scene)
      : document_(document), scene_(scene), root_(document.root()), lights_(document) {}

  Placement walk() {
    struct Step {
      uint32_t node;
      dmat4 parent;
      bool hidden;
    };
    std::vector<Step> stack;
    const std::vector<uint32_t> roots = find_roots();
    for (size_t i = roots.size(); i-- > 0;) stack.push_back({roots[i], dmat4(1), false});
    while (!stack.empty()) {
      const auto [index, parent, below_hidden] = stack.back();
      stack.pop_back();
      const tinygltf::Node& node = document_.model.nodes[index];
      const Item item = root_.at("nodes").at(index);
      const bool hidden = below_hidden || !is_visible(item);
      dmat4 world;
      try {
        world = parent * local_matrix(node, item);
      } catch (const Error&) {
        if (holds_anything(index)) throw;
        continue;
      }
      visit(index, node, item, world, hidden);
      for (size_t i = node.children.size(); i-- > 0;)
        stack.push_back({static_cast<uint32_t>(node.children[i]), world, hidden});
    }
    return std::move(placement_);
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

  static bool is_visible(const Item& node) {
    const auto extensions = node.find("extensions");
    const auto visibility = extensions ? extensions->find("KHR_node_visibility") : std::nullopt;
    return !visibility || visibility->boolean("visible", true);
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
    return node_matrix(t, r, s);
  }

  // The node's matrix in the world, whether or not the scene shows the node.
  dmat4 global_matrix(uint32_t index) {
    if (globals_.empty()) {
      globals_.resize(document_.model.nodes.size());
      parents_.assign(globals_.size(), k_none);
      for (uint32_t i = 0; i < globals_.size(); ++i)
        for (int child : document_.model.nodes[i].children) parents_[static_cast<size_t>(child)] = i;
    }
    std::vector<uint32_t> chain;
    for (uint32_t at = index; at != k_none && !globals_[at]; at = parents_[at]) chain.push_back(at);
    for (size_t i = chain.size(); i-- > 0;) {
      const uint32_t at = chain[i], parent = parents_[at];
      const dmat4 local = local_matrix(document_.model.nodes[at], root_.at("nodes").at(at));
      globals_[at] = parent == k_none ? local : *globals_[parent] * local;
    }
    return *globals_[index];
  }

  std::vector<dmat4> joint_matrices(const Item& skin_of_node) {
    const auto skins = root_.find("skins");
    const uint32_t index = skin_of_node.index(skins ? skins->size() : 0, "skins");
    const Item skin = skins->at(index);
    const Item joints = skin.at("joints");
    if (joints.size() == 0) joints.fail("expected at least one");
    std::optional<AccessorReader> inverse;
    if (const auto found = skin.find("inverseBindMatrices")) {
      inverse.emplace(document_, found->index(document_.model.accessors.size(), "accessors"));
      if (inverse->components() != 16 || inverse->component_type() != TINYGLTF_COMPONENT_TYPE_FLOAT)
        found->fail("expected 4 x 4 matrices of floats");
      if (inverse->count() < joints.size())
        found->fail("{} matrices, but the skin has {} joints", inverse->count(), joints.size());
    }
    document_.budget.take(joints.size() * sizeof(dmat4), joints.where(), "{} joints", joints.size());
    std::vector<dmat4> result;
    result.reserve(joints.size());
    for (size_t i = 0; i < joints.size(); ++i) {
      glm::mat4 bind(1);
      if (inverse) inverse->read(i, &bind[0][0], 16);
      result.push_back(global_matrix(joints.at(i).index(document_.model.nodes.size(), "nodes")) *
                       dmat4(bind));
    }
    return result;
  }

  // Weights of morph targets: the node's, else the mesh's. Empty where all are 0.
  std::vector<float> morph_weights(const Item& node, uint32_t mesh) const {
    auto list = node.find("weights");
    if (!list) list = root_.at("meshes").at(mesh).find("weights");
    std::vector<float> weights;
    for (size_t i = 0; list && i < list->size(); ++i)
      weights.push_back(static_cast<float>(list->at(i).number()));
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0; })) weights.clear();
    return weights;
  }

  // The use of a mesh that all nodes with the same weights share.
  Id shared_use(uint32_t mesh, const std::vector<float>& weights) {
    const auto [place, fresh] = shared_.try_emplace(std::make_pair(mesh, weights), k_none);
    if (fresh) place->second = add_use({mesh, {weights, {}, {}}});
    return place->second;
  }

  Id add_use(MeshUse use) {
    placement_.uses.push_back(std::move(use));
    return static_cast<Id>(placement_.uses.size() - 1);
  }

  void visit(uint32_t index, const tinygltf::Node& node, const Item& item, const dmat4& world, bool hidden) {
    const auto extensions = item.find("extensions");
    const auto light = light_of(index);
    const bool portal = is_portal(item, node.mesh);
    if (portal && node.mesh < 0)
      document_.warnings.add("{} nodes with extras.portal but without a mesh: no portals", item.path());
    const auto profile = extensions ? extensions->find("EXT_lights_ies") : std::nullopt;
    if (node.mesh < 0 && node.camera < 0 && !light && !profile) return;
    const auto skin = node.mesh >= 0 ? item.find("skin") : std::nullopt;
    const Kind kind = kind_of(world);
    if (kind == Kind::endless && (!skin || node.camera >= 0 || light || profile))
      item.fail("the node's matrix in the world is not finite");
    const std::string name = node.name.empty() ? fmt::format("node {}", index) : node.name;
    const std::string group = light_group(item);
    if (node.mesh >= 0) {
      const auto mesh = static_cast<uint32_t>(node.mesh);
      const size_t before = scene_.instances.size();
      const auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
      const std::vector<float> weights = morph_weights(item, mesh);
      if (skin && instancing)
        document_.warnings.add("{} skinned meshes with EXT_mesh_gpu_instancing: shown once",
                               instancing->path());
      if (skin)
        place_skinned(name, add_use({mesh, {weights, joint_matrices(*skin), world}}), item);
      else if (instancing)
        add_instances(*instancing, name, mesh, weights, world);
      else
        add_instance(name, mesh, weights, world, item.path());
      const std::optional<dmat4> exact = instancing ? std::nullopt : own_matrix(item, "to_world");
      for (size_t i = before; i < scene_.instances.size(); ++i) {
        Instance& instance = scene_.instances[i];
        instance.group = group, instance.hidden = hidden, instance.node = index;
        if (exact) instance.to_world = mat4(*exact);
      }
      if (portal) make_portals(before, item.path(), hidden);
    }
    if ((node.camera >= 0 || light || profile) && kind == Kind::nothing) {
      document_.warnings.add("{} cameras or lamps in nodes of scale 0: left out", item.path());
      return;
    }
    if (node.camera >= 0) add_camera(name, static_cast<size_t>(node.camera), world);
    // A punctual light beside a profile is for programs that do not read profiles.
    std::optional<Light> read;
    if (profile)
      read = lights_.with_profile(*profile, {index, name, group, world, hidden});
    else if (light)
      read = lights_.punctual(*light, {index, name, group, world, hidden});
    if (read) {
      scene_.lights.push_back(*std::move(read));
      placement_.lights.emplace_back(world[3]);
    }
  }

  bool is_portal(const Item& node, int mesh) const {
    if (const auto marked = portal_mark(node)) return *marked;
    return mesh >= 0 && portal_mark(root_.at("meshes").at(static_cast<size_t>(mesh))).value_or(false);
  }

  // Turns the instances from there on into portals, unless they are hidden.
  void make_portals(size_t first, const std::string& where, bool hidden) {
    for (size_t i = first; !hidden && i < placement_.instances.size(); ++i) {
      const Instance& instance = std::as_const(scene_.instances)[i];
      placement_.portals.push_back(
          {instance.name, where, instance.mesh, placement_.instances[i], instance.flipped});
    }
    scene_.instances.resize(first);
    placement_.instances.resize(first);
  }

  void place_instance(const std::string& name, Id use, const dmat4& world) {
    scene_.instances.push_back({name, use, mat4(0), glm::determinant(dmat3(world)) < 0, {}});
    placement_.instances.push_back(world);
  }

  void place_skinned(const std::string& name, Id use, const Item& node) {
    const dmat4 to_world = own_matrix(node, "skin_to_world").value_or(dmat4(1));
    if (kind_of(to_world) != Kind::regular) node.fail("extras.lucerna.skin_to_world cannot be inverted");
    place_instance(name, use, to_world);
  }

  void add_instance(const std::string& name, uint32_t mesh, const std::vector<float>& weights,
                    const dmat4& world, const std::string& where) {
    const Kind kind = kind_of(world);
    if (kind == Kind::nothing)
      document_.warnings.add("{} meshes in nodes or instances of scale 0: left out", where);
    else if (kind == Kind::flat)
      place_instance(name, add_use({mesh, {weights, {}, world}}), dmat4(1));
    else
      place_instance(name, shared_use(mesh, weights), world);
  }

  void add_instances(const Item& extension, const std::string& name, uint32_t mesh,
                     const std::vector<float>& weights, const dmat4& world) {
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
    document_.budget.take(count * (sizeof(Instance) + sizeof(dmat4) + (text > 15 ? text + 17 : 0)),
                          extension.where(), "{} instances", count);
    scene_.instances.reserve(scene_.instances.size() + count);
    placement_.instances.reserve(placement_.instances.size() + count);
    for (size_t i = 0; i < count; ++i) {
      vec3 t(0), s(1);
      vec4 q(0, 0, 0, 1);
      if (readers[0]) readers[0]->read(i, &t[0], 3);
      if (readers[1]) readers[1]->read(i, &q[0], 4);
      if (readers[2]) readers[2]->read(i, &s[0], 3);
      glm::dquat r(q.w, q.x, q.y, q.z);
      // Items of size 0 may have no rotation either.
      if (s == vec3(0)) r = glm::dquat(1, 0, 0, 0);
      const dmat4 to_world = world * node_matrix(dvec3(t), r / glm::length(r), dvec3(s));
      if (kind_of(to_world) == Kind::endless) extension.fail("the matrix of instance {} is not finite", i);
      add_instance(fmt::format("{} #{}", name, i), mesh, weights, to_world,
                   fmt::format("{}, instance {}", extension.path(), i));
    }
  }

  void add_camera(const std::string& node, size_t index, const dmat4& world) {
    const Item item = root_.at("cameras").at(index);
    Camera camera;
    camera.name = item.text("name", node);
    if (camera.name.empty()) camera.name = node;
    // Right angles and unit lengths: a camera has no scale, though a mirrored one stays mirrored.
    const dvec3 z = axis(world, 2), up = axis(world, 1);
    dvec3 y = up - z * glm::dot(z, up);
    if (glm::length(y) < 1e-9) y = glm::cross(z, dvec3(world[0]));
    y = glm::normalize(y);
    dvec3 x = glm::cross(y, z) * (glm::determinant(dmat3(world)) < 0 ? -1.0 : 1.0);
    try {
      read_lens(item, camera);
    } catch (const Error& error) {
      // An invalid camera counts as missing; it must not prevent loading of the scene.
      document_.warnings.add("{} cameras that cannot be used: left out", error.what());
      return;
    }
    if (!camera.orthographic) try {
        Camera with_lens = camera;
        read_extras(item, with_lens);
        check_range(with_lens);
        camera = with_lens;
      } catch (const Error& error) {
        document_.warnings.add("{} lenses of cameras that cannot be used: pinholes instead", error.what());
      }
    try {
      read_own_section(item, camera);
    } catch (const Error& error) {
      document_.warnings.add("{} section planes of cameras that cannot be used: left out", error.what());
    }
    if (camera.xmag < 0) x = -x;
    if (camera.ymag < 0) y = -y;
    camera.xmag = std::abs(camera.xmag), camera.ymag = std::abs(camera.ymag);
    camera.to_world = mat4(dmat4(dvec4(x, 0), dvec4(y, 0), dvec4(z, 0), dvec4(0, 0, 0, 1)));
    placement_.cameras.push_back(world);
    scene_.cameras.push_back(camera);
  }

  /// extras.lucerna of a glTF camera: what no extension covers.
  static void read_extras(const Item& item, Camera& camera) {
    const auto extras = item.find("extras");
    if (!extras || !extras->json().is_object()) return;
    const auto own = extras->find("lucerna");
    if (!own) return;
    Lens& lens = camera.lens;
    if (const auto f = own->find("f_number")) {
      lens.f_number = static_cast<float>(f->number());
      if (!(lens.f_number > 0)) f->fail("{} is not above 0", lens.f_number);
    }
    if (const auto focus = own->find("focus_distance"))
      lens.focus_distance = static_cast<float>(focus->number());
    if (own->find("aperture_blades")) {
      const double blades = own->at("aperture_blades").number();
      if (!(blades == 0 || (blades >= 3 && blades <= k_max_blades)) || blades != std::floor(blades))
        own->at("aperture_blades")
            .fail("{} is neither 0 nor a whole number from 3 to {}", blades, k_max_blades);
      lens.blades = static_cast<uint32_t>(blades);
    }
    lens.rotation = static_cast<float>(own->number("aperture_rotation", 0));
    if (const auto projection = own->find("projection")) {
      const std::string& name = projection->text();
      const auto at = std::find(std::begin(k_projection_names), std::end(k_projection_names), name);
      if (at == std::end(k_projection_names))
        projection->fail("'{}', expected {}", name, fmt::join(k_projection_names, ", "));
      camera.wide = Wide(at - std::begin(k_projection_names));
    }
    camera.shift.x = static_cast<float>(own->number("shift_right", 0));
    camera.shift.y = static_cast<float>(own->number("shift_up", 0));
  }

  // Fills what a glTF camera says of its lens; negative xmag and ymag, which mirror the picture, stay so.
  void read_lens(const Item& item, Camera& camera) {
    const std::string& type = item.at("type").text();
    const auto within = [](const Item& parent, const char* key, double least, double most) {
      const double value = parent.at(key).number();
      if (value == 0 || !(value >= least) || value > most)
        parent.at(key).fail("{} is not {} and at most {}", value, least < 0 ? "other than 0" : "above 0",
                            most);
      return static_cast<float>(value);
    };
    if (type == "perspective") {
      const Item p = item.at("perspective");
      camera.yfov = within(p, "yfov", 0, 3.14);
      if (p.find("aspectRatio")) camera.aspect = within(p, "aspectRatio", 0, 1e4);
    } else if (type == "orthographic") {
      const Item o = item.at("orthographic");
      camera.orthographic = true;
      camera.xmag = within(o, "xmag", -1e9, 1e9);
      camera.ymag = within(o, "ymag", -1e9, 1e9);
      camera.aspect = std::abs(camera.xmag / camera.ymag);
      if (camera.xmag < 0 || camera.ymag < 0)
        document_.warnings.add("{} cameras with a negative xmag or ymag: their pictures are mirrored",
                               o.path());
    } else {
      item.at("type").fail("'{}', expected perspective or orthographic", type);
    }
  }

  Document& document_;
  Scene& scene_;
  Item root_;
  NodeLights lights_;
  Placement placement_;
  std::map<std::pair<uint32_t, std::vector<float>>, Id> shared_;
  std::vector<std::optional<dmat4>> globals_;  // by node, computed on demand
  std::vector<uint32_t> parents_;
};

}  // namespace

std::optional<Item> default_scene(const Document& document) {
  const Item root = document.root();
  const auto scenes = root.find("scenes");
  if (!scenes || scenes->size() == 0) return std::nullopt;
  return scenes->at(
      static_cast<size_t>(root.integer("scene", 0, 0, static_cast<int64_t>(scenes->size()) - 1)));
}

Placement load_nodes(Document& document, Scene& scene) { return Walker(document, scene).walk(); }

}  // namespace lucerna::scene
