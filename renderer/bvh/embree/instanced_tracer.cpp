#include "bvh/embree/instanced_tracer.h"

#include <cstring>

#include "base/error.h"
#include "bvh/embree/embree_device.h"

namespace lucerna::bvh {
namespace {

/// User data of an Embree query.
struct Context {
  RTCIntersectContext context;  // first: Embree hands back a pointer to it
  const InstancedTracer::Accepts* accepts;
};

void filter(const RTCFilterFunctionNArguments* a) {
  const auto& context = *reinterpret_cast<const Context*>(a->context);
  if (a->valid[0] == 0) return;
  const InstancedTracer::Hit hit{.distance = RTCRayN_tfar(a->ray, a->N, 0),
                                 .normal = vec3(0),
                                 .instance = RTCHitN_instID(a->hit, a->N, 0, 0),
                                 .part = RTCHitN_geomID(a->hit, a->N, 0),
                                 .triangle = RTCHitN_primID(a->hit, a->N, 0),
                                 .u = RTCHitN_u(a->hit, a->N, 0),
                                 .v = RTCHitN_v(a->hit, a->N, 0)};
  if (!(*context.accepts)(hit)) a->valid[0] = 0;
}

}  // namespace

struct InstancedTracer::Impl {
  /// Shared between tracers; the device is destroyed last.
  struct MeshTrees {
    EmbreeDevice device;
    std::vector<EmbreeScene> meshes;
  };
  std::shared_ptr<MeshTrees> trees = std::make_shared<MeshTrees>();
  EmbreeDevice& device = trees->device;
  std::vector<EmbreeScene>& meshes = trees->meshes;
  std::vector<mat4> to_world;  // of every instance
  EmbreeScene top;

  Impl() = default;
  explicit Impl(std::shared_ptr<MeshTrees> of) : trees(std::move(of)) {}

  void check(const char* what) const {
    if (const std::string error = embree_error(device.get()); !error.empty())
      throw_error("embree", "{}: {}", what, error);
  }
  void place(const std::vector<Instance>& instances);
  EmbreeScene scene() const {
    EmbreeScene s(rtcNewScene(device.get()));
    rtcSetSceneFlags(s.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT |
                                            RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcSetSceneBuildQuality(s.get(), RTC_BUILD_QUALITY_MEDIUM);
    return s;
  }
  template <class T>
  void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::span<const T> data) const {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), data.size());
    if (!buffer) check("no memory for the geometry");
    if (buffer && !data.empty()) std::memcpy(buffer, data.data(), data.size_bytes());
  }
};

InstancedTracer::InstancedTracer(const std::vector<Mesh>& meshes, const std::vector<Instance>& instances,
                                 int threads)
    : impl_(std::make_unique<Impl>()) {
  impl_->device = new_embree_device(threads);
  RTCDevice device = impl_->device.get();
  for (const Mesh& mesh : meshes) {
    EmbreeScene& scene = impl_->meshes.emplace_back(impl_->scene());
    for (uint32_t i = 0; i < mesh.size(); ++i) {
      if (mesh[i].triangles.empty()) continue;
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      impl_->fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh[i].positions);
      impl_->fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh[i].triangles);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene.get(), geometry, i);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene.get());
  }
  impl_->place(instances);
}

InstancedTracer::InstancedTracer(const InstancedTracer& meshes, const std::vector<Instance>& instances)
    : impl_(std::make_unique<Impl>(meshes.impl_->trees)) {
  impl_->place(instances);
}

void InstancedTracer::Impl::place(const std::vector<Instance>& instances) {
  top = scene();
  for (uint32_t i = 0; i < instances.size(); ++i) {
    to_world.push_back(instances[i].to_world);
    if (instances[i].mesh >= meshes.size()) continue;
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, meshes[instances[i].mesh].get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &instances[i].to_world[0][0]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top.get(), geometry, i);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(top.get());
  check("cannot build the tree of the scene's meshes");
}

InstancedTracer::~InstancedTracer() = default;
InstancedTracer::InstancedTracer(InstancedTracer&&) noexcept = default;
InstancedTracer& InstancedTracer::operator=(InstancedTracer&&) noexcept = default;

std::optional<InstancedTracer::Hit> InstancedTracer::nearest(const vec3& origin, const vec3& direction,
                                                             float limit, const Accepts& accepts) const {
  Context context{{}, &accepts};
  rtcInitIntersectContext(&context.context);
  if (accepts) context.context.filter = filter;
  RTCRayHit query{};
  query.ray = {.org_x = origin.x,
               .org_y = origin.y,
               .org_z = origin.z,
               .tnear = 0,
               .dir_x = direction.x,
               .dir_y = direction.y,
               .dir_z = direction.z,
               .time = 0,
               .tfar = limit,
               .mask = ~0u,
               .id = 0,
               .flags = 0};
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->top.get(), &context.context, &query);
  const RTCHit& h = query.hit;
  if (h.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  // Normals turn by the inverse transposed.
  const mat3 turn = glm::transpose(glm::inverse(mat3(impl_->to_world[h.instID[0]])));
  vec3 normal = turn * vec3(h.Ng_x, h.Ng_y, h.Ng_z);
  const float length = glm::length(normal);
  normal = length > 0 ? normal / length : -glm::normalize(direction);
  if (glm::dot(normal, direction) > 0) normal = -normal;
  return Hit{query.ray.tfar, normal, h.instID[0], h.geomID, h.primID, h.u, h.v};
}

}  // namespace lucerna::bvh
