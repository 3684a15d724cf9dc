#include "scene/io/node_tree.h"

#include <algorithm>

#include "scene/io/node_matrix.h"

namespace lucerna::scene {
namespace {

using glm::dmat4;
using glm::dquat;
using glm::dvec3;

std::vector<double> number_list(const EditedJson& node, const char* key) {
  const auto found = node.find(key);
  return found != node.end() && found->is_array() ? found->get<std::vector<double>>() : std::vector<double>();
}

}  // namespace

EditedJson double_json(double value) {
  const auto single = static_cast<float>(value);
  return double{single} == value ? number_json(single) : EditedJson(value);
}

NodeTree::NodeTree(EditedJson& root) : root_(root) {
  if (!root_.contains("nodes")) return;
  parents_.assign(root_["nodes"].size(), k_none);
  for (uint32_t i = 0; i < parents_.size(); ++i)
    if (const auto children = node(i).find("children"); children != node(i).end())
      for (const EditedJson& child : *children) parents_[child.get<size_t>()] = i;
}

std::vector<Id> NodeTree::chain(Id index) const {
  std::vector<Id> all;
  for (Id at = index; at != k_none; at = parent(at)) all.push_back(at);
  std::reverse(all.begin(), all.end());
  return all;
}

dmat4 NodeTree::local_matrix(const EditedJson& node) {
  if (const std::vector<double> m = number_list(node, "matrix"); m.size() == 16) {
    dmat4 matrix;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) matrix[c][r] = m[size_t(4 * c + r)];
    return matrix;
  }
  dvec3 t(0), s(1);
  dquat r(1, 0, 0, 0);
  if (const auto v = number_list(node, "translation"); v.size() == 3) t = {v[0], v[1], v[2]};
  if (const auto v = number_list(node, "scale"); v.size() == 3) s = {v[0], v[1], v[2]};
  if (const auto v = number_list(node, "rotation"); v.size() == 4)
    r = glm::normalize(dquat(v[3], v[0], v[1], v[2]));
  return node_matrix(t, r, s);
}

dmat4 NodeTree::world_of(Id index) const {
  // In the order of load_nodes(), for the same rounding.
  dmat4 world(1);
  for (const Id at : chain(index)) world = world * local_matrix(node(at));
  return world;
}

void NodeTree::set_local(Id index, const dmat4& local) {
  EditedJson& n = node(index);
  for (const char* key : {"translation", "rotation", "scale", "matrix"}) n.erase(key);
  if (local == dmat4(1)) return;
  EditedJson m = EditedJson::array();
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m.push_back(r < 3 ? double_json(local[c][r]) : EditedJson(c == 3 ? 1 : 0));
  n["matrix"] = std::move(m);
}

bool NodeTree::is_animated(Id index) const {
  const auto animations = root_.find("animations");
  if (animations == root_.end() || !animations->is_array()) return false;
  for (const EditedJson& animation : *animations)
    if (const auto channels = animation.find("channels"); channels != animation.end())
      for (const EditedJson& channel : *channels)
        if (const auto target = channel.find("target"); target != channel.end())
          if (const auto at = target->find("node"); at != target->end() && at->get<size_t>() == index)
            return true;
  return false;
}

bool NodeTree::is_joint(Id index) const {
  const auto skins = root_.find("skins");
  if (skins == root_.end() || !skins->is_array()) return false;
  for (const EditedJson& skin : *skins)
    if (const auto joints = skin.find("joints"); joints != skin.end())
      for (const EditedJson& joint : *joints)
        if (joint.get<size_t>() == index) return true;
  return false;
}

bool NodeTree::is_marked_hidden(Id index) const {
  const auto extensions = node(index).find("extensions");
  if (extensions == node(index).end()) return false;
  const auto own = extensions->find(k_visibility);
  return own != extensions->end() && !own->value("visible", true);
}

bool NodeTree::is_visible(Id index) const {
  const std::vector<Id> all = chain(index);
  return std::none_of(all.begin(), all.end(), [&](Id at) { return is_marked_hidden(at); });
}

void NodeTree::mark_hidden(Id index, bool hidden) {
  if (hidden)
    extension_at(root_, node(index), k_visibility)["visible"] = false;
  else
    remove_extension(node(index), k_visibility);
}

Id NodeTree::add_first_child(Id parent, EditedJson made) {
  const auto child = static_cast<Id>(root_["nodes"].size());
  root_["nodes"].push_back(std::move(made));
  EditedJson& children = node(parent)["children"];
  if (!children.is_array()) children = EditedJson::array();
  children.insert(children.begin(), child);
  parents_.resize(root_["nodes"].size(), k_none);
  parents_[child] = parent;
  return child;
}

Id NodeTree::add_root(EditedJson made) {
  const auto index = static_cast<Id>(add_root_node(root_, std::move(made)));
  parents_.resize(root_["nodes"].size(), k_none);
  return index;
}

}  // namespace lucerna::scene
