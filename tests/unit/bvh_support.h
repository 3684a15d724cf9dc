#pragma once
// Triangles and rays that are difficult for tracers, and the rules for comparing hits with the oracle.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bvh/oracle.h"

namespace lucerna::bvh::test {

using shared::Hit;
using shared::Ray;

struct Mesh {
  std::vector<vec3> vertices;
  std::vector<uint8_t> non_opaque;
  void add(const vec3& a, const vec3& b, const vec3& c, bool transparent = false) {
    vertices.insert(vertices.end(), {a, b, c});
    non_opaque.push_back(transparent);
  }
  Triangles view() const { return {vertices, non_opaque}; }
  size_t count() const { return non_opaque.size(); }
};

/// Deterministic on every platform, unlike the distributions of <random>.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  float uniform() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }
  float uniform(float lo, float hi) { return lo + (hi - lo) * uniform(); }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
  vec3 in_box(float half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  vec3 direction() {
    const float z = uniform(-1, 1), phi = 2 * k_pi * uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_;
};

inline Ray make_ray(const vec3& origin, const vec3& direction, float tmax = k_infinity) {
  return {origin, tmax, direction, 0};
}

inline Ray towards(const vec3& origin, const vec3& target) {
  const vec3 d = target - origin;
  const float length = glm::length(d);
  return make_ray(origin, length > 0 ? d / length : vec3(0, 0, 1));
}

/// `count` triangles in a cube of half-size `half` around `centre`, edges about `size`; a share is
/// non-opaque.
inline Mesh soup(Random& random, size_t count, float half, float size, const vec3& centre = vec3(0),
                 float transparent = 0) {
  Mesh mesh;
  for (size_t i = 0; i < count; ++i) {
    const vec3 p = centre + random.in_box(half);
    mesh.add(p, p + random.in_box(size), p + random.in_box(size), random.uniform() < transparent);
  }
  return mesh;
}

/// A closed surface around `centre`, shared vertices bit-identical: a sphere of `segments` x 2 `segments`
/// quads whose radius varies by the factor 1 ± `rough` from vertex to vertex (star-shaped, so that rays from
/// the centre hit once).
inline Mesh star(Random& random, int segments, float radius, float rough, const vec3& centre = vec3(0)) {
  const int rows = segments, columns = 2 * segments;
  std::vector<vec3> ring(static_cast<size_t>((rows + 1) * columns));
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const float theta = k_pi * static_cast<float>(r) / static_cast<float>(rows);
      const float phi = 2 * k_pi * static_cast<float>(c) / static_cast<float>(columns);
      const bool pole = r == 0 || r == rows;
      const vec3 d =
          pole ? vec3(0, r == 0 ? 1 : -1, 0)
               : vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      ring[static_cast<size_t>(r * columns + c)] =
          centre + radius * (pole ? 1.0f : random.uniform(1 - rough, 1 + rough)) * d;
    }
  Mesh mesh;
  const auto at = [&](int r, int c) { return ring[static_cast<size_t>(r * columns + c % columns)]; };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (r > 0) mesh.add(at(r, c), at(r, c + 1), at(r + 1, c));
      if (r + 1 < rows) mesh.add(at(r, c + 1), at(r + 1, c + 1), at(r + 1, c));
    }
  return mesh;
}

/// An icosahedron subdivided `levels` times (20 * 4^levels triangles), vertices on the sphere.
inline Mesh icosphere(int levels, float radius, const vec3& centre = vec3(0)) {
  const float g = 0.5f * (1 + std::sqrt(5.0f));
  const std::vector<vec3> p = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  struct Face {
    vec3 a, b, c;
  };
  std::vector<Face> list;
  for (const auto& f : faces)
    list.push_back({glm::normalize(p[f[0]]), glm::normalize(p[f[1]]), glm::normalize(p[f[2]])});
  for (int level = 0; level < levels; ++level) {
    std::vector<Face> next;
    for (const Face& f : list) {
      // a + b gives the same float for both faces, so shared vertices stay identical.
      const vec3 ab = glm::normalize(f.a + f.b), bc = glm::normalize(f.b + f.c),
                 ca = glm::normalize(f.c + f.a);
      next.insert(next.end(), {{f.a, ab, ca}, {ab, f.b, bc}, {ca, bc, f.c}, {ab, bc, ca}});
    }
    list = std::move(next);
  }
  Mesh mesh;
  for (const Face& f : list) mesh.add(centre + radius * f.a, centre + radius * f.b, centre + radius * f.c);
  return mesh;
}

