#include "bvh/embree/host_tracer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>
#include <vector>

#include "bvh/embree/build.h"
#include "bvh/embree/flush_denormals.h"
#include "bvh/embree/wide_tree.h"
#include "bvh/embree/workers.h"

// A second version for processors that have AVX2, chosen when the program starts: before the thread sanitizer
// can have its calls in the function that chooses.
#if defined(__SANITIZE_THREAD__)
#define LUCERNA_AVX2_TOO
#else
#define LUCERNA_AVX2_TOO [[gnu::target_clones("avx2", "default")]]
#endif

namespace lucerna::bvh {

using shared::Hit;
using shared::Ray;

namespace {

constexpr uint32_t k_chunk = 512;  // rays a work item, some 0.1 ms; a multiple of a packet's
constexpr uint32_t k_packet = k_lanes;
constexpr Hit k_miss{0, shared::k_no_hit, 0, 0};

/// Row i of a trace() call: the ray and hit that its queue names.
struct Rows {
  std::span<const Ray> rays;
  std::span<Hit> hits;
  const uint32_t* queue;
  uint32_t operator[](uint32_t i) const { return queue ? queue[i] : i; }
};

/// The nearest lane among those hit, at equal distance that with the lower id; -1 when the best so far
/// stands.
LUCERNA_LANES_INLINE int choose(const PackedTriangles& leaf, const ShearedRay& ray, uint32_t lanes,
                                const Floats& t) {
  int best = -1;
  float limit = ray.limit;
  uint32_t prim = ray.best_prim;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    if (!(t[k] < limit || (t[k] == limit && leaf.prim[k] < prim))) continue;
    best = k, limit = t[k], prim = leaf.prim[k];
  }
  return best;
}

/// Takes the leaf's nearest triangle where it is nearer than what the ray has met; whether it was.
LUCERNA_LANES_INLINE bool meet(const PackedTriangles& leaf, ShearedRay& ray, Hit& hit) {
  Floats t, u, v;
  const uint32_t lanes = intersect(leaf, ray, t, u, v);
  if (lanes == 0) return false;
  const int k = choose(leaf, ray, lanes, t);
  if (k < 0) return false;
  ray.limit = t[k], ray.best_prim = leaf.prim[k];
  hit = {t[k], leaf.prim[k], u[k], v[k]};
  return true;
}

/// What is left to be walked.
struct Entry {
  float near;
  uint32_t child;
};

/// The children that the ray meets before `limit`, as bits, and where it enters them.
LUCERNA_LANES_INLINE uint32_t meet_boxes(const WideNode& node, const WideRay& ray, float limit,
                                         Floats& near) {
  Floats enter = Floats{} + 0.0f, leave = Floats{} + limit;
  for (int axis = 0; axis < 3; ++axis) {
    const Floats &first = node.face[ray.entry[axis]], &second = node.face[ray.entry[axis] ^ 1];
    keep_greater(enter, (first - ray.origin[axis]) * ray.near[axis]);
    keep_lesser(leave, (second - ray.origin[axis]) * ray.far[axis]);
  }
  near = enter;
  return lanes(enter <= leave);
}

// Compiled twice, the better one chosen when the program starts. Neither may contract products and sums into
// one rounding (AVX2 without FMA): the device does not. They return the leaves tested, each for each ray.
template <bool Any>
LUCERNA_LANES_INLINE uint64_t walk(const WideTree& tree, Entry* stack, const Ray& from, Hit& hit) {
  hit = k_miss;
  if (!(from.tmax > 0)) return 0;
  uint64_t tested = 0;
  ShearedRay sheared(from);
  const WideRay ray(from, sheared);
  float limit = sheared.reach(sheared.limit);
  uint32_t depth = 0, at = 0;
  for (;;) {
    if ((at & k_wide_leaf) == 0) {
      const WideNode& node = tree.nodes[at];
      Floats near;
      uint32_t met = meet_boxes(node, ray, limit, near);
      if (met != 0) {
        const int first = std::countr_zero(met);
        met &= met - 1;
        if (met == 0) {
          at = node.child[first];
          continue;
        }
        // The nearest is walked next, the others in order; whatever blocks is as good as any other.
        Entry nearest{near[first], node.child[first]};
        for (const uint32_t bottom = depth; met != 0; met &= met - 1) {
          const int k = std::countr_zero(met);
          Entry entry{near[k], node.child[k]};
          if (entry.near < nearest.near) std::swap(entry, nearest);
          uint32_t i = depth++;
          if constexpr (!Any)
            for (; i > bottom && stack[i - 1].near < entry.near; --i) stack[i] = stack[i - 1];
          stack[i] = entry;
        }
        at = nearest.child;
        continue;
      }
    } else {
      ++tested;
      const PackedTriangles& leaf = tree.leaves[at & ~k_wide_leaf];
      if constexpr (Any) {
        Floats t, u, v;
        if (intersect(leaf, sheared, t, u, v) != 0) {
          hit.prim = 0;
          return tested;
        }
      } else if (meet(leaf, sheared, hit)) {
        limit = sheared.reach(sheared.limit);
      }
    }
    do {
      if (depth == 0) return tested;
      --depth;
    } while (stack[depth].near > limit);
    at = stack[depth].child;
  }
}

LUCERNA_AVX2_TOO uint64_t closest_single(const WideTree& tree, const Rows& rows, uint32_t begin,
                                         uint32_t end) {
  std::vector<Entry> stack(tree.stack);
  uint64_t tested = 0;
  for (uint32_t i = begin; i < end; ++i)
    tested += walk<false>(tree, stack.data(), rows.rays[rows[i]], rows.hits[rows[i]]);
  return tested;
}

LUCERNA_AVX2_TOO uint64_t any_single(const WideTree& tree, const Rows& rows, uint32_t begin, uint32_t end) {
  std::vector<Entry> stack(tree.stack);
  uint64_t tested = 0;
  for (uint32_t i = begin; i < end; ++i)
    tested += walk<true>(tree, stack.data(), rows.rays[rows[i]], rows.hits[rows[i]]);
  return tested;
}

struct alignas(4 * k_lanes) PacketEntry {
  Floats near;  ///< of each ray
  uint32_t child, rays;
};

/// Eight neighbours at a time, each lane a ray, whose directions have the same signs. Each node and leaf is
/// read once for all of them.
LUCERNA_AVX2_TOO uint64_t closest_packet(const WideTree& tree, const Rows& rows, uint32_t begin,
                                         uint32_t end) {
  std::vector<PacketEntry> packet_stack(tree.stack);
  std::vector<Entry> stack(tree.stack);
  uint64_t tested = 0;
  for (uint32_t first = begin; first < end; first += k_packet) {
    const uint32_t count = std::min(k_packet, end - first);
    ShearedRay sheared[k_packet];
    Floats origin[3], near_inverse[3], far_inverse[3], limit = Floats{} + 0.0f;
    int entry[3] = {};
    bool alike = true;
    uint32_t alive = 0;
    for (uint32_t k = 0; k < k_packet; ++k) {
      // Lanes without a ray repeat the first one, masked, so that nothing is computed from garbage.
      const Ray& from = rows.rays[k < count ? first + k : first];
      if (k < count) rows.hits[first + k] = k_miss;
      if (k < count && from.tmax > 0) alive |= 1u << k;
      sheared[k] = ShearedRay(from);
      const WideRay ray(from, sheared[k]);
      for (int axis = 0; axis < 3; ++axis) {
        if (k == 0) entry[axis] = ray.entry[axis];
        alike = alike && entry[axis] == ray.entry[axis];
        origin[axis][k] = ray.origin[axis];
        near_inverse[axis][k] = ray.near[axis], far_inverse[axis][k] = ray.far[axis];
      }
      limit[k] = sheared[k].reach(sheared[k].limit);
    }
    if (!alike) {
      for (uint32_t i = first; i < first + count; ++i)
        tested += walk<false>(tree, stack.data(), rows.rays[i], rows.hits[i]);
      continue;
    }
    uint32_t depth = 0, at = 0, rays = alive;
    for (;;) {
      if (rays == 0) {
        // Nothing of it is left.
      } else if ((at & k_wide_leaf) == 0) {
        const WideNode& node = tree.nodes[at];
        const uint32_t bottom = depth;
        for (uint32_t c = 0; c < node.children; ++c) {
          Floats enter = Floats{} + 0.0f, leave = limit;
          for (int axis = 0; axis < 3; ++axis) {
            keep_greater(enter, (node.face[entry[axis]][c] - origin[axis]) * near_inverse[axis]);
            keep_lesser(leave, (node.face[entry[axis] ^ 1][c] - origin[axis]) * far_inverse[axis]);
          }
          const uint32_t met = lanes(enter <= leave) & rays;
          if (met == 0) continue;
          // In the order of the first ray that both have.
          uint32_t i = depth++;
          for (; i > bottom; --i) {
            const uint32_t both = packet_stack[i - 1].rays & met;
            if (both == 0) break;
            const int k = std::countr_zero(both);
            if (!(packet_stack[i - 1].near[k] < enter[k])) break;
            packet_stack[i] = packet_stack[i - 1];
          }
          packet_stack[i] = {enter, node.child[c], met};
        }
      } else {
        const PackedTriangles& leaf = tree.leaves[at & ~k_wide_leaf];
        for (; rays != 0; rays &= rays - 1) {
          const int k = std::countr_zero(rays);
          ++tested;
          if (meet(leaf, sheared[k], rows.hits[first + static_cast<uint32_t>(k)]))
            limit[k] = sheared[k].reach(sheared[k].limit);
        }
      }
      if (depth == 0) break;
      --depth;
      at = packet_stack[depth].child;
      rays = packet_stack[depth].rays & lanes(packet_stack[depth].near <= limit);
    }
  }
  return tested;
}

}  // namespace

