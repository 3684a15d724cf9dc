#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <set>

#include "base/error.h"
#include "scene/io/node_matrix.h"
#include "scene/io/node_tree.h"
#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

constexpr const char* k_instancing = "EXT_mesh_gpu_instancing";
constexpr size_t k_most_copies = 65536;  // of one node's instances, as nodes

dmat4 moved_by(const dvec3& by) { return glm::translate(dmat4(1), by); }

/// Largest number of the matrix's three axes.
double extent_of(const dmat4& m) {
  double most = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) most = std::max(most, std::abs(m[c][r]));
  return most;
}

bool has_inverse(const dmat4& m) {
  const double size = extent_of(m);
  return size > 0 && std::abs(glm::determinant(dmat3(m) / size)) > 1e-12;
}

/// True if the axes of a node's matrix have right angles, as glTF demands.
bool is_rigid(const dmat4& m) {
  const dvec3 x = glm::normalize(dvec3(m[0])), y = glm::normalize(dvec3(m[1])),
              z = glm::normalize(dvec3(m[2]));
  constexpr double k_least = 1e-5;
  return std::abs(glm::dot(x, y)) < k_least && std::abs(glm::dot(y, z)) < k_least &&
         std::abs(glm::dot(z, x)) < k_least;
}

/// A rotation whose axes the matrix takes to perpendicular ones: m * rotation has right angles. Jacobi's
/// method on transposed(m) * m.
dmat3 right_angles(const dmat3& m) {
  dmat3 a = glm::transpose(m) * m, turned(1);
  for (int sweep = 0; sweep < 32; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (std::abs(a[q][p]) < 1e-300) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[q][p]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        dmat3 turn(1);
        turn[p][p] = turn[q][q] = c, turn[q][p] = s, turn[p][q] = -s;
        a = glm::transpose(turn) * a * turn, turned = turned * turn;
      }
  return turned;
}

EditedJson matrix_json(const dmat4& m) {
  EditedJson json = EditedJson::array();
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) json.push_back(double_json(m[c][r]));
  return json;
}

class ObjectWriter {
 public:
  ObjectWriter(EditedJson& root, const Scene& loaded, const Scene& edited, std::vector<std::string>& notes)
      : root_(root), loaded_(loaded), edited_(edited), notes_(notes), tree_(root) {}

  void write() {
    if (loaded_.instances.shares_with(edited_.instances)) return;
    const std::vector<Instance>&before = loaded_.instances, &after = edited_.instances;
    for (const Instance& instance : before) nodes_.push_back(instance.node);
    for (size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
      const bool moved = before[i].to_world != after[i].to_world,
                 turned = before[i].hidden != after[i].hidden;
      if ((!moved && !turned) || before[i].node == k_none) continue;
      if (has_extension(nodes_[i], k_instancing)) split(nodes_[i]);
      // A split has placed it already.
      if (moved && !split_.contains(before[i].node)) place(i);
      if (!turned) continue;
      if (after[i].hidden)
        hide(i);
      else
        show(i);
    }
    drop_unused_extension(root_, k_instancing);
    drop_unused_extension(root_, k_visibility);
  }

 private:
  EditedJson& node(Id index) { return tree_.node(index); }

  bool has_extension(Id index, const char* name) const {
    const auto extensions = tree_.node(index).find("extensions");
    return extensions != tree_.node(index).end() && extensions->contains(name);
  }

  bool holds_mesh_only(Id index) const {
    const EditedJson& n = tree_.node(index);
    if (n.contains("children") || n.contains("camera")) return false;
    for (const char* light : {"KHR_lights_punctual", "EXT_lights_ies"})
      if (has_extension(index, light)) return false;
    return !tree_.is_animated(index) && !tree_.is_joint(index);
  }

