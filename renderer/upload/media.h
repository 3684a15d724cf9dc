#pragma once
// The media of a scene, and the media that enclose the origin of a path (shaders/lib/media.glsl).
//
// A medium is an absorption: materials with transmission, thickness and equal absorption are one medium.
// A path keeps a stack of the media that it has entered; the last one entered and not yet left absorbs, and
// glTF has no priorities. At the origin of a path (camera, lamp, emissive surface) the
// stack is found from closed shells: triangles of one solid material, connected by vertices of equal
// position, in which each edge is used as often in either direction. Open surfaces enclose nothing.
#include <memory>
#include <vector>

#include "upload/flatten.h"

namespace lucerna::upload {

/// Closed shells of solids, as a binary tree in depth-first order whose nodes store where traversal continues
/// if they are missed (texels: shaders/shared/scene.h, scene_media).
struct SolidShells {
  std::vector<bool> solid;          ///< by material: the shells are made of these
  std::vector<Box> boxes;           ///< one a shell
  std::vector<vec4> nodes;          ///< 2 a node; leaves count triangles from 0
  std::vector<vec4> triangles;      ///< 3 a triangle, counter-clockwise from outside
  std::vector<uint32_t> materials;  ///< one a triangle
};
std::shared_ptr<const SolidShells> make_solid_shells(const FlatScene& flat, std::vector<bool> solid);

/// Sets FlatMaterials::media, ::shells, Effects::media and each material's medium, for the materials of
/// `flat`. Does nothing if no solid absorbs.
void flatten_media(FlatScene& flat);

/// True if any solid's box intersects `box`, so that a path starting in it may start inside a medium.
bool meets_solids(const FlatMaterials& flat, const Box& box);

}  // namespace lucerna::upload
