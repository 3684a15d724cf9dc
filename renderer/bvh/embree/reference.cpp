#include "bvh/embree/reference.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "bvh/embree/embree_device.h"
#include "bvh/embree/flush_denormals.h"
#include "bvh/embree/workers.h"

namespace lucerna::bvh {

struct EmbreeReference::Impl {
  EmbreeDevice device;
  EmbreeScene scene;
  mutable Workers workers;

  Impl(const Triangles& triangles, int threads)
      : device(new_embree_device(threads)), scene(rtcNewScene(device.get())), workers(threads) {
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    if (const size_t count = triangles.count(); count > 0) {
      RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* vertices = static_cast<vec3*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * count));
      auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), count));
      if (vertices && indices) {
        std::copy(triangles.vertices.begin(), triangles.vertices.end(), vertices);
        std::iota(indices, indices + 3 * count, 0u);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene.get(), geometry);
      }
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene.get());
    if (const std::string error = embree_error(device.get()); !error.empty())
      throw_error("embree", "building a tree of {} triangles: {}", triangles.count(), error);
  }
};

EmbreeReference::EmbreeReference(const Triangles& triangles, int threads)
    : impl_(std::make_unique<Impl>(triangles, threads)) {}
EmbreeReference::~EmbreeReference() = default;

void EmbreeReference::trace(Query query, std::span<const shared::Ray> rays,
                            std::span<shared::Hit> hits) const {
  if (query == Query::closest_non_opaque)
    throw_error("embree", "the reference does not distinguish non-opaque triangles");
  constexpr size_t k_chunk = 512;
  const auto chunks = static_cast<uint32_t>((rays.size() + k_chunk - 1) / k_chunk);
  impl_->workers.run(chunks, [&](uint32_t chunk) {
    const FlushDenormals flush;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const size_t end = std::min(rays.size(), (chunk + 1) * k_chunk);
    for (size_t i = chunk * k_chunk; i < end; ++i) {
      const vec3 &o = rays[i].origin, &d = rays[i].direction;
      RTCRayHit rh;
      rh.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, rays[i].tmax, ~0u, 0, 0};
      rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      hits[i] = {0, shared::k_no_hit, 0, 0};
      if (!(rays[i].tmax > 0)) continue;
      if (query == Query::any_opaque) {
        rtcOccluded1(impl_->scene.get(), &context, &rh.ray);
        if (rh.ray.tfar < 0) hits[i].prim = 0;
      } else {
        rtcIntersect1(impl_->scene.get(), &context, &rh);
        if (rh.hit.geomID != RTC_INVALID_GEOMETRY_ID)
          hits[i] = {rh.ray.tfar, rh.hit.primID, rh.hit.u, rh.hit.v};
      }
    }
  });
}

}  // namespace lucerna::bvh