struct HostTracer::Impl {
  WideTree all, opaque, non_opaque;
  bool mixed = false;  ///< both kinds of triangles may be there: `opaque` and `non_opaque` are filled
  mutable Workers workers;
  mutable std::atomic<uint64_t> leaf_tests{0};

  Impl(const Triangles& triangles, int threads) : workers(threads) {
    BuildOptions options;
    options.threads = threads;
    options.max_leaf = k_lanes;
    options.intersection_cost = 0.15f;  // eight are tested at once: full leaves pay
    const Tree tree = build_tree(triangles, options);
    all = make_wide_tree(tree, triangles, [](uint32_t) { return true; });
    mixed = !std::all_of(triangles.non_opaque.begin(), triangles.non_opaque.end(),
                         [](uint8_t f) { return f == 0; });
    if (!mixed) return;
    opaque = make_wide_tree(tree, triangles, [&](uint32_t prim) { return triangles.opaque(prim); });
    non_opaque = make_wide_tree(tree, triangles, [&](uint32_t prim) { return !triangles.opaque(prim); });
  }
};

HostTracer::HostTracer(const Triangles& triangles, int threads)
    : impl_(std::make_unique<Impl>(triangles, threads)) {}
HostTracer::~HostTracer() = default;
HostTracer::HostTracer(HostTracer&&) noexcept = default;
HostTracer& HostTracer::operator=(HostTracer&&) noexcept = default;

