#pragma once
// The nodes of a document that is being edited: parents, matrices, visibility.
#include <vector>

#include "scene/io/json_edit.h"
#include "scene/scene.h"

namespace lucerna::scene {

inline constexpr const char* k_visibility = "KHR_node_visibility";

/// Nodes that others add to the document must be roots.
class NodeTree {
 public:
  explicit NodeTree(EditedJson& root);

  EditedJson& node(Id index) { return root_["nodes"][index]; }
  const EditedJson& node(Id index) const { return root_.at("nodes")[index]; }
  /// k_none: a root.
  Id parent(Id index) const { return index < parents_.size() ? parents_[index] : k_none; }
  /// The node and what is above it, the root first.
  std::vector<Id> chain(Id index) const;
  /// The node's own matrix, as load_nodes() reads it.
  static glm::dmat4 local_matrix(const EditedJson& node);
  /// Of k_none: the identity.
  glm::dmat4 world_of(Id index) const;
  /// Gives the node this matrix in place of its former one.
  void set_local(Id index, const glm::dmat4& local);
  /// True if an animation's channel has it as target.
  bool is_animated(Id index) const;
  /// True if a skin has it as joint.
  bool is_joint(Id index) const;
  /// The node's own mark, whatever is above it.
  bool is_marked_hidden(Id index) const;
  /// True if nothing hides the node.
  bool is_visible(Id index) const;
  void mark_hidden(Id index, bool hidden);
  /// The index of the new node.
  Id add_first_child(Id parent, EditedJson node);
  Id add_root(EditedJson node);

 private:
  EditedJson& root_;
  std::vector<Id> parents_;
};

/// A number as written in nodes: the shortest text for what is a float, else all digits of the double.
EditedJson double_json(double value);

}  // namespace lucerna::scene