/// Rays at a mesh: from around it towards random points, and exactly at points of its triangles: inside, on
/// edges, on vertices; also along the axes and from the surface itself. `half` is half the size of the region
/// in which rays start.
inline std::vector<Ray> hard_rays(Random& random, const Mesh& mesh, size_t count, float half,
                                  const vec3& centre = vec3(0)) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const vec3 origin = centre + random.in_box(half);
    const vec3* p = &mesh.vertices[3 * size_t{random.below(static_cast<uint32_t>(mesh.count()))}];
    const float s = random.uniform(), t = random.uniform();
    Ray ray;
    switch (i % 8) {
      case 0:
        ray = make_ray(origin, random.direction());
        break;
      case 1:
        ray = towards(origin, p[random.below(3)]);
        break;  // at a vertex
      case 2: {
        const uint32_t k = random.below(3);
        ray = towards(origin, p[k] + s * (p[(k + 1) % 3] - p[k]));
        break;
      }
      case 3:
        ray = towards(origin, p[0] + 0.5f * s * (p[1] - p[0]) + 0.5f * t * (p[2] - p[0]));
        break;
      case 4:    // along an axis, at a vertex
      case 5: {  // ... at a point
        const int axis = static_cast<int>(random.below(3));
        vec3 d(0);
        d[axis] = random.below(2) ? 1.0f : -1.0f;
        vec3 o = i % 8 == 4 ? p[random.below(3)] : p[0] + 0.5f * s * (p[1] - p[0]) + 0.5f * t * (p[2] - p[0]);
        o[axis] = centre[axis] - 2 * half * d[axis];
        ray = make_ray(o, d);
        break;
      }
      case 6: {  // in a plane of the axes
        ray = towards(origin, p[0]);
        const auto axis = static_cast<int>(random.below(3));
        ray.origin[axis] = p[0][axis], ray.direction[axis] = random.below(2) ? 0.0f : -0.0f;
        const float length = glm::length(ray.direction);
        ray.direction = length > 0 ? ray.direction / length : vec3(1, 0, 0);
        break;
      }
      default:
        ray = make_ray(p[0] + 0.5f * s * (p[1] - p[0]) + 0.5f * t * (p[2] - p[0]), random.direction());
    }
    if (i % 5 == 0) ray.tmax = random.uniform(0, 3 * half);
    if (i % 97 == 0) ray.tmax = 0;
    rays.push_back(ray);
  }
  return rays;
}

/// A sliver along an axis, so its box is as thin as itself.
inline Mesh sliver(Random& random) {
  const vec3 p = random.in_box(1);
  vec3 along(0);
  along[static_cast<int>(random.below(3))] = random.uniform(1, 3);
  Mesh mesh;
  mesh.add(p, p + along, p + std::exp2(random.uniform(-14, -8)) * random.direction());
  return mesh;
}

/// Rays that start close to a triangle, on one side and on the other.
inline std::vector<Ray> rays_beside(Random& random, const Mesh& mesh, size_t count) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const vec3* p = &mesh.vertices[3 * size_t{random.below(static_cast<uint32_t>(mesh.count()))}];
    const float s = random.uniform(), t = random.uniform(0, 1 - s);
    const vec3 a = p[1] - p[0], b = p[2] - p[0], n = glm::normalize(glm::cross(a, b));
    const float lift = (random.below(2) ? 1.0f : -1.0f) * std::exp2(random.uniform(-22, -14));
    rays.push_back(make_ray(p[0] + s * a + t * b + lift * glm::length(a) * n, random.direction()));
  }
  return rays;
}

/// How far single-precision rounding can move a hit point, in world units: a few units in the last place of
/// the coordinates relative to the ray.
inline double slack(const Triangles& triangles, const Ray& ray, uint32_t prim) {
  double reach = 0;
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const double v = triangles.vertices[3 * size_t{prim} + static_cast<size_t>(k)][axis],
                   o = ray.origin[axis];
      reach = std::max(reach, std::abs(v - o));
    }
  return 8 * 0x1p-24 * reach;
}

/// Rounding of t: that of the plane's distance, over the cosine.
inline double slack_t(const Triangles& triangles, const Ray& ray, uint32_t prim) {
  const vec3* p = &triangles.vertices[3 * size_t{prim}];
  const glm::dvec3 n = glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
  const double area = glm::length(n);
  const double cosine = area > 0 ? std::abs(glm::dot(n, glm::dvec3(ray.direction))) / area : 0;
  const double thin = [&] {  // the normal of a sliver is itself uncertain by reach / height
    double longest = 0;
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, static_cast<double>(glm::distance(p[k], p[(k + 1) % 3])));
    return longest > 0 ? area / (longest * longest) : 0;
  }();
  return slack(triangles, ray, prim) / std::max(1e-12, cosine * std::min(1.0, thin));
}

