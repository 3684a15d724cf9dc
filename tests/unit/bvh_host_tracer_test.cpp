// links: bvh_embree
// The host tracer compared with the oracle, and leaks.
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>

#include "bvh/embree/host_tracer.h"
#include "bvh/embree/packed_triangles.h"
#include "bvh/embree/reference.h"
#include "unit/bvh_support.h"

namespace bvh_host_tracer_tests {

using namespace lucerna;
using namespace lucerna::bvh;
using namespace lucerna::bvh::test;

namespace {

constexpr Query k_queries[] = {Query::closest, Query::any_opaque, Query::closest_non_opaque};

bool same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)) == 0;
}

std::vector<PackedTriangles> packed(const Mesh& mesh) {
  std::vector<PackedTriangles> all;
  for (size_t first = 0; first < mesh.count(); first += k_lanes) {
    PackedTriangles triangles;
    for (size_t k = 0; k < k_lanes; ++k) {
      const size_t prim = first + k < mesh.count() ? first + k : first;
      triangles.prim[k] = static_cast<uint32_t>(prim);
      for (size_t corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis)
          triangles.vertex[corner][axis][k] = mesh.vertices[3 * prim + corner][axis];
    }
    all.push_back(triangles);
  }
  return all;
}

/// The closest hit by the same triangle test, without a tree.
Hit closest_of_all(const std::vector<PackedTriangles>& all, const Ray& ray) {
  Hit hit{0, shared::k_no_hit, 0, 0};
  const ShearedRay sheared(ray);
  for (const PackedTriangles& triangles : all) {
    Floats t, u, v;
    for (uint32_t hits = intersect(triangles, sheared, t, u, v); hits != 0; hits &= hits - 1) {
      const int k = std::countr_zero(hits);
      if (hit.prim == shared::k_no_hit || t[k] < hit.t || (t[k] == hit.t && triangles.prim[k] < hit.prim))
        hit = {t[k], triangles.prim[k], u[k], v[k]};
    }
  }
  return hit;
}

}  // namespace

TEST_CASE("host tracer agrees with the oracle") {
  for (const Case& c : hard_cases(4000)) {
    const HostTracer tracer(c.mesh.view());
    std::vector<Hit> hits(c.rays.size()), packets(c.rays.size());
    const auto count = static_cast<uint32_t>(c.rays.size());
    for (const Query query : k_queries) {
      INFO(c.name << ", query " << static_cast<int>(query));
      tracer.trace(query, c.rays, hits, nullptr, count, false);
      CHECK(judge_all(c.mesh.view(), query, c.rays, hits) == "");
      tracer.trace(query, c.rays, packets, nullptr, count, true);
      CHECK(same(hits, packets));
    }
  }
}

TEST_CASE("of exact copies the first is hit") {
  Random random(12);
  const Mesh once = soup(random, 100, 10, 4), mesh = with_copies(once, 6);
  const HostTracer tracer(mesh.view());
  const std::vector<Ray> rays = hard_rays(random, once, 20000, 12);
  std::vector<Hit> hits(rays.size());
  for (const bool coherent : {false, true}) {
    tracer.trace(Query::closest, rays, hits, nullptr, 20000, coherent);
    size_t later = 0;
    for (const Hit& hit : hits) later += hit.prim != shared::k_no_hit && hit.prim >= once.count();
    CHECK(later == 0);
  }
}

TEST_CASE("trees find exactly the hits that the triangle test accepts") {
  Random random(19);
  size_t differ = 0, blocked_differ = 0, found = 0;
  for (int i = 0; i < 202; ++i) {
    const Mesh mesh = i < 200 ? sliver(random) : i == 200 ? soup(random, 100, 1, 1) : icosphere(1, 1);
    const uint32_t count = i < 200 ? 1000 : 20000;
    const HostTracer tracer(mesh.view(), 1);
    const std::vector<PackedTriangles> all = packed(mesh);
    const std::vector<Ray> rays = rays_beside(random, mesh, count);
    std::vector<Hit> hits(count), blocked(count);
    tracer.trace(Query::closest, rays, hits, nullptr, count, false);
    tracer.trace(Query::any_opaque, rays, blocked, nullptr, count, false);
    for (uint32_t k = 0; k < count; ++k) {
      const Hit expected = closest_of_all(all, rays[k]);
      found += expected.prim != shared::k_no_hit;
      differ += expected.prim != hits[k].prim || expected.t != hits[k].t;
      blocked_differ += (expected.prim == shared::k_no_hit) != (blocked[k].prim == shared::k_no_hit);
    }
  }
  CHECK(found > 20000);
  CHECK(differ == 0);
  CHECK(blocked_differ == 0);
}

TEST_CASE("no ray leaks through a closed mesh: 10^7 rays") {
  Random random(13);
  std::vector<Ray> rays(1 << 18);
  std::vector<Hit> hits(rays.size());
  for (const Closed& closed : closed_meshes()) {
    const HostTracer tracer(closed.mesh.view());
    size_t missed = 0;
    for (int round = 0; round < 13; ++round) {
      rays_inside(random, closed, rays);
      tracer.trace(Query::closest, rays, hits, nullptr, static_cast<uint32_t>(rays.size()), false);
      for (const Hit& hit : hits) missed += hit.prim == shared::k_no_hit;
    }
    CHECK(missed == 0);
  }
}

