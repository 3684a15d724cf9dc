#include "session/found_portals.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/log.h"
#include "bvh/embree/workers.h"
#include "session/pick.h"

namespace lucerna::session {
namespace {

constexpr size_t k_most_cameras = 16;
constexpr size_t k_walks = 128;          // in all, shared by the cameras
constexpr size_t k_bounces = 4;          // points of a walk
constexpr size_t k_rays = 256;           // from each point
constexpr size_t k_most_walls = 12;      // directions of walls besides the axes
constexpr float k_same_wall = 0.9998f;   // cosine
constexpr double k_least_wall = 0.02;    // of all hits
constexpr size_t k_portal_points = 256;  // of a marked portal
constexpr size_t k_portal_rays = 4;      // from each of them

class Random {
 public:
  explicit Random(size_t seed) : bits_(uint32_t(seed)) {}
  float operator()() { return float(bits_() >> 8) * 0x1p-24f; }
  vec3 on_sphere() {
    const float z = 1 - 2 * (*this)(), phi = 2 * k_pi * (*this)(), r = std::sqrt(std::max(0.f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  /// By the cosine with the normal.
  vec3 on_hemisphere(const vec3& normal) {
    const vec3 d = normal + on_sphere();
    const float length = glm::length(d);
    return length > 1e-3f ? d / length : normal;
  }

 private:
  std::mt19937 bits_;
};

/// A point of a surface, and rays from it. The memory is allocated in advance.
struct Point {
  vec3 position{0}, normal{0};
  bool outdoors = false;
  std::vector<scene::RoomRay> rays;
  std::vector<vec3> normals;  // where they hit
};

/// A path from an eye.
struct Walk {
  size_t camera = 0;
  std::vector<Point> points;
  explicit Walk(size_t of) : camera(of), points(k_bounces) {
    for (Point& p : points) p.rays.reserve(k_rays), p.normals.reserve(k_rays);
  }
  bool outdoors() const {
    const auto out =
        size_t(std::count_if(points.begin(), points.end(), [](const Point& p) { return p.outdoors; }));
    return points.empty() || 2 * out > points.size();
  }
};

/// The nearest surface that stops light samples.
std::optional<Picked> nearest_surface(const Probe& probe, const vec3& from, const vec3& direction) {
  return probe.nearest(from, direction, k_infinity, [&](const Picked& p) {
    const scene::Material& m = probe.scene().materials[p.material];
    return !(m.transmission > 0 && m.thickness <= 0);
  });
}

class Search {
 public:
  explicit Search(std::shared_ptr<const scene::Scene> scene) : probe_(std::move(scene)) {}

  void go(Walk& walk, const vec3& eye, Random random) const {
    vec3 from = eye, direction = random.on_sphere();
    size_t count = 0;
    for (Point& p : walk.points) {
      const std::optional<Picked> hit = nearest_surface(probe_, from, direction);
      if (!hit) break;
      // Off the surface, by more than rounding.
      const float off = 1e-4f * std::max(hit->distance, 1e-3f * glm::length(hit->position));
      p.position = hit->position + off * hit->normal, p.normal = hit->normal;
      from = p.position, direction = random.on_hemisphere(p.normal);
      ++count;
    }
    walk.points.resize(count);
    for (Point& p : walk.points) look_around(p, random);
  }

 private:
  void look_around(Point& p, Random& random) const {
    size_t escaping = 0;
    for (size_t i = 0; i < k_rays; ++i) {
      const vec3 direction = random.on_hemisphere(p.normal);
      const std::optional<Picked> hit = nearest_surface(probe_, p.position, direction);
      p.rays.push_back({p.position, direction, !hit});
      if (hit) p.normals.push_back(hit->normal);
      escaping += !hit;
    }
    p.outdoors = 2 * escaping > k_rays;
  }

  Probe probe_;
};

/// Outward normals of walls, the most frequent first, then the axes.
std::vector<vec3> walls_of(const std::vector<const Point*>& points) {
  struct Wall {
    vec3 out;
    size_t hits;
  };
  std::vector<Wall> walls;
  size_t all = 0;
  for (const Point* p : points)
    for (const vec3& normal : p->normals) {
      ++all;
      const auto same = std::find_if(walls.begin(), walls.end(), [&](const Wall& wall) {
        return glm::dot(wall.out, -normal) > k_same_wall;
      });
      if (same != walls.end())
        ++same->hits;
      else if (walls.size() < 256)
        walls.push_back({-normal, 1});
    }
  std::stable_sort(walls.begin(), walls.end(), [](const Wall& a, const Wall& b) { return a.hits > b.hits; });
  std::vector<vec3> to;
  for (const Wall& wall : walls)
    if (to.size() < k_most_walls && double(wall.hits) >= k_least_wall * double(all)) to.push_back(wall.out);
  for (int k = 0; k < 6; ++k) {
    vec3 axis(0);
    axis[k / 2] = k % 2 == 0 ? 1.f : -1.f;
    if (std::none_of(to.begin(), to.end(), [&](const vec3& w) { return glm::dot(w, axis) > k_same_wall; }))
      to.push_back(axis);
  }
  return to;
}

/// True if a ray from the room through some point of the portal leaves the scene.
bool sees_sky(const Probe& probe, const scene::Portal& portal) {
  Random random(0);
  const vec3 out = -scene::normal_of(portal);
  // In front of a wall in the portal's plane.
  const float size = glm::length(portal.half_width) + glm::length(portal.half_height);
  const vec3 front = portal.centre - 1e-3f * size * out;
  for (size_t i = 0; i < k_portal_points; ++i) {
    const float u = 2 * random() - 1, v = 2 * random() - 1;
    const vec3 from = front + u * portal.half_width + v * portal.half_height;
    for (size_t k = 0; k < k_portal_rays; ++k)
      if (!nearest_surface(probe, from, random.on_hemisphere(out))) return true;
  }
  return false;
}

}  // namespace

std::vector<scene::Opening> search_openings(std::shared_ptr<const scene::Scene> scene) {
  std::vector<scene::Camera> cameras = scene->cameras;
  if (cameras.empty()) cameras.push_back(scene::default_camera(*scene));
  cameras.resize(std::min(cameras.size(), k_most_cameras));
  std::vector<Walk> walks;
  for (size_t i = 0; i < k_walks; ++i) walks.emplace_back(i % cameras.size());
  const Search search(std::move(scene));
  bvh::Workers().run(uint32_t(walks.size()), [&](uint32_t i) {
    search.go(walks[i], vec3(cameras[walks[i].camera].to_world[3]), Random(i));
  });
  std::vector<const Point*> points;
  for (size_t c = 0; c < cameras.size(); ++c) {
    size_t own = 0, outdoors = 0;
    for (const Walk& walk : walks)
      if (walk.camera == c) ++own, outdoors += walk.outdoors();
    if (2 * outdoors > own) continue;
    for (const Walk& walk : walks)
      for (const Point& p : walk.points)
        if (walk.camera == c && !p.outdoors) points.push_back(&p);
  }
  std::vector<scene::RoomRay> rays;
  for (const Point* p : points) rays.insert(rays.end(), p->rays.begin(), p->rays.end());
  return scene::find_openings(rays, walls_of(points));
}

std::vector<scene::Portal> open_portals(std::shared_ptr<const scene::Scene> scene,
                                        const std::vector<scene::Portal>& marked) {
  if (marked.empty()) return {};
  const Probe probe(std::move(scene));
  std::vector<scene::Portal> open;
  for (const scene::Portal& portal : marked) {
    if (sees_sky(probe, portal)) {
      open.push_back(portal);
      continue;
    }
    const vec3& at = portal.centre;
    log::warning(
        "sky portal '{}' at {:.2f} {:.2f} {:.2f}: no ray through it reaches the sky (it lies in a wall, or "
        "faces outwards), left out",
        portal.name, at.x, at.y, at.z);
  }
  return open;
}

std::shared_ptr<const scene::Scene> with_portals(std::shared_ptr<const scene::Scene> scene,
                                                 const std::vector<scene::Portal>& marked,
                                                 const std::string& how, const Progress& progress) {
  std::vector<scene::Portal> portals = open_portals(scene, marked);
  const scene::Environment& sky = scene->environment;
  if (how == "found" && marked.empty() && (sky.image != scene::k_none || sky.radiance != vec3(0))) {
    if (progress && !progress(0, "searching openings")) throw Error("", "cancelled");
    const std::vector<scene::Opening> openings = search_openings(scene);
    if (openings.empty()) log::info("no opening of a room found");
    for (const scene::Opening& opening : openings) {
      scene::Portal portal = opening.portal;
      portal.name = fmt::format("opening {}", portals.size() + 1);
      // Without -0.
      const auto rounded = [](const vec3& v) { return glm::round(100.f * v) / 100.f + vec3(0); };
      const vec3 at = rounded(portal.centre), towards = rounded(scene::normal_of(portal));
      log::info(
          "{} found: {:.2f} x {:.2f} m at {:.2f} {:.2f} {:.2f}, lights towards {:.2f} {:.2f} {:.2f}, "
          "{:.0f} % of the rays that leave the room",
          portal.name, 2 * glm::length(portal.half_width), 2 * glm::length(portal.half_height), at.x, at.y,
          at.z, towards.x, towards.y, towards.z, 100 * opening.share);
      portals.push_back(std::move(portal));
    }
  }
  if (portals == scene->portals) return scene;
  auto with = std::make_shared<scene::Scene>(*scene);
  with->portals = std::move(portals);
  return with;
}

}  // namespace lucerna::session
