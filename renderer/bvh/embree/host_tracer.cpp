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

constexpr uint32_t k_chunk = 512;  // rays a work item, some 0.1 ms; a multiple of a bundle's
// Rays of a bundle: a tile of the camera's order. Primary rays of `atrium`, against single ones: 16 are 1.2
// times as fast, 32 1.4 times, 64 1.5 times.
constexpr uint32_t k_groups = 8, k_bundle = k_groups * k_lanes;
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

/// An entry of the traversal stack.
struct Entry {
  float near;
  uint32_t child;
};

/// The children that the ray meets before `limit`, as bits, and where it enters them.
LUCERNA_LANES_INLINE uint32_t meet_boxes(const WideNode& node, const WideRay& ray, float limit,
                                         Floats& near) {
  Floats enter = Floats{} + 0.0f, leave = Floats{} + limit;
#pragma GCC unroll 3
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
        if constexpr (Any) {
          // Whatever blocks is as good as any other, and an order costs more than it saves.
          at = node.child[first];
          for (; met != 0; met &= met - 1) stack[depth++].child = node.child[std::countr_zero(met)];
          continue;
        }
        // The nearest is walked next, the others in order.
        Entry nearest{near[first], node.child[first]};
        for (const uint32_t bottom = depth; met != 0; met &= met - 1) {
          const int k = std::countr_zero(met);
          Entry entry{near[k], node.child[k]};
          if (entry.near < nearest.near) std::swap(entry, nearest);
          uint32_t i = depth++;
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
    } while (!Any && stack[depth].near > limit);
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

/// Neighbours whose directions have the same signs. Nodes are met by the bundle as a whole, with intervals of
/// its origins and directions: by all rays together, whatever their number. Leaves are met by those rays that
/// meet the leaf's box. So each ray is tested against every leaf that it would be tested against alone.
struct Bundle {
  ShearedRay sheared[k_bundle];
  Floats origin[k_groups][3], near[k_groups][3], far[k_groups][3];  // as WideRay, a lane a ray
  Floats limit[k_groups];   ///< distances within which hits still count; below 0: no ray
  int entry[3] = {};        ///< as WideRay, of all
  bool alike = true;        ///< false: rays must be walked alone
  float first_origin[3];    ///< of the ray that comes first to a face, ...
  float last_origin[3];     ///< ... and last
  float least[3], most[3];  ///< least of `near` and most of `far`, in magnitude
  float reach = 0;          ///< largest limit

  LUCERNA_LANES_INLINE void fill(const Ray* rays, uint32_t count) {
    alike = true;
    for (uint32_t k = 0; k < k_bundle; ++k) {
      // Lanes without a ray repeat the first one.
      const Ray& from = rays[k < count ? k : 0];
      sheared[k] = ShearedRay(from);
      const WideRay ray(from, sheared[k]);
      const uint32_t group = k / k_lanes, lane = k % k_lanes;
      alike = alike && from.tmax > 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (k == 0) entry[axis] = ray.entry[axis];
        alike = alike && entry[axis] == ray.entry[axis];
        origin[group][axis][lane] = ray.origin[axis];
        near[group][axis][lane] = ray.near[axis], far[group][axis][lane] = ray.far[axis];
      }
      limit[group][lane] = k < count ? sheared[k].reach(sheared[k].limit) : -1.0f;
    }
    if (!alike) return;
    // A product below zero may lie on the wrong side of the rays' own ones. It does not matter: a face behind
    // an origin is entered at 0, and left before that by all.
    Ints finite = Ints{} == 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t g = 0; g < k_groups; ++g)
        finite &= (origin[g][axis] - origin[g][axis] == 0.0f) & (near[g][axis] - near[g][axis] == 0.0f);
      Floats low = origin[0][axis], high = low, least_near = near[0][axis], most_near = least_near,
             least_far = far[0][axis], most_far = least_far;
      for (uint32_t g = 1; g < k_groups; ++g) {
        keep_lesser(low, origin[g][axis]), keep_greater(high, origin[g][axis]);
        keep_lesser(least_near, near[g][axis]), keep_greater(most_near, near[g][axis]);
        keep_lesser(least_far, far[g][axis]), keep_greater(most_far, far[g][axis]);
      }
      const bool forward = (entry[axis] & 1) == 0;
      first_origin[axis] = forward ? greatest(high) : least_of(low);
      last_origin[axis] = forward ? least_of(low) : greatest(high);
      least[axis] = forward ? least_of(least_near) : greatest(most_near);
      most[axis] = forward ? greatest(most_far) : least_of(least_far);
    }
    alike = lanes(finite) == (1u << k_lanes) - 1;
    measure();
  }
  /// After limits have changed.
  LUCERNA_LANES_INLINE void measure() {
    Floats all = limit[0];
    for (uint32_t g = 1; g < k_groups; ++g) keep_greater(all, limit[g]);
    reach = greatest(all);
  }
  LUCERNA_LANES_INLINE static float greatest(const Floats& f) {
    float r = f[0];
    for (int i = 1; i < k_lanes; ++i) r = std::max(r, f[i]);
    return r;
  }
  LUCERNA_LANES_INLINE static float least_of(const Floats& f) {
    float r = f[0];
    for (int i = 1; i < k_lanes; ++i) r = std::min(r, f[i]);
    return r;
  }

  /// The children that some ray may meet, as bits, and distances before which none enters them.
  LUCERNA_LANES_INLINE uint32_t meet_boxes(const WideNode& node, Floats& nearest) const {
    Floats enter = Floats{} + 0.0f, leave = Floats{} + reach;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      keep_greater(enter, (node.face[entry[axis]] - first_origin[axis]) * least[axis]);
      keep_lesser(leave, (node.face[entry[axis] ^ 1] - last_origin[axis]) * most[axis]);
    }
    nearest = enter;
    return lanes(enter <= leave);
  }
  /// The rays of a group that meet a child's box, as bits.
  LUCERNA_LANES_INLINE uint32_t meet_box(const WideNode& node, uint32_t child, uint32_t g) const {
    Floats enter = Floats{} + 0.0f, leave = limit[g];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      keep_greater(enter, (node.face[entry[axis]][child] - origin[g][axis]) * near[g][axis]);
      keep_lesser(leave, (node.face[entry[axis] ^ 1][child] - origin[g][axis]) * far[g][axis]);
    }
    return lanes(enter <= leave);
  }
};

