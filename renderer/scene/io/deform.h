#pragma once
// Deformation of a mesh's vertices by its node: morph targets and skins (glTF 2.0, 3.7.2.2 and 3.7.3).
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/io/accessor.h"
#include "scene/io/document.h"

namespace lucerna::scene {

/// The shape in which a node shows its mesh.
struct Pose {
  std::vector<float> weights;      ///< by morph target; empty: the mesh as it is
  std::vector<glm::dmat4> joints;  ///< by joint, joint's global matrix * inverse bind matrix; empty: no skin
  /// Places vertices without joints: the node's matrix. Without a skin it is set if the matrix is singular,
  /// so that no instance can have it.
  std::optional<glm::dmat4> matrix;

  /// True if vertices are transformed to the world here; otherwise the instance's matrix does so.
  bool placed() const { return !joints.empty() || matrix; }
};

/// Deforms the vertices of one primitive.
class Deformer {
 public:
  /// `item` is the primitive, with `vertices` vertices. All arguments must outlive this. Throws a located
  /// Error if targets, joints or weights have a wrong type or number.
  Deformer(Document& document, const tinygltf::Primitive& source, const Item& item, const Pose& pose,
           size_t vertices);

  /// Adds the weighted morph targets of an attribute to `values`, those of the elements `used`, of `least` to
  /// `most` components each.
  template <class Vector>
  void add_targets(const char* attribute, const std::vector<uint32_t>& used, std::vector<Vector>& values,
                   int least, int most) const;
  bool placed() const { return pose_.placed(); }
  bool skinned() const { return !joints_.empty(); }
  /// The matrix that takes an element to the world.
  glm::dmat4 matrix(uint32_t element) const;

 private:
  void open_skin(size_t vertices);

  Document& document_;
  const tinygltf::Primitive& source_;
  Item item_;
  const Pose& pose_;
  size_t vertices_;
  std::vector<std::pair<float, Item>> targets_;  // those of weight other than 0
  std::vector<AccessorReader> joints_, weights_;
  mutable bool warned_ = false;
};

/// The matrix for normals of points transformed by `m`: its inverse transpose up to a positive factor, but
/// also defined for matrices of rank 2.
glm::dmat3 normal_matrix(const glm::dmat3& m);

template <class Vector>
void Deformer::add_targets(const char* attribute, const std::vector<uint32_t>& used,
                           std::vector<Vector>& values, int least, int most) const {
  for (const auto& [weight, target] : targets_) {
    const auto found = target.find(attribute);
    if (!found) continue;
    AccessorReader reader(document_, found->index(document_.model.accessors.size(), "accessors"));
    if (reader.components() < least || reader.components() > most)
      found->fail("{} components, expected {}{}", reader.components(), least,
                  most > least ? fmt::format(" to {}", most) : "");
    if (reader.count() != vertices_)
      found->fail("{} elements, but POSITION has {}", reader.count(), vertices_);
    if (std::string_view(attribute).starts_with("COLOR")) reader.force_normalized();
    for (size_t i = 0; i < used.size(); ++i) {
      float delta[4] = {};
      reader.read(used[i], delta, reader.components());
      for (int k = 0; k < reader.components(); ++k) values[i][k] += weight * delta[k];
    }
  }
}

}  // namespace lucerna::scene
