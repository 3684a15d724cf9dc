// links: bvh_embree
// The host tracer against the oracle, and against leaks.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "bvh/embree/host_tracer.h"
#include "unit/bvh_support.h"

using namespace lucerna;
using namespace lucerna::bvh;
using namespace lucerna::bvh::test;

namespace {

void agrees(const Mesh& mesh, const std::vector<Ray>& rays) {
  const HostTracer tracer(mesh.view());
  std::vector<Hit> hits(rays.size());
  const auto count = static_cast<uint32_t>(rays.size());
  for (const Query query : {Query::closest, Query::any_opaque, Query::closest_non_opaque})
    for (const bool coherent : {false, true}) {
      tracer.trace(query, rays, hits, nullptr, count, coherent);
      size_t wrong = 0;
      std::string first;
      for (size_t i = 0; i < rays.size(); ++i) {
        const std::string verdict = judge(mesh.view(), query, rays[i], hits[i]);
        if (!verdict.empty() && ++wrong == 1)
          first = fmt::format("ray {}: {} (prim {} t {}, oracle {})", i, verdict, hits[i].prim, hits[i].t,
                              oracle(mesh.view(), query, rays[i]).prim);
      }
      INFO("query " << static_cast<int>(query) << " coherent " << coherent << ": " << first);
      CHECK(wrong == 0);
    }
}

/// Rays from inside a closed mesh that hit nothing.
size_t leaks(const HostTracer& tracer, Random& random, const Mesh& mesh, size_t count, const vec3& centre,
             float half) {
  std::vector<Ray> rays(1 << 18);
  std::vector<Hit> hits(rays.size());
  size_t missed = 0;
  for (size_t done = 0; done < count; done += rays.size()) {
    for (Ray& ray : rays) {
      const vec3 origin = centre + random.in_box(half);
      // Half of the rays go straight at edges and vertices, where leaks would be.
      const vec3* p = &mesh.vertices[3 * size_t{random.below(static_cast<uint32_t>(mesh.count()))}];
      const uint32_t k = random.below(8);
      ray = k < 4 ? make_ray(origin, random.direction())
                  : towards(origin, k == 4 ? p[0] : p[1] + random.uniform() * (p[2] - p[1]));
    }
    tracer.trace(Query::closest, rays, hits, nullptr, static_cast<uint32_t>(rays.size()), false);
    for (const Hit& hit : hits) missed += hit.prim == shared::k_no_hit;
  }
  return missed;
}

}  // namespace

TEST_CASE("host tracer agrees with the oracle") {
  Random random(11);
  SECTION("soup") {
    const Mesh mesh = soup(random, 300, 10, 3, vec3(0), 0.4f);
    agrees(mesh, hard_rays(random, mesh, 4000, 10));
  }
  SECTION("far from the origin") {
    const vec3 centre(1e4f, 1e4f, -1e4f);
    const Mesh mesh = soup(random, 300, 5, 2, centre, 0.4f);
    agrees(mesh, hard_rays(random, mesh, 4000, 8, centre));
  }
  SECTION("slivers") {
    Mesh mesh;
    for (int i = 0; i < 300; ++i) {
      const vec3 p = random.in_box(5), d = 4.0f * random.direction();
      mesh.add(p, p + d, p + 0.5f * d + 1e-4f * random.direction(), i % 3 == 0);
    }
    agrees(mesh, hard_rays(random, mesh, 4000, 8));
  }
  SECTION("closed mesh") {
    const Mesh mesh = star(random, 8, 3, 0.3f);
    agrees(mesh, hard_rays(random, mesh, 4000, 6));
  }
  SECTION("axis-aligned grid") {
    Mesh mesh;
    for (int x = 0; x < 8; ++x)
      for (int z = 0; z < 8; ++z) {
        const vec3 p(float(x), float((x + z) % 3), float(z));
        mesh.add(p, p + vec3(1, 0, 0), p + vec3(1, 0, 1), x % 2 == 0);
        mesh.add(p, p + vec3(1, 0, 1), p + vec3(0, 0, 1));
      }
    agrees(mesh, hard_rays(random, mesh, 4000, 8, vec3(4, 1, 4)));
  }
  SECTION("one triangle, and none") {
    Mesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, true);
    agrees(mesh, hard_rays(random, mesh, 1000, 2));
    Mesh none;
    agrees(none, hard_rays(random, mesh, 100, 2));
  }
}

TEST_CASE("of exact copies the first is hit") {
  Random random(12);
  Mesh mesh = soup(random, 100, 10, 4);
  const Mesh once = mesh;
  for (int copy = 0; copy < 6; ++copy)
    for (size_t i = 0; i < once.count(); ++i) {
      const vec3* p = &once.vertices[3 * ((i * 37) % once.count())];
      mesh.add(p[0], p[1], p[2], copy % 2 == 0);
    }
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

TEST_CASE("no ray leaks through a closed mesh: 10^7 rays") {
  Random random(13);
  const Mesh sphere = icosphere(5, 2);
  CHECK(leaks(HostTracer(sphere.view()), random, sphere, 4'000'000, vec3(0), 1) == 0);
  const Mesh rock = star(random, 60, 2, 0.2f);
  CHECK(leaks(HostTracer(rock.view()), random, rock, 4'000'000, vec3(0), 0.5f) == 0);
  const vec3 far(1e4f, -1e4f, 5e3f);
  const Mesh away = icosphere(3, 3, far);
  CHECK(leaks(HostTracer(away.view()), random, away, 2'000'000, far, 1) == 0);
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
  const auto same = [](const std::vector<Hit>& a, const std::vector<Hit>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)) == 0;
  };
  for (const Query query : {Query::closest, Query::any_opaque, Query::closest_non_opaque})
    for (const bool coherent : {false, true}) {
      std::vector<Hit> a(rays.size()), b(rays.size());
      one.trace(query, rays, a, nullptr, 5001, coherent);
      four.trace(query, rays, b, nullptr, 5001, coherent);
      CHECK(same(a, b));
      CHECK(a[3].prim == shared::k_no_hit);
      CHECK(a[4].prim == shared::k_no_hit);
    }
  // A queue in any order gives each ray the hit that it has alone; rays outside it keep theirs.
  const Hit untouched{7, 7, 7, 7};
  std::vector<Hit> alone(rays.size()), queued(rays.size(), untouched);
  one.trace(Query::closest, rays, alone, nullptr, 5001, false);
  std::vector<uint32_t> queue;
  for (uint32_t i = 0; i < 5001; i += 2) queue.push_back(i);
  for (size_t i = queue.size(); i > 1; --i)
    std::swap(queue[i - 1], queue[random.below(static_cast<uint32_t>(i))]);
  four.trace(Query::closest, rays, queued, queue.data(), static_cast<uint32_t>(queue.size()), true);
  size_t differ = 0;
  for (uint32_t i = 0; i < 5001; ++i)
    differ += std::memcmp(&queued[i], i % 2 == 0 ? &alone[i] : &untouched, sizeof(Hit)) != 0;
  CHECK(differ == 0);
  four.trace(Query::closest, rays, queued, queue.data(), 0, false);
}