  /// A node for the mesh of a node alone.
  static EditedJson mesh_node(const EditedJson& from, const std::string& name) {
    EditedJson made = EditedJson::object();
    made["name"] = name;
    for (const char* key : {"mesh", "skin", "weights"})
      if (const auto found = from.find(key); found != from.end()) made[key] = *found;
    if (const auto extras = from.find("extras"); extras != from.end() && extras->is_object()) {
      for (const char* key : {"light_group", "portal"})
        if (const auto found = extras->find(key); found != extras->end()) made["extras"][key] = *found;
      if (const auto own = extras->find("lucerna"); own != extras->end() && own->is_object())
        for (const char* key : {"to_world", "skin_to_world"})
          if (const auto found = own->find(key); found != own->end()) made["extras"]["lucerna"][key] = *found;
    }
    return made;
  }

  void take_mesh(Id index) {
    for (const char* key : {"mesh", "skin", "weights"}) node(index).erase(key);
    for (const char* key : {"to_world", "skin_to_world"}) remove_own(node(index), key);
  }

  /// The node that holds nothing but the instance's mesh: its own or a new first child, which keeps the order
  /// of instances.
  Id carrier(size_t i) {
    Id& index = nodes_[i];
    if (holds_mesh_only(index)) return index;
    EditedJson made = mesh_node(node(index), loaded_.instances[i].name);
    take_mesh(index);
    return index = tree_.add_first_child(index, std::move(made));
  }

  /// The same outside of all parents, whose matrices do not allow for another place.
  Id root_carrier(size_t i) {
    Id& index = nodes_[i];
    EditedJson made = mesh_node(node(index), loaded_.instances[i].name);
    take_mesh(index);
    return index = tree_.add_root(std::move(made));
  }

  void place(size_t i) {
    const Instance &before = loaded_.instances[i], &after = edited_.instances[i];
    const dmat4 from(before.to_world), to(after.to_world);
    const dmat4 into_file = moved_by(loaded_.origin), into_scene = moved_by(-loaded_.origin);
    const Id index = carrier(i);
    const dmat4 by = into_file * to * glm::inverse(from) * into_scene;
    if (node(index).contains("skin")) {
      place_skinned(index, by, after);
      return;
    }
    const dmat4 was = tree_.world_of(index);
    const bool simple = mat4(into_scene * was) == before.to_world;
    set_world(i, simple ? into_file * to : by * was);
    const dmat3 difference = dmat3(was) - dmat3(from);
    if (extent_of(dmat4(difference)) > 1e-5 * extent_of(from))  // a flattened mesh is in its place
      remove_own(node(nodes_[i]), "to_world");
    else
      keep_digits(i);
  }

  void place_skinned(Id index, const dmat4& by, const Instance& after) {
    dmat4 before(1);
    if (const auto extras = node(index).find("extras"); extras != node(index).end() && extras->is_object())
      if (const auto own = extras->find("lucerna"); own != extras->end() && own->contains("skin_to_world")) {
        const auto numbers = own->at("skin_to_world").get<std::vector<double>>();
        for (size_t k = 0; k < 16 && k < numbers.size(); ++k)
          before[glm::length_t(k / 4)][glm::length_t(k % 4)] = numbers[k];
      }
    set_own(node(index), "skin_to_world", matrix_json(by * before));
    set_own(node(index), "to_world", matrix_json(dmat4(after.to_world)));
    notes_.push_back(fmt::format(
        "object '{}' is placed by joints: its new place is in extras.lucerna, which other programs ignore",
        after.name));
  }

  /// Gives the instance's node that matrix in the file's world.
  void set_world(size_t i, const dmat4& world) {
    Id index = nodes_[i];
    const dmat4 parent = tree_.world_of(tree_.parent(index));
    const bool root = parent == dmat4(1);
    if (!root && !has_inverse(parent)) index = root_carrier(i);
    const dmat4 local = root || tree_.parent(index) == k_none ? world : glm::inverse(parent) * world;
    if (is_rigid(local) || !has_inverse(local)) return tree_.set_local(index, local);
    // glTF's nodes have right angles: two of them, one below the other, have not.
    const dmat4 turn(right_angles(dmat3(local)));
    tree_.set_local(index, local * turn);
    EditedJson made = mesh_node(node(index), loaded_.instances[i].name);
    take_mesh(index);
    nodes_[i] = tree_.add_first_child(index, std::move(made));
    tree_.set_local(nodes_[i], glm::transpose(turn));
  }

