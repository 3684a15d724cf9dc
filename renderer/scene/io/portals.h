#pragma once
// Sky portals of a glTF document: marked meshes become rectangles.
#include "scene/io/nodes.h"

namespace lucerna::scene {

/// Copies the triangles of the portal's mesh, whose positions are relative to `origin`.
void take_corners(const Document& document, const Mesh& mesh, const glm::dvec3& origin, MarkedPortal& portal);

/// Fills scene.portals, once the scene's geometry is in its final place. Each of these is a located warning:
/// - A mesh without area, or that is not flat, is left out.
/// - A flat mesh that is not a rectangle counts as the smallest rectangle around it along one of its edges.
/// - A portal with all of the scene's box behind it is left out.
/// - Of more than k_max_portals, the largest are used.
/// - Portals that overlap in one plane are all used.
void load_portals(Document& document, Scene& scene, const std::vector<MarkedPortal>& marked);

}  // namespace lucerna::scene