int HostTracer::threads() const { return impl_->workers.threads(); }
uint64_t HostTracer::leaf_tests() const { return impl_->leaf_tests; }
uint64_t HostTracer::bytes() const {
  return impl_->all.bytes() + impl_->opaque.bytes() + impl_->non_opaque.bytes();
}

void HostTracer::trace(Query query, std::span<const Ray> rays, std::span<Hit> hits, const uint32_t* queue,
                       uint32_t count, bool coherent) const {
  const Rows rows{rays, hits, queue};
  const WideTree* tree = &impl_->all;
  if (query == Query::closest_non_opaque) tree = &impl_->non_opaque;
  if (query == Query::any_opaque && impl_->mixed) tree = &impl_->opaque;
  if (tree->nodes.empty()) {
    for (uint32_t i = 0; i < count; ++i) hits[rows[i]] = k_miss;
    return;
  }
  // Packets only without a queue: what shares a packet then does not depend on the order in which rays were
  // queued.
  const bool packets = coherent && !queue;
  const uint32_t chunks = count / k_chunk + (count % k_chunk != 0);
  impl_->workers.run(chunks, [&](uint32_t chunk) {
    const FlushDenormals flush;
    const uint32_t begin = chunk * k_chunk, end = begin + std::min(count - begin, k_chunk);
    impl_->leaf_tests += query == Query::any_opaque ? any_single(*tree, rows, begin, end)
                         : packets                  ? closest_packet(*tree, rows, begin, end)
                                                    : closest_single(*tree, rows, begin, end);
  });
}

}  // namespace lucerna::bvh
