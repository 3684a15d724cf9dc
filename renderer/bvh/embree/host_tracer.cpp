#include "bvh/embree/host_tracer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <type_traits>

#include "base/error.h"
#include "base/huge_pages.h"
#include "bvh/embree/build.h"
#include "bvh/embree/embree_device.h"
#include "bvh/embree/flush_denormals.h"
#include "bvh/embree/packed_triangles.h"
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

constexpr uint32_t k_chunk = 512;  // rays a work item, some 0.1 ms; a multiple of every packet width
constexpr uint32_t k_widest = 16;
constexpr Hit k_miss{0, shared::k_no_hit, 0, 0};

/// What Embree carries through a query for us. Ray i of a packet has id i.
struct Context {
  RTCIntersectContext context;  // first: Embree hands back a pointer to it
  ShearedRay ray[k_widest];
};

/// Leaves of the tree, as one user geometry of Embree's.
struct Leaves {
  std::vector<PackedTriangles> triangles;
  std::vector<Box> boxes;
};

void bounds(const RTCBoundsFunctionArguments* a) {
  const Box& box = static_cast<const Leaves*>(a->geometryUserPtr)->boxes[a->primID];
  *a->bounds_o = {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, 0};
}

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

// Compiled twice, the better one chosen when the program starts. Neither may contract products and sums into
// one rounding (AVX2 without FMA): the device does not.
LUCERNA_AVX2_TOO void closest_leaf(const RTCIntersectFunctionNArguments* a) {
  const PackedTriangles& leaf = static_cast<const Leaves*>(a->geometryUserPtr)->triangles[a->primID];
  auto& context = *reinterpret_cast<Context*>(a->context);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    ShearedRay& ray = context.ray[RTCRayN_id(rays, a->N, i)];
    Floats t, u, v;
    const uint32_t lanes = intersect(leaf, ray, t, u, v);
    if (lanes == 0) continue;
    const int k = choose(leaf, ray, lanes, t);
    if (k < 0) continue;
    ray.limit = t[k], ray.best_prim = leaf.prim[k];
    RTCRayN_tfar(rays, a->N, i) = t[k];
    RTCHitN_u(hits, a->N, i) = u[k], RTCHitN_v(hits, a->N, i) = v[k];
    RTCHitN_primID(hits, a->N, i) = leaf.prim[k], RTCHitN_geomID(hits, a->N, i) = a->geomID;
  }
}

LUCERNA_AVX2_TOO void any_leaf(const RTCOccludedFunctionNArguments* a) {
  const PackedTriangles& leaf = static_cast<const Leaves*>(a->geometryUserPtr)->triangles[a->primID];
  auto& context = *reinterpret_cast<Context*>(a->context);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    Floats t, u, v;
    if (intersect(leaf, context.ray[RTCRayN_id(a->ray, a->N, i)], t, u, v) != 0)
      RTCRayN_tfar(a->ray, a->N, i) = -k_infinity;
  }
}

}  // namespace

struct HostTracer::Impl {
  std::atomic<int64_t> bytes{0};
  EmbreeDevice device;
  /// A tree over some of the triangles; null for none.
  struct Part {
    Leaves leaves;
    EmbreeScene scene;
    explicit operator bool() const { return scene != nullptr; }
  };
  Part all, opaque, non_opaque;
  bool mixed = false;         ///< both kinds of triangles may be there: `opaque` and `non_opaque` are filled
  uint32_t packet_width = 1;  ///< the widest that this processor has instructions for
  mutable Workers workers;

