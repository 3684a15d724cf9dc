#pragma once
// Embree with its own triangles, one ray at a time. The yardstick of `lucerna bench rays`; not used for
// rendering.
#include <memory>
#include <span>

#include "bvh/bvh.h"

namespace lucerna::bvh {

/// Robust flag on, medium build quality, no filters. Unlike the other tracers it returns any of the hits at
/// equal distance, includes t = 0, and misses for some rays aimed exactly at vertices.
class EmbreeReference {
 public:
  /// `threads` trace, the caller included; 0: one a core. Throws Error: out of memory.
  explicit EmbreeReference(const Triangles& triangles, int threads = 0);
  ~EmbreeReference();

  /// Query::closest, or any_opaque with every triangle taken as opaque (hit.prim is 0 or k_no_hit).
  /// closest_non_opaque is not supported: throws Error.
  void trace(Query query, std::span<const shared::Ray> rays, std::span<shared::Hit> hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::bvh
