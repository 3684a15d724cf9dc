// links: gpu bvh_embree
// The compute-bvh tracer through its real kernels, compared with the oracle and the host tracer; and leaks.
#include <catch2/catch.hpp>

#include "bvh/embree/build.h"
#include "bvh/embree/host_tracer.h"
#include "gpu/stream.h"
#include "shaders/shared/trace.h"
#include "unit/bvh_support.h"

namespace trace_bvh_tests {

using namespace lucerna;
using namespace lucerna::bvh;
using namespace lucerna::bvh::test;

namespace {

constexpr Query k_queries[] = {Query::closest, Query::any_opaque, Query::closest_non_opaque};

gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

gpu::Kernel kernel(Query query, bool non_opaque, gpu::Defines defines = {}) {
  static gpu::ShaderCompiler compiler;
  constexpr const char* k_numbers[] = {"0", "1", "2"};
  defines["LUCERNA_QUERY"] = k_numbers[static_cast<int>(query)];
  if (non_opaque) defines["LUCERNA_NON_OPAQUE"] = "1";
  return {device(), compiler, "trace.comp", defines};
}

class ComputeTracer {
 public:
  explicit ComputeTracer(const Mesh& mesh, const BuildOptions& options = {})
      : ComputeTracer(build(mesh.view(), options)) {}
  explicit ComputeTracer(BvhData data) : data_(std::move(data)) {
    nodes_ = gpu::Buffer(device(), {"nodes", data_.nodes.size() * sizeof(uvec4), gpu::Memory::device, true});
    triangles_ = gpu::Buffer(device(),
                             {"triangles", data_.triangles.size() * sizeof(vec4), gpu::Memory::device, true});
    nodes_.write(std::span<const uvec4>(data_.nodes));
    triangles_.write(std::span<const vec4>(data_.triangles));
  }

  void trace(const gpu::Kernel& kernel, const std::vector<Ray>& rays, std::vector<Hit>& hits,
             const std::vector<uint32_t>* queue = nullptr) {
    gpu::Buffer ray_buffer(device(), {"rays", rays.size() * sizeof(Ray), gpu::Memory::device, true}),
        hit_buffer(device(), {"hits", hits.size() * sizeof(Hit)});
    gpu::Buffer queue_buffer(device(), {"queue", queue ? queue->size() * sizeof(uint32_t) : 0});
    ray_buffer.write(std::span<const Ray>(rays)), hit_buffer.write(std::span<const Hit>(hits));
    if (queue) queue_buffer.write(std::span<const uint32_t>(*queue));
    gpu::Resources resources;
    resources.set("ray_texels", ray_buffer), resources.set("Hits", hit_buffer),
        resources.set("Queue", queue_buffer);
    resources.set("bvh_nodes", nodes_), resources.set("bvh_triangles", triangles_);
    const shared::TracePush push{static_cast<uint32_t>(queue ? queue->size() : rays.size()),
                                 queue != nullptr};
    stream_.dispatch(kernel, resources, push, gpu::groups_for(push.count, kernel.workgroup_size()));
    stream_.run();
    hits = hit_buffer.read_all<Hit>();
  }
  bool non_opaque() const { return data_.has_non_opaque; }

 private:
  BvhData data_;
  gpu::Buffer nodes_, triangles_;
  gpu::Stream stream_{device()};
};

/// The number of rows in which two lists of hits differ.
size_t differences(Query query, const std::vector<Hit>& a, const std::vector<Hit>& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const bool found = a[i].prim != shared::k_no_hit;
    bool same = found == (b[i].prim != shared::k_no_hit);
    if (same && found && query != Query::any_opaque)
      same = a[i].prim == b[i].prim && a[i].t == b[i].t && a[i].u == b[i].u && a[i].v == b[i].v;
    count += !same;
  }
  return count;
}

}  // namespace

TEST_CASE("compute tracer agrees with the oracle and with the host tracer") {
  for (const Case& c : hard_cases(4000))
    for (const bool splits : {false, true}) {
      BuildOptions options;
      options.spatial_splits = splits;
      ComputeTracer tracer(c.mesh, options);
      const HostTracer host(c.mesh.view());
      for (const Query query : k_queries) {
        INFO(c.name << ", query " << static_cast<int>(query) << ", splits " << splits);
        std::vector<Hit> hits(c.rays.size()), from_host(c.rays.size());
        tracer.trace(kernel(query, tracer.non_opaque()), c.rays, hits);
        CHECK(judge_all(c.mesh.view(), query, c.rays, hits) == "");
        host.trace(query, c.rays, from_host, nullptr, static_cast<uint32_t>(c.rays.size()), false);
        // Division on the CPU is correctly rounded, so every bit must be equal.
        if (device().info().is_cpu) CHECK(differences(query, hits, from_host) == 0);
      }
    }
  CHECK(device().validation_messages() == 0);
}