/// "" if `hit` answers `query` within what the tracers' headers state: rounding at edges, and equal distances
/// up to rounding. Otherwise a description of the error.
inline std::string judge(const Triangles& triangles, Query query, const Ray& ray, const Hit& hit) {
  const Hit truth = oracle(triangles, query, ray);
  const auto inside_by = [&](uint32_t prim) {
    const vec3* p = &triangles.vertices[3 * size_t{prim}];
    return cross(ray, p[0], p[1], p[2]);
  };
  const auto unsure = [&](uint32_t prim) {  // a hit that rounding may take away
    const Crossing x = inside_by(prim);
    const double e = slack(triangles, ray, prim), et = slack_t(triangles, ray, prim);
    return !x.plane || x.margin < e || x.t < et || std::abs(x.t - static_cast<double>(ray.tmax)) < et;
  };
  const bool found = hit.prim != shared::k_no_hit, there = truth.prim != shared::k_no_hit;
  if (found && !(ray.tmax > 0)) return "a dead ray has a hit";
  if (query == Query::any_opaque) {
    if (found == there) return {};
    if (there) return unsure(truth.prim) ? "" : "blocker missed";
    // A hit must come within rounding of blocking.
    for (size_t i = 0; i < triangles.count(); ++i) {
      if (!triangles.opaque(i)) continue;
      const auto prim = static_cast<uint32_t>(i);
      const Crossing x = inside_by(prim);
      const double e = slack(triangles, ray, prim), et = slack_t(triangles, ray, prim);
      if (x.plane && x.margin > -e && x.t > -et && x.t < static_cast<double>(ray.tmax) + et) return {};
    }
    return "blocked by nothing";
  }
  if (!found) return !there || unsure(truth.prim) ? "" : "hit missed";
  if (hit.prim >= triangles.count()) return "primitive id out of range";
  if (query == Query::closest_non_opaque && triangles.opaque(hit.prim))
    return "an opaque triangle among the non-opaque";
  if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v)) return "not finite";
  if (!(hit.t > 0) || !(hit.t < ray.tmax)) return "t out of range";
  if (hit.u < 0 || hit.v < 0 || hit.u + hit.v > 1.00001f) return "barycentrics out of range";
  const Crossing x = inside_by(hit.prim);
  const double e = slack(triangles, ray, hit.prim), et = slack_t(triangles, ray, hit.prim);
  if (x.plane && x.margin < -e) return "the ray passes beside the triangle";
  if (x.plane && std::abs(x.t - static_cast<double>(hit.t)) > et) return "wrong distance";
  if (hit.prim == truth.prim) return {};
  if (there &&
      static_cast<double>(hit.t) > static_cast<double>(truth.t) + et + slack_t(triangles, ray, truth.prim) &&
      !unsure(truth.prim))
    return "a nearer triangle was missed";
  return {};
}

/// Objects far away from a scene of metres, each alone: the tracers' work and hits near the origin must not
/// depend on them.
inline std::vector<Mesh> far_things() {
  std::vector<Mesh> things;
  for (const float away : {2e4f, 1e5f}) {
    Mesh wall;  // as large as a house
    const vec3 p(away, 0, 0), up(0, 10, 0), along(0, 0, 10);
    wall.add(p, p + along, p + along + up), wall.add(p, p + along + up, p + up);
    things.push_back(wall);
    Mesh dome = icosphere(2, away);  // around all
    things.push_back(dome);
  }
  return things;
}

/// `mesh`, followed by the triangles of `more`.
inline Mesh joined(Mesh mesh, const Mesh& more) {
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  mesh.non_opaque.insert(mesh.non_opaque.end(), more.non_opaque.begin(), more.non_opaque.end());
  return mesh;
}

/// A mesh with rays that are difficult for it.
struct Case {
  std::string name;
  Mesh mesh;
  std::vector<Ray> rays;
};