  const Mesh& mesh_of(size_t i) const { return loaded_.meshes[loaded_.instances[i].mesh]; }

  /// Notes the instance's matrix if reading the nodes gives another rounding.
  void keep_digits(size_t i) {
    const mat4& to_world = edited_.instances[i].to_world;
    const Id index = nodes_[i];
    if (mat4(moved_by(-loaded_.origin) * tree_.world_of(index) * moved_by(mesh_of(i).shift)) == to_world)
      remove_own(node(index), "to_world");
    else
      set_own(node(index), "to_world", matrix_json(dmat4(to_world)));
  }

  /// Makes nodes of a node's EXT_mesh_gpu_instancing, all where they are in the edited scene.
  void split(Id from) {
    std::vector<size_t> all;
    for (size_t i = 0; i < loaded_.instances.size(); ++i)
      if (loaded_.instances[i].node == from) all.push_back(i);
    const std::string& name = loaded_.instances[all.front()].name;
    if (all.size() > k_most_copies)
      throw Error(
          "object '" + name + "'",
          fmt::format("it is one of {} in a node: to save its place, all must become nodes, at most {}",
                      all.size(), k_most_copies));
    for (const size_t i : all)
      if (mesh_of(i).is_baked)
        throw Error("object '" + loaded_.instances[i].name + "'",
                    "it is placed by joints or by a matrix without an inverse, with EXT_mesh_gpu_instancing: "
                    "the places of objects of its node cannot be saved");
    const EditedJson made = mesh_node(node(from), "");
    take_mesh(from);
    remove_extension(node(from), k_instancing);
    for (size_t k = all.size(); k-- > 0;) {
      const size_t i = all[k];
      EditedJson own = made;
      own["name"] = loaded_.instances[i].name;
      nodes_[i] = tree_.add_first_child(from, std::move(own));
      // The file's vertices are not those of the scene if these are far from their origin.
      set_world(
          i, moved_by(loaded_.origin) * dmat4(edited_.instances[i].to_world) * moved_by(-mesh_of(i).shift));
      keep_digits(i);
    }
    split_.insert(from);
  }

  void hide(size_t i) { tree_.mark_hidden(carrier(i), true); }

  /// Removes the marks that hide the instance; what they hide besides it gets marks of its own.
  void show(size_t i) {
    const std::vector<Id> chain = tree_.chain(nodes_[i]);
    for (const Id at : chain) {
      if (!tree_.is_marked_hidden(at)) continue;
      tree_.mark_hidden(at, false);
      if (const auto children = node(at).find("children"); children != node(at).end())
        for (const EditedJson& child : EditedJson(*children)) tree_.mark_hidden(child.get<Id>(), true);
      for (size_t other = 0; other < nodes_.size(); ++other)
        if (nodes_[other] == at && other != i && edited_.instances[other].hidden) hide(other);
      for (const Light& light : edited_.lights)
        if (light.id == at && !light.enabled) set_own(node(at), "enabled", false);
    }
  }

  EditedJson& root_;
  const Scene &loaded_, &edited_;
  std::vector<std::string>& notes_;
  NodeTree tree_;
  std::vector<Id> nodes_;  // of the meshes, by instance
  std::set<Id> split_;
};

}  // namespace

void write_objects(EditedJson& root, const Scene& loaded, const Scene& edited,
                   std::vector<std::string>& notes) {
  ObjectWriter(root, loaded, edited, notes).write();
}

}  // namespace lucerna::scene
