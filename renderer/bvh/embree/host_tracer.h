#pragma once
// The `host` tracer: the processor on the mapped queues, for devices that are the CPU itself.
#include <memory>
#include <span>

#include "bvh/bvh.h"

namespace lucerna::bvh {

/// Answers the same queries as shaders/trace.comp, on the same rays and hits. Embree builds the tree; the
/// walk is our own (wide_tree.h), because Embree's own over user geometry is not conservative and its
/// triangles' test lets 1 in 150 of the rays aimed exactly at a vertex through a closed mesh. Whatever is
/// rounded on the way is rounded in proportion to a box, a triangle or its distance from the ray, so that a
/// thing far away changes neither speed nor hits elsewhere.
///
/// The test is the shader's, operation by operation, so the two tracers agree bit for bit on devices that
/// divide with correct rounding (lavapipe does). On others they may differ
///  - in the last digits of t, u, v;
///  - where two triangles lie within rounding of the same distance along the ray (at a shared edge; coplanar
///  ones that
///    are not the same triangle with the same order of vertices): each tracer takes the nearer by its own t.
/// Where the distances computed are equal, both take the lower primitive id.
class HostTracer {
 public:
  /// Builds the trees and copies what it needs of `triangles`. `threads`: tracing threads, including the
  /// caller of trace(); 0: one per core. Throws Error: memory.
  explicit HostTracer(const Triangles& triangles, int threads = 0);
  ~HostTracer();
  HostTracer(HostTracer&&) noexcept;
  HostTracer& operator=(HostTracer&&) noexcept;

  /// For i in [0, count): traces rays[j] into hits[j], where j = queue ? queue[i] : i. Other hits are left
  /// alone. Dead rays (tmax <= 0 or NaN) get no hit. `coherent` says that neighbours in the array start
  /// alike, as camera rays do; it is a hint for speed, used only without a queue, so that a ray's hit never
  /// depends on the order in which other rays were queued. Results do not depend on the number of threads.
  /// Blocks until done; callers on several threads take turns.
  void trace(Query query, std::span<const shared::Ray> rays, std::span<shared::Hit> hits,
             const uint32_t* queue, uint32_t count, bool coherent) const;

  int threads() const;
  /// Bytes of the trees and copies of the geometry.
  uint64_t bytes() const;
  /// Tests of a ray against a leaf so far: what tracing costs, whatever the machine. For tests and benches.
  uint64_t leaf_tests() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::bvh