  Impl(const Triangles& triangles, int threads) : device(new_embree_device(threads)), workers(threads) {
    rtcSetDeviceMemoryMonitorFunction(
        device.get(),
        [](void* user, ssize_t bytes, bool) {
          *static_cast<std::atomic<int64_t>*>(user) += bytes;
          return true;
        },
        &bytes);
    if (rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
      packet_width = 16;
    else if (rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
      packet_width = 8;
    BuildOptions options;
    options.threads = threads;
    options.max_leaf = k_lanes;
    options.intersection_cost = 0.15f;  // eight are tested at once: full leaves pay
    const Tree tree = build_tree(triangles, options);
    fill(all, tree, triangles, [](uint32_t) { return true; });
    const auto is_opaque = [&](uint32_t prim) { return triangles.opaque(prim); };
    const auto is_not = [&](uint32_t prim) { return !triangles.opaque(prim); };
    mixed = !std::all_of(triangles.non_opaque.begin(), triangles.non_opaque.end(),
                         [](uint8_t f) { return f == 0; });
    if (mixed) fill(opaque, tree, triangles, is_opaque), fill(non_opaque, tree, triangles, is_not);
  }

  template <class Wanted>
  void fill(Part& part, const Tree& tree, const Triangles& triangles, const Wanted& wanted) {
    // Embree's boxes must hold every ray that the test may accept: the shear's rounding moves it by a few
    // units in the last place of the distances involved.
    float reach = 0;
    for (const Tree::Node& node : tree.nodes)
      for (int axis = 0; axis < 3; ++axis)
        reach = std::max({reach, std::abs(node.box.lo[axis]), std::abs(node.box.hi[axis])});
    const vec3 margin(1e-6f * reach);
    const auto most = static_cast<size_t>(std::count_if(tree.nodes.begin(), tree.nodes.end(),
                                                        [](const Tree::Node& node) { return node.leaf(); }));
    part.leaves.triangles.reserve(most), part.leaves.boxes.reserve(most);
    advise_huge_pages(part.leaves.triangles.data(), most * sizeof(PackedTriangles));
    for (const Tree::Node& node : tree.nodes) {
      if (!node.leaf()) continue;
      uint32_t prims[k_lanes], count = 0;
      Box box;
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Reference& r = tree.references[i];
        if (wanted(r.prim)) prims[count++] = r.prim, box.grow(r.box);
      }
      if (count == 0) continue;
      PackedTriangles packed;
      for (uint32_t k = 0; k < k_lanes; ++k) {
        packed.prim[k] = prims[k < count ? k : 0];
        for (int corner = 0; corner < 3; ++corner)
          for (int axis = 0; axis < 3; ++axis)
            packed.vertex[corner][axis][k] = triangles.vertices[3 * size_t{packed.prim[k]} + corner][axis];
      }
      part.leaves.triangles.push_back(packed);
      part.leaves.boxes.push_back({box.lo - margin, box.hi + margin});
    }
    if (part.leaves.triangles.empty()) return;
    part.scene.reset(rtcNewScene(device.get()));
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(part.leaves.triangles.size()));
    rtcSetGeometryUserData(geometry, &part.leaves);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, closest_leaf);
    rtcSetGeometryOccludedFunction(geometry, any_leaf);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(part.scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(part.scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(part.scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(part.scene.get());
    if (const std::string error = embree_error(device.get()); !error.empty())
      throw_error("host tracer", "building a tree of {} leaves: {}", part.leaves.triangles.size(), error);
  }
};

namespace {

/// Row i of a trace() call: the ray and hit that its queue names.
struct Rows {
  std::span<const Ray> rays;
  std::span<Hit> hits;
  const uint32_t* queue;
  uint32_t operator[](uint32_t i) const { return queue ? queue[i] : i; }
};

RTCRay single(const Ray& ray, float tfar) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          tfar,
          ~0u,
          0,
          0};
}

void closest_one(RTCScene scene, const Rows& rows, uint32_t begin, uint32_t end) {
  Context context;
  rtcInitIntersectContext(&context.context);
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t j = rows[i];
    const Ray& ray = rows.rays[j];
    Hit& hit = rows.hits[j];
    hit = k_miss;
    if (!(ray.tmax > 0)) continue;
    context.ray[0] = ShearedRay(ray);
    RTCRayHit rh;
    rh.ray = single(ray, context.ray[0].limit);
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context.context, &rh);
    if (rh.hit.geomID != RTC_INVALID_GEOMETRY_ID) hit = {rh.ray.tfar, rh.hit.primID, rh.hit.u, rh.hit.v};
  }
}

void any_one(RTCScene scene, const Rows& rows, uint32_t begin, uint32_t end) {
  Context context;
  rtcInitIntersectContext(&context.context);
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t j = rows[i];
    const Ray& ray = rows.rays[j];
    Hit& hit = rows.hits[j];
    hit = k_miss;
    if (!(ray.tmax > 0)) continue;
    context.ray[0] = ShearedRay(ray);
    RTCRay r = single(ray, context.ray[0].limit);
    rtcOccluded1(scene, &context.context, &r);
    if (r.tfar < 0) hit.prim = 0;
  }
}