inline std::vector<Case> hard_cases(size_t rays_each) {
  Random random(11);
  std::vector<Case> cases;
  const auto add = [&](std::string name, Mesh mesh, float half, const vec3& centre = vec3(0)) {
    std::vector<Ray> rays = hard_rays(random, mesh, rays_each, half, centre);
    cases.push_back({std::move(name), std::move(mesh), std::move(rays)});
  };
  add("soup", soup(random, 300, 10, 3, vec3(0), 0.4f), 10);
  const vec3 far(1e4f, 1e4f, -1e4f);
  add("far from the origin", soup(random, 300, 5, 2, far, 0.4f), 8, far);
  Mesh slivers;
  for (int i = 0; i < 300; ++i) {
    const vec3 p = random.in_box(5), d = 4.0f * random.direction();
    slivers.add(p, p + d, p + 0.5f * d + 1e-4f * random.direction(), i % 3 == 0);
  }
  add("slivers", slivers, 8);
  add("closed mesh", star(random, 8, 3, 0.3f), 6);
  Mesh grid;
  for (int x = 0; x < 8; ++x)
    for (int z = 0; z < 8; ++z) {
      const vec3 p(float(x), float((x + z) % 3), float(z));
      grid.add(p, p + vec3(1, 0, 0), p + vec3(1, 0, 1), x % 2 == 0);
      grid.add(p, p + vec3(1, 0, 1), p + vec3(0, 0, 1));
    }
  add("axis-aligned grid", grid, 8, vec3(4, 1, 4));
  Mesh mixed = soup(random, 100, 5, 3);  // degenerate ones among others
  for (int i = 0; i < 30; ++i) {
    const vec3 p = random.in_box(5), d = random.in_box(1);
    mixed.add(p, p, p), mixed.add(p, p + d, p), mixed.add(p, p + d, p + 2.0f * d);
  }
  add("degenerate triangles", mixed, 8);
  Mesh one;
  one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, true);
  add("one triangle", one, 2);
  const Mesh near = soup(random, 300, 5, 1, vec3(0), 0.4f);
  for (const Mesh& far_thing : far_things()) {
    Mesh both = joined(near, far_thing);
    std::vector<Ray> rays = hard_rays(random, near, rays_each / 4, 8);
    const std::vector<Ray> across = hard_rays(random, both, rays_each / 4, 8);
    rays.insert(rays.end(), across.begin(), across.end());
    // Back from there.
    for (size_t i = 0; i < rays_each / 4; ++i)
      rays.push_back(towards(both.vertices.back() + random.in_box(3),
                             near.vertices[random.below(static_cast<uint32_t>(near.vertices.size()))]));
    cases.push_back({"beside something far away", std::move(both), std::move(rays)});
  }
  Mesh on_ground = near;
  const float wide = 5e4f;
  on_ground.add({-wide, 0.1f, -wide}, {wide, 0.3f, -wide}, {wide, 0.3f, wide});
  on_ground.add({-wide, 0.1f, -wide}, {wide, 0.3f, wide}, {-wide, 0.1f, wide}, true);
  add("on a very large ground", on_ground, 8);
  cases.push_back({"no triangle", Mesh{}, hard_rays(random, one, 100, 2)});
  return cases;
}

/// A mesh repeated `copies` times: every triangle again, in another order, after all the first ones.
inline Mesh with_copies(const Mesh& once, int copies) {
  Mesh mesh = once;
  for (int copy = 0; copy < copies; ++copy)
    for (size_t i = 0; i < once.count(); ++i) {
      const vec3* p = &once.vertices[3 * ((i * 37) % once.count())];
      mesh.add(p[0], p[1], p[2], copy % 2 == 0);
    }
  return mesh;
}

/// A closed mesh and a region inside it.
struct Closed {
  Mesh mesh;
  vec3 centre;
  float half;  ///< of the cube around the centre that origins are taken from
};

inline std::vector<Closed> closed_meshes() {
  Random random(13);
  const vec3 far(1e4f, -1e4f, 5e3f);
  return {{icosphere(5, 2), vec3(0), 1},
          {star(random, 60, 2, 0.2f), vec3(0), 0.5f},
          {icosphere(3, 3, far), far, 1},
          {joined(star(random, 60, 2, 0.2f), far_things()[2]), vec3(0), 0.5f},
          // Seen from far outside, where its triangles are hardly larger than rounding.
          {joined(icosphere(2, 1e5f), icosphere(4, 2)), vec3(0), 5e4f}};
}

/// Rays from inside a closed mesh, half of them exactly at its edges and vertices, where leaks would be.
inline void rays_inside(Random& random, const Closed& closed, std::vector<Ray>& rays) {
  for (Ray& ray : rays) {
    const vec3 origin = closed.centre + random.in_box(closed.half);
    const vec3* p =
        &closed.mesh.vertices[3 * size_t{random.below(static_cast<uint32_t>(closed.mesh.count()))}];
    const uint32_t k = random.below(8);
    ray = k < 4 ? make_ray(origin, random.direction())
                : towards(origin, k == 4 ? p[0] : p[1] + random.uniform() * (p[2] - p[1]));
  }
}

/// Checks all hits; "" or a line with the number of errors and the first of them.
inline std::string judge_all(const Triangles& triangles, Query query, const std::vector<Ray>& rays,
                             const std::vector<Hit>& hits) {
  size_t wrong = 0;
  std::string first;
  for (size_t i = 0; i < rays.size(); ++i) {
    const std::string verdict = judge(triangles, query, rays[i], hits[i]);
    if (verdict.empty() || ++wrong > 1) continue;
    first = fmt::format("ray {}: {} (prim {} t {}, oracle {})", i, verdict, hits[i].prim, hits[i].t,
                        oracle(triangles, query, rays[i]).prim);
  }
  return wrong == 0 ? "" : fmt::format("{} wrong; {}", wrong, first);
}

}  // namespace lucerna::bvh::test