TEST_CASE("beside slivers both tracers find the same hits, on the device") {
  Random random(27);
  const gpu::Kernel closest = kernel(Query::closest, false);
  Mesh slivers;
  for (int i = 0; i < 40; ++i) slivers = joined(std::move(slivers), sliver(random));
  const std::vector<Ray> rays = rays_beside(random, slivers, 100000);
  std::vector<Hit> hits(rays.size()), from_host(rays.size());
  ComputeTracer(slivers).trace(closest, rays, hits);
  HostTracer(slivers.view()).trace(Query::closest, rays, from_host, nullptr, 100000, false);
  CHECK(judge_all(slivers.view(), Query::closest, rays, hits) == "");
  if (device().info().is_cpu) CHECK(differences(Query::closest, hits, from_host) == 0);
}

TEST_CASE("other fetch and stack variants give the same hits") {
  Random random(21);
  const Mesh mesh = soup(random, 5000, 10, 1, vec3(0), 0.3f);
  const std::vector<Ray> rays = hard_rays(random, mesh, 20000, 10);
  ComputeTracer tracer(mesh);
  for (const Query query : k_queries) {
    std::vector<Hit> usual(rays.size()), other(rays.size());
    tracer.trace(kernel(query, true), rays, usual);
    for (const gpu::Defines& defines :
         {gpu::Defines{{"LUCERNA_FETCH_STORAGE", "1"}}, gpu::Defines{{"LUCERNA_STACK_LOCAL", "1"}}}) {
      tracer.trace(kernel(query, true, defines), rays, other);
      CHECK(differences(query, usual, other) == 0);
    }
  }
}

TEST_CASE("of exact copies the first is hit, on the device") {
  Random random(22);
  const Mesh once = soup(random, 100, 10, 4), mesh = with_copies(once, 6);
  ComputeTracer tracer(mesh);
  const std::vector<Ray> rays = hard_rays(random, once, 20000, 12);
  std::vector<Hit> hits(rays.size());
  tracer.trace(kernel(Query::closest, true), rays, hits);
  size_t later = 0;
  for (const Hit& hit : hits) later += hit.prim != shared::k_no_hit && hit.prim >= once.count();
  CHECK(later == 0);
}

TEST_CASE("no ray leaks through a closed mesh, on the device: 10^7 rays") {
  Random random(23);
  std::vector<Ray> rays(1 << 18);
  std::vector<Hit> hits(rays.size());
  const gpu::Kernel closest = kernel(Query::closest, false), any = kernel(Query::any_opaque, false);
  for (const Closed& closed : closed_meshes()) {
    ComputeTracer tracer(closed.mesh);
    size_t missed = 0;
    for (int round = 0; round < 13; ++round) {
      rays_inside(random, closed, rays);
      tracer.trace(round % 4 == 3 ? any : closest, rays, hits);
      for (const Hit& hit : hits) missed += hit.prim == shared::k_no_hit;
    }
    CHECK(missed == 0);
  }
}

TEST_CASE("far objects change neither hits nor work, on the device") {
  Random random(26);
  const Mesh near = soup(random, 20000, 0.05f, 0.001f);
  const std::vector<Ray> rays = hard_rays(random, near, 20000, 0.05f);
  const gpu::Kernel counting = kernel(Query::closest, false, {{"LUCERNA_COUNT_BVH", "1"}});
  std::vector<Hit> alone(rays.size()), beside(rays.size());
  const auto visits = [&](const std::vector<Hit>& hits) {  // of rays that do not go there
    double sum = 0;
    for (size_t i = 0; i < hits.size(); ++i)
      if (alone[i].prim != shared::k_no_hit) sum += double(hits[i].u);
    return sum;
  };
  ComputeTracer(near).trace(counting, rays, alone);
  for (const Mesh& far_thing : far_things()) {
    ComputeTracer(joined(near, far_thing)).trace(counting, rays, beside);
    size_t differ = 0;
    for (size_t i = 0; i < rays.size(); ++i)
      differ +=
          alone[i].prim != shared::k_no_hit && (alone[i].prim != beside[i].prim || alone[i].t != beside[i].t);
    CHECK(differ == 0);
    // A dome has boxes that contain the centre.
    CHECK(visits(beside) < 1.1 * visits(alone) + 20.0 * double(rays.size()));
  }
}