/// N neighbours at a time. Coherent rays gain a factor 1.8 over single rays, incoherent ones lose 10 %.
template <uint32_t N>
void closest_packet(RTCScene scene, const Rows& rows, uint32_t begin, uint32_t end) {
  Context context;
  rtcInitIntersectContext(&context.context);
  context.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (uint32_t i = begin; i < end; i += N) {
    std::conditional_t<N == 8, RTCRayHit8, RTCRayHit16> rh;
    alignas(64) int valid[N];
    const uint32_t lanes = std::min(N, end - i);
    for (uint32_t k = 0; k < N; ++k) {
      // Lanes without a ray repeat the first one, masked, so that nothing is computed from garbage.
      const Ray& ray = rows.rays[k < lanes ? i + k : i];
      valid[k] = k < lanes && ray.tmax > 0 ? -1 : 0;
      context.ray[k] = ShearedRay(ray);
      rh.ray.org_x[k] = ray.origin.x, rh.ray.org_y[k] = ray.origin.y, rh.ray.org_z[k] = ray.origin.z;
      rh.ray.dir_x[k] = ray.direction.x, rh.ray.dir_y[k] = ray.direction.y, rh.ray.dir_z[k] = ray.direction.z;
      rh.ray.tnear[k] = 0, rh.ray.tfar[k] = context.ray[k].limit, rh.ray.time[k] = 0, rh.ray.mask[k] = ~0u;
      rh.ray.id[k] = k, rh.ray.flags[k] = 0;
      rh.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    if constexpr (N == 8)
      rtcIntersect8(valid, scene, &context.context, &rh);
    else
      rtcIntersect16(valid, scene, &context.context, &rh);
    for (uint32_t k = 0; k < lanes; ++k) {
      const bool found = valid[k] != 0 && rh.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      rows.hits[i + k] = found ? Hit{rh.ray.tfar[k], rh.hit.primID[k], rh.hit.u[k], rh.hit.v[k]} : k_miss;
    }
  }
}

}  // namespace

HostTracer::HostTracer(const Triangles& triangles, int threads)
    : impl_(std::make_unique<Impl>(triangles, threads)) {}
HostTracer::~HostTracer() = default;
HostTracer::HostTracer(HostTracer&&) noexcept = default;
HostTracer& HostTracer::operator=(HostTracer&&) noexcept = default;

int HostTracer::threads() const { return impl_->workers.threads(); }
uint64_t HostTracer::bytes() const {
  uint64_t sum = static_cast<uint64_t>(std::max<int64_t>(0, impl_->bytes));
  for (const Impl::Part* part : {&impl_->all, &impl_->opaque, &impl_->non_opaque})
    sum += part->leaves.triangles.capacity() * sizeof(PackedTriangles) +
           part->leaves.boxes.capacity() * sizeof(Box);
  return sum;
}

void HostTracer::trace(Query query, std::span<const Ray> rays, std::span<Hit> hits, const uint32_t* queue,
                       uint32_t count, bool coherent) const {
  const Rows rows{rays, hits, queue};
  const Impl::Part* part = &impl_->all;
  if (query == Query::closest_non_opaque) part = &impl_->non_opaque;
  if (query == Query::any_opaque && impl_->mixed) part = &impl_->opaque;
  if (!*part) {
    for (uint32_t i = 0; i < count; ++i) hits[rows[i]] = k_miss;
    return;
  }
  RTCScene scene = part->scene.get();
  // Packets only without a queue: what shares a packet then does not depend on the order in which rays were
  // queued.
  const uint32_t width = coherent && !queue ? impl_->packet_width : 1;
  const uint32_t chunks = count / k_chunk + (count % k_chunk != 0);
  impl_->workers.run(chunks, [&](uint32_t chunk) {
    const FlushDenormals flush;
    const uint32_t begin = chunk * k_chunk, end = begin + std::min(count - begin, k_chunk);
    if (query == Query::any_opaque)
      any_one(scene, rows, begin, end);
    else if (width == 16)
      closest_packet<16>(scene, rows, begin, end);
    else if (width == 8)
      closest_packet<8>(scene, rows, begin, end);
    else
      closest_one(scene, rows, begin, end);
  });
}

}  // namespace lucerna::bvh