TEST_CASE("far objects change neither hits nor work") {
  Random random(16);
  const Mesh near = soup(random, 20000, 0.05f, 0.001f);
  const std::vector<Ray> rays = hard_rays(random, near, 20000, 0.05f);
  std::vector<Hit> alone(rays.size()), beside(rays.size());
  const HostTracer first(near.view());
  first.trace(Query::closest, rays, alone, nullptr, 20000, false);
  for (const Mesh& far_thing : far_things()) {
    const Mesh both = joined(near, far_thing);
    const HostTracer second(both.view());
    second.trace(Query::closest, rays, beside, nullptr, 20000, false);
    size_t differ = 0;
    for (size_t i = 0; i < rays.size(); ++i)
      differ += alone[i].prim != shared::k_no_hit && std::memcmp(&alone[i], &beside[i], sizeof(Hit)) != 0;
    CHECK(differ == 0);
    // Each ray that continues hits a far object; a dome has boxes that contain the centre.
    CHECK(double(second.leaf_tests()) < 1.1 * double(first.leaf_tests()) + 2.0 * double(rays.size()));
  }
}

TEST_CASE("queues, threads and dead rays") {
  Random random(14);
  const Mesh mesh = soup(random, 2000, 10, 2, vec3(0), 0.3f);
  std::vector<Ray> rays = hard_rays(random, mesh, 5001, 10);
  rays[3].tmax = std::nanf("");
  rays[4].tmax = -1;
  const HostTracer one(mesh.view(), 1), four(mesh.view(), 4);
  CHECK(one.threads() == 1);
  CHECK(four.threads() == 4);
  CHECK(four.bytes() > 2000 * 36);
  for (const Query query : k_queries)
    for (const bool coherent : {false, true}) {
      std::vector<Hit> a(rays.size()), b(rays.size());
      one.trace(query, rays, a, nullptr, 5001, coherent);
      four.trace(query, rays, b, nullptr, 5001, coherent);
      CHECK(same(a, b));
      CHECK(a[3].prim == shared::k_no_hit);
      CHECK(a[4].prim == shared::k_no_hit);
    }
  // A queue in any order gives each ray the hit that it has alone; rays outside the queue keep their hits.
  const Hit untouched{7, 7, 7, 7};
  std::vector<Hit> expected(rays.size()), queued(rays.size(), untouched);
  one.trace(Query::closest, rays, expected, nullptr, 5001, false);
  std::vector<uint32_t> queue;
  for (uint32_t i = 0; i < 5001; i += 2) queue.push_back(i);
  for (uint32_t i = 1; i < 5001; i += 2) expected[i] = untouched;
  for (size_t i = queue.size(); i > 1; --i)
    std::swap(queue[i - 1], queue[random.below(static_cast<uint32_t>(i))]);
  four.trace(Query::closest, rays, queued, queue.data(), static_cast<uint32_t>(queue.size()), true);
  CHECK(same(queued, expected));
  four.trace(Query::closest, rays, queued, queue.data(), 0, false);
  CHECK(same(queued, expected));
}

TEST_CASE("rays traced as a packet have the hits that each has alone") {
  Random random(18);
  const Mesh mesh = soup(random, 20000, 10, 0.5f, vec3(0), 0.3f);
  const HostTracer tracer(mesh.view());
  std::vector<Ray> rays;
  const auto add = [&](const vec3& eye, const vec3& size) {
    for (uint32_t y = 0; y < 96; ++y)
      for (uint32_t x = 0; x < 96; ++x) {
        const uint32_t tile = x / 8 + 12 * (y / 8), in = x % 8 + 8 * (y % 8);
        const vec3 at(float(8 * (tile % 12) + in % 8) - 47, float(8 * (tile / 12) + in / 8) - 47, -96);
        rays.push_back(make_ray(eye, glm::normalize(at * size), 1e30f));
      }
  };
  add(vec3(1, 2, 14), vec3(1));    // from outside
  add(vec3(0.1f, 0, 1), vec3(4));  // from inside
  add(vec3(-3, 1, 12), vec3(1, 1e-4f, 1));
  for (size_t i = 0; i < rays.size(); ++i) {
    rays[i].origin += 0.1f * random.in_box(1);  // as through a lens
    if (i % 700 == 3) rays[i].tmax = -1;
    if (i % 320 == 5) rays[i].direction.y = std::nanf("");
    if (i % 11 == 0) rays[i].tmax = random.uniform(0, 20);
  }
  const auto count = static_cast<uint32_t>(rays.size());
  for (const Query query : k_queries) {
    std::vector<Hit> alone(count), together(count);
    tracer.trace(query, rays, alone, nullptr, count, false);
    const uint64_t tests = tracer.leaf_tests();
    tracer.trace(query, rays, together, nullptr, count - 13, true);
    // The last slots are empty.
    std::copy(alone.end() - 13, alone.end(), together.end() - 13);
    CHECK(same(alone, together));
    CHECK(tracer.leaf_tests() - tests < 3 * tests);
  }
}

TEST_CASE("the bench's reference tracer sees the same scene") {
  Random random(15);
  const Mesh mesh = soup(random, 2000, 10, 2);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i)
    rays.push_back(make_ray(random.in_box(12), random.direction(), random.uniform(-1, 30)));
  const HostTracer host(mesh.view());
  const EmbreeReference reference(mesh.view());
  std::vector<Hit> a(rays.size()), b(rays.size());
  for (const Query query : {Query::closest, Query::any_opaque}) {
    host.trace(query, rays, a, nullptr, 20000, false);
    reference.trace(query, rays, b);
    size_t differ = 0;
    for (size_t i = 0; i < rays.size(); ++i) differ += a[i].prim != b[i].prim;
    CHECK(differ <= 2);  // rays within rounding of an edge: about 10^-6 of random ones
  }
  CHECK_THROWS(reference.trace(Query::closest_non_opaque, rays, b));
}

}  // namespace bvh_host_tracer_tests