TEST_CASE("a wall 20 km from a room costs its rays less than a tenth more work, on the device") {
  Random random(28);
  Mesh room = star(random, 8, 3, 0);
  room = joined(std::move(room), soup(random, 20000, 1.5f, 0.02f));
  std::vector<Ray> rays(20000);
  for (Ray& ray : rays) ray = make_ray(random.in_box(1.5f), random.direction());
  const gpu::Kernel counting = kernel(Query::closest, false, {{"LUCERNA_COUNT_BVH", "1"}});
  const auto visits = [&](const Mesh& mesh) {
    std::vector<Hit> hits(rays.size());
    ComputeTracer(mesh).trace(counting, rays, hits);
    double sum = 0;
    for (const Hit& hit : hits) sum += double(hit.u);
    return sum;
  };
  const double alone = visits(room);
  for (const float away : {2e4f, 1e6f}) {
    Mesh beside = room;
    const vec3 p(away, 0, 0), up(0, 10, 0), along(0, 0, 10);
    beside.add(p, p + along, p + along + up), beside.add(p, p + along + up, p + up);
    const double factor = visits(beside) / alone;
    INFO("at " << away << " m");
    CHECK(factor < 1.1);
  }
}

TEST_CASE("a tree that fills the stack") {
  // Triangles as large as their distance, the farthest at the root: each level has an inner node with two of
  // them and the rest. The pair is larger than the rest, so nodes of four children contain the pair and one
  // level of the rest: three entries for two levels, which is the worst case. Rays from the near end pass
  // every box in the half that its triangle does not cover, and leave three entries in every node; only the
  // triangle `odd` covers the other half. For some `odd` it is under the last entry that fits.
  Random random(25);
  for (uint32_t odd = 0; odd < 2 * k_max_depth; ++odd) {
    Mesh mesh;
    float x = 1e3f;
    for (uint32_t i = 0; i < 2 * k_max_depth; ++i, x /= 1.6f) {
      const float near = i == odd ? 1.2f : 1.0f, far = i == odd ? 1.0f : 1.2f;
      mesh.add(x * vec3(1, near, near), x * vec3(1, far, near), x * vec3(1, near, far));
    }
    Tree tree;
    tree.references = references_of(mesh.view());
    REQUIRE(tree.references.size() == 2 * k_max_depth);
    const auto box = [&](uint32_t first, uint32_t count) {
      Box b;
      for (uint32_t i = first; i < first + count; ++i) b.grow(tree.references[i].box);
      return b;
    };
    const auto pair = [&](uint32_t first) {
      const auto at = static_cast<uint32_t>(tree.nodes.size());
      tree.nodes.push_back({box(first, 2), {at + 1, at + 2}, first, 2});
      for (uint32_t i = first; i < first + 2; ++i)
        tree.nodes.push_back({box(i, 1), {Tree::k_leaf, Tree::k_leaf}, i, 1});
    };
    for (uint32_t level = 0; level + 1 < k_max_depth; ++level) {
      const auto at = static_cast<uint32_t>(tree.nodes.size());
      const uint32_t count = 2 * (k_max_depth - level);
      tree.nodes.push_back({box(2 * level, count), {at + 4, at + 1}, 2 * level, count});
      pair(2 * level);
    }
    pair(2 * k_max_depth - 2);
    REQUIRE(depth(tree) == k_max_depth);
    const BvhData data = flatten(tree, mesh.view());
    REQUIRE(data.stack >= k_stack - 2);
    REQUIRE(check(data, mesh.view()) == "");
    std::vector<Ray> rays;
    for (int i = 0; i < 64; ++i)
      rays.push_back(towards(vec3(0), vec3(1, random.uniform(1.13f, 1.17f), random.uniform(1.13f, 1.17f))));
    std::vector<Hit> hits(rays.size());
    ComputeTracer tracer(data);
    tracer.trace(kernel(Query::closest, false), rays, hits);
    size_t found = 0;
    for (const Hit& hit : hits) found += hit.prim == odd;
    CHECK(found == rays.size());
  }
}

TEST_CASE("queues and dead rays on the device") {
  Random random(24);
  const Mesh mesh = soup(random, 2000, 10, 2, vec3(0), 0.3f);
  std::vector<Ray> rays = hard_rays(random, mesh, 5001, 10);
  rays[3].tmax = std::nanf("");
  rays[4].tmax = -1;
  ComputeTracer tracer(mesh);
  const gpu::Kernel closest = kernel(Query::closest, true);
  const Hit untouched{7, 7, 7, 7};
  std::vector<Hit> expected(rays.size()), queued(rays.size(), untouched);
  tracer.trace(closest, rays, expected);
  CHECK(expected[3].prim == shared::k_no_hit);
  CHECK(expected[4].prim == shared::k_no_hit);
  std::vector<uint32_t> queue;
  for (uint32_t i = 0; i < 5001; i += 2) queue.push_back(i);
  for (uint32_t i = 1; i < 5001; i += 2) expected[i] = untouched;
  for (size_t i = queue.size(); i > 1; --i)
    std::swap(queue[i - 1], queue[random.below(static_cast<uint32_t>(i))]);
  tracer.trace(closest, rays, queued, &queue);
  CHECK(differences(Query::closest, queued, expected) == 0);
  CHECK(device().validation_messages() == 0);
}

}  // namespace trace_bvh_tests
