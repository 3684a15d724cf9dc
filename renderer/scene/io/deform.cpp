#include "scene/io/deform.h"

#include <algorithm>
#include <cmath>

namespace lucerna::scene {

Deformer::Deformer(Document& document, const tinygltf::Primitive& source, const Item& item, const Pose& pose,
                   size_t vertices)
    : document_(document), source_(source), item_(item), pose_(pose), vertices_(vertices) {
  if (const auto targets = pose.weights.empty() ? std::nullopt : item.find("targets"))
    for (size_t i = 0; i < std::min(targets->size(), pose.weights.size()); ++i)
      if (pose.weights[i] != 0) targets_.emplace_back(pose.weights[i], targets->at(i).object());
  if (!pose.joints.empty()) open_skin(vertices);
}

void Deformer::open_skin(size_t vertices) {
  const Item attributes = item_.at("attributes");
  for (int set = 0;; ++set) {
    const std::string keys[2] = {fmt::format("JOINTS_{}", set), fmt::format("WEIGHTS_{}", set)};
    std::optional<Item> items[2];
    for (int k = 0; k < 2; ++k) items[k] = attributes.find(keys[k].c_str());
    if (!items[0] || !items[1]) break;
    for (int k = 0; k < 2; ++k) {
      AccessorReader reader(document_, items[k]->index(document_.model.accessors.size(), "accessors"));
      if (reader.components() != 4) items[k]->fail("{} components, expected 4", reader.components());
      if (reader.count() != vertices)
        items[k]->fail("{} elements, but POSITION has {}", reader.count(), vertices);
      const int type = reader.component_type();
      const bool small =
          type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
      if (!small && (k == 0 || type != TINYGLTF_COMPONENT_TYPE_FLOAT))
        items[k]->fail("expected {}unsigned bytes or shorts", k == 0 ? "" : "floats, ");
      if (k == 1) reader.force_normalized();
      (k == 0 ? joints_ : weights_).push_back(reader);
    }
  }
  if (joints_.empty())
    document_.warnings.add("{} primitives of a skinned mesh have no joints or weights: placed by their node",
                           item_.path());
}

glm::dmat4 Deformer::matrix(uint32_t element) const {
  if (joints_.empty()) return pose_.matrix.value_or(glm::dmat4(1));
  glm::dmat4 sum(0);
  double total = 0;
  for (size_t set = 0; set < joints_.size(); ++set) {
    float joints[4], weights[4];
    joints_[set].read(element, joints, 4);
    weights_[set].read(element, weights, 4);
    for (int k = 0; k < 4; ++k) {
      if (weights[k] == 0) continue;
      const auto joint = static_cast<size_t>(joints[k]);
      if (joint >= pose_.joints.size())
        item_.at("attributes")
            .fail("JOINTS_{} of vertex {} is {}, but the skin has {} joints", set, element, joint,
                  pose_.joints.size());
      sum += pose_.joints[joint] * static_cast<double>(weights[k]);
      total += static_cast<double>(weights[k]);
    }
  }
  if (total > 0 && std::isfinite(total)) return sum / total;
  // glTF requires weights that sum to 1.
  if (!warned_)
    document_.warnings.add("{} primitives have vertices without joint weights: they follow the skin's first",
                           item_.path());
  warned_ = true;
  return pose_.joints.front();
}

glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

}  // namespace lucerna::scene