/// An entry of a bundle's traversal stack.
struct BundleEntry {
  float near;
  uint32_t node, child;  ///< a child of a node
};

LUCERNA_AVX2_TOO uint64_t closest_bundles(const WideTree& tree, const Rows& rows, uint32_t begin,
                                          uint32_t end) {
  std::vector<BundleEntry> stack(tree.stack);
  std::vector<Entry> single_stack(tree.stack);
  uint64_t tested = 0;
  const auto made = std::make_unique<Bundle>();
  Bundle& bundle = *made;
  for (uint32_t first = begin; first < end; first += k_bundle) {
    const uint32_t count = std::min(k_bundle, end - first);
    bundle.fill(&rows.rays[first], count);
    if (!bundle.alike) {
      for (uint32_t i = first; i < first + count; ++i)
        tested += walk<false>(tree, single_stack.data(), rows.rays[i], rows.hits[i]);
      continue;
    }
    for (uint32_t i = first; i < first + count; ++i) rows.hits[i] = k_miss;
    uint32_t depth = 0, at = 0;
    for (;;) {
      const WideNode& node = tree.nodes[at];
      Floats near;
      const uint32_t bottom = depth;
      for (uint32_t met = bundle.meet_boxes(node, near); met != 0; met &= met - 1) {
        const auto k = static_cast<uint32_t>(std::countr_zero(met));
        const BundleEntry entry{near[static_cast<int>(k)], at, k};
        uint32_t i = depth++;
        for (; i > bottom && stack[i - 1].near < entry.near; --i) stack[i] = stack[i - 1];
        stack[i] = entry;
      }
      bool inner = false;
      while (depth != 0) {
        const BundleEntry entry = stack[--depth];
        if (entry.near > bundle.reach) continue;
        const WideNode& parent = tree.nodes[entry.node];
        const uint32_t child = parent.child[entry.child];
        if ((child & k_wide_leaf) == 0) {
          at = child, inner = true;
          break;
        }
        const PackedTriangles& leaf = tree.leaves[child & ~k_wide_leaf];
        bool hit = false;
        for (uint32_t g = 0; g < k_groups; ++g)
          for (uint32_t met = bundle.meet_box(parent, entry.child, g); met != 0; met &= met - 1) {
            const auto lane = static_cast<uint32_t>(std::countr_zero(met)), k = g * k_lanes + lane;
            ++tested;
            if (!meet(leaf, bundle.sheared[k], rows.hits[first + k])) continue;
            bundle.limit[g][static_cast<int>(lane)] = bundle.sheared[k].reach(bundle.sheared[k].limit);
            hit = true;
          }
        if (hit) bundle.measure();
      }
      if (!inner) break;
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
    options.max_leaf = 1;  // make_wide_tree() chooses the leaves
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
  // Bundles only without a queue: what shares a bundle then does not depend on the order in which rays were
  // queued.
  const bool bundles = coherent && !queue;
  const uint32_t chunks = count / k_chunk + (count % k_chunk != 0);
  impl_->workers.run(chunks, [&](uint32_t chunk) {
    const FlushDenormals flush;
    const uint32_t begin = chunk * k_chunk, end = begin + std::min(count - begin, k_chunk);
    impl_->leaf_tests += query == Query::any_opaque ? any_single(*tree, rows, begin, end)
                         : bundles                  ? closest_bundles(*tree, rows, begin, end)
                                                    : closest_single(*tree, rows, begin, end);
  });
}

}  // namespace lucerna::bvh
