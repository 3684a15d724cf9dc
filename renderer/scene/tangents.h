#pragma once
// Tangent frames for normal maps, and flat normals: what glTF lets a mesh leave out.
#include "scene/scene.h"

namespace lucerna::scene {

/// Gives every triangle vertices of its own with the face's normal, as glTF asks when normals are missing.
/// The other streams follow; tangents are dropped (glTF: they must then be ignored). Triangles must not be
/// degenerate.
void make_flat_normals(Primitive& primitive);

/// Replaces `primitive.tangents` by frames in the manner of MikkTSpace (Mikkelsen 2008, the method glTF
/// names):
/// - corners with identical position, normal and texture coordinates are one, whatever other streams say;
/// - a triangle's tangent is its position gradient along u; each corner projects it on the plane of its own
/// normal,
///   normalizes it and weighs it by the triangle's angle there;
/// - triangles with mirrored texture coordinates do not mix with the others: w = +1 where (u, up) is
/// right-handed seen
///   from the front, -1 where mirrored; a vertex used by both kinds is split, so vertices may be appended;
/// - triangles without area in texture space contribute nothing; a vertex that has no other gets any frame.
/// Unlike MikkTSpace, triangles that share a corner but no edge are averaged too. The texture coordinates are
/// those by which `map` reads its texture, its transform applied; a missing stream is taken as all equal.
/// Needs normals.
void make_tangents(Primitive& primitive, const TextureUse& map);

}  // namespace lucerna::scene
