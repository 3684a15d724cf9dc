#pragma once
// Records of an irradiance cache in tests: places for them, and comparison of two caches.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "solvers/irradiance_cache/records.h"

namespace lucerna::test {

/// Points on the inner walls of a box of 4 x 3 x 5 m, `offset` away from the origin, with all facets and
/// origins.
inline std::vector<irradiance_cache::Place> box_points(size_t count, float offset = 0, float reach = 0) {
  std::mt19937 random(5);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<irradiance_cache::Place> points;
  for (size_t i = 0; i < count; ++i) {
    const int axis = int(random() % 3);
    const bool upper = random() % 2;
    irradiance_cache::Place p;
    p.position = vec3(unit() * 4, unit() * 3, unit() * 5);
    p.position[axis] = upper ? (axis == 0 ? 4.0f : axis == 1 ? 3.0f : 5.0f) : 0.0f;
    p.position += vec3(offset);
    p.normal = vec3(0);
    p.normal[axis] = upper ? -1.0f : 1.0f;
    p.reach = reach;
    p.facet = uint32_t(i) & 0x3fffff;
    p.origin = uint32_t(i % 3);
    points.push_back(p);
  }
  return points;
}

/// Distance of a place from a record relative to its radius in that direction: 1 at the border of its
/// ellipse.
inline float far_of(const irradiance_cache::Record& record, const vec3& at) {
  const vec3 away = at - record.place.position;
  const float along = dot(away, record.along), squared = dot(away, away) - along * along;
  return std::hypot(along / record.radius, std::sqrt(std::max(0.0f, squared)) / record.lesser_radius);
}

/// True if `all` begins with `some`, bit for bit.
inline bool begins_with(const std::vector<vec4>& all, const std::vector<vec4>& some) {
  return all.size() >= some.size() &&
         (some.empty() || std::memcmp(all.data(), some.data(), some.size() * sizeof(vec4)) == 0);
}
inline bool begins_with(const irradiance_cache::RawRecords& all, const irradiance_cache::RawRecords& some) {
  return begins_with(all.places, some.places) && begins_with(all.lights, some.lights) &&
         begins_with(all.spheres, some.spheres);
}
inline bool identical(const irradiance_cache::RawRecords& a, const irradiance_cache::RawRecords& b) {
  return begins_with(a, b) && begins_with(b, a) && a.groups == b.groups;
}
/// The records of `all` with light: others may disappear when the camera comes nearer.
inline irradiance_cache::RawRecords lit(irradiance_cache::RawRecords all) {
  std::vector<uint32_t> kept;
  for (uint32_t r = 0; r < all.size(); ++r)
    if (!all.crowded(r)) kept.push_back(r);
  all.keep(kept);
  return all;
}
/// True if `all` begins with the records of `some`, except for their light: places, normals, origins, facets
/// and passes, bit for bit. Their radii may shrink.
inline bool keeps_places(const irradiance_cache::RawRecords& all, const irradiance_cache::RawRecords& some) {
  bool same = all.size() >= some.size();
  for (size_t r = 0; same && r < some.size(); ++r) {
    const vec4 *a = &all.places[r * shared::k_record_texels], *b = &some.places[r * shared::k_record_texels];
    same = std::memcmp(&a[0], &b[0], sizeof(vec3)) == 0 && a[0].w <= b[0].w &&
           std::memcmp(&a[1], &b[1], sizeof(vec3)) == 0 &&
           std::memcmp(&a[2].w, &b[2].w, sizeof(float)) == 0 && all.spheres[r] == vec4(vec3(b[0]), a[0].w);
  }
  return same;
}

}  // namespace lucerna::test
