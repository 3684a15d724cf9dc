#pragma once
// The builder: surface-area heuristic (binned, with optional spatial splits) through Embree's rtcBuildBVH.
#include <functional>

#include "bvh/layout.h"

namespace lucerna::bvh {

/// Most triangles that a leaf of a tree that is not for the device may hold.
inline constexpr uint32_t k_largest_leaf = 8;

struct BuildOptions {
  /// Cut long triangles where it pays, so that one may lie in several leaves. Changes no hit but, by
  /// rounding, those of slivers whose distance lies outside of the part that the ray meets. Building takes
  /// four times as long; scenes of many small triangles gain nothing, which is why it is off.
  bool spatial_splits = false;
  /// References that spatial splits may add, as a share of the triangles.
  float split_budget = 0.3f;
  /// Cost of a triangle test over that of a node visit, for the heuristic. On lavapipe 0.5 to 4 trace alike,
  /// with 1 a little ahead.
  float intersection_cost = 1.0f;
  uint32_t max_leaf =
      k_max_leaf;   ///< triangles in a leaf, at most k_largest_leaf; flatten() cuts larger leaves up
  int threads = 0;  ///< 0: all cores
  /// Called from the building threads, one at a time, with the share done (0..1). Returning false cancels the
  /// build.
  std::function<bool(float)> progress;
};

/// The tree of `triangles`, laid out, no deeper than k_max_depth for any input. Same triangles and options
/// give a tree that answers every query alike (hits do not depend on the tree at all). Throws Error: a vertex
/// that is not finite (its triangle named), too many triangles, out of memory, cancelled.
BvhData build(const Triangles& triangles, const BuildOptions& options = {});

/// Likewise, before layout and before its depth is limited; for tests and measurements.
Tree build_tree(const Triangles& triangles, const BuildOptions& options = {});

}  // namespace lucerna::bvh
