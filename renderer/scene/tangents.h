#pragma once
// Tangent frames for normal maps, and flat normals, where a glTF mesh has none.
#include "scene/scene.h"

namespace lucerna::scene {

/// Gives each triangle separate vertices with the face's normal, as glTF requires if normals are missing. The
/// other streams follow; tangents are dropped (glTF: ignored in this case). Triangles must not be degenerate.
void make_flat_normals(Primitive& primitive);

/// Replaces `primitive.tangents` by frames in the manner of MikkTSpace (Mikkelsen 2008, the method that glTF
/// names):
/// - corners with identical position, normal and texture coordinates are one, whatever other streams contain;
/// - a triangle's tangent is its position gradient along u; each corner projects it on the plane of its
///   normal, normalizes it and weights it by the triangle's angle there;
/// - triangles with mirrored texture coordinates are averaged separately: w = +1 where (u, up) is
///   right-handed seen from the front, -1 where mirrored; a vertex used by both kinds is split, so vertices
///   may be appended;
/// - triangles without area in texture space contribute nothing; a vertex without other triangles gets any
///   frame.
/// Unlike MikkTSpace, triangles that share a corner but no edge are averaged too. Texture coordinates are
/// those by which `map` reads its texture, with its transform; a missing stream counts as all equal. Needs
/// normals.
void make_tangents(Primitive& primitive, const TextureUse& map);

}  // namespace lucerna::scene
