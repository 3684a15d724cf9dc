#pragma once
// The node hierarchy of a glTF document.
#include <optional>

#include "scene/io/deform.h"
#include "scene/io/document.h"

namespace lucerna::scene {

/// A glTF mesh in one pose. Nodes with equal mesh and pose share it.
struct MeshUse {
  uint32_t mesh = 0;  ///< glTF index
  Pose pose;
};

/// A mesh marked as a portal, in one place.
struct MarkedPortal {
  std::string name;   ///< of the node
  std::string where;  ///< the node, for messages
  Id use = k_none;    ///< into Placement::uses
  glm::dmat4 to_world{1};
  bool flipped = false;  ///< Instance::flipped
  std::vector<glm::dvec3>
      corners{};  ///< three per triangle, in the file's coordinates; once meshes are loaded
};

/// Positions in the file's coordinates and in double precision, in the order of the scene's lists.
struct Placement {
  std::vector<MeshUse> uses;  ///< Instance::mesh indexes these until meshes are loaded
  std::vector<glm::dmat4> instances, cameras;
  std::vector<glm::dvec3> lights;
  std::vector<MarkedPortal> portals;  ///< they are not among the scene's instances
};

/// Walks the default scene (scenes[scene], else the first, else all roots) and fills instances, cameras and
/// lights except their positions. Instance::to_world is what extras.lucerna.to_world says (own_extras.h), or
/// 0.
/// - KHR_node_visibility hides instances, switches lights off and removes portals, also of nodes below.
/// - The matrix of a skinned mesh's node is ignored (glTF 2.0, 3.7.3.3).
/// - A matrix that is singular in single precision but of rank 2 flattens meshes, which then have a separate
///   pose; cameras and lights keep the orientation of their other axes. Objects with a matrix of rank 1 or 0
///   (scale 0 hides them: glTF 2.0, 3.5.3) are skipped with a warning.
/// - A mesh is a portal if extras.portal of its node, or else of the mesh, is true.
/// - A camera with unusable values is skipped with a warning.
/// Throws a located Error if a matrix above a mesh, camera or light is not finite.
Placement load_nodes(Document& document, Scene& scene);

/// The scene object that load_nodes walks, if there is one.
std::optional<Item> default_scene(const Document& document);

}  // namespace lucerna::scene
