#pragma once
// What kernels read when they look a record up (shaders/irradiance_cache/lookup.glsl): the records, the
// octree that finds them, and the frame with the rules.
#include <algorithm>
#include <array>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

/// Most that the normals of a point and of its record may differ, as 1 - cos: 20 degrees.
inline constexpr float k_normal_tolerance = 0.06f;
/// How far off a record's plane, in its radius, points may lie: what a lamp's panel in a ceiling may not.
inline constexpr float k_off_plane = 0.03f;
/// The same of records of the least radius. With one of three pixels: half a pixel.
inline constexpr float k_off_plane_least = 0.16f;

/// What the least radius of records depends on.
struct LeastRadius {
  vec3 eye{0};
  bool parallel = false;
  float of_distance = 0;  ///< of the distance from `eye`; where `parallel`, in metres
  float most = 0;         ///< [m]
  float at(const vec3& position) const {
    return std::min(of_distance * (parallel ? 1 : distance(position, eye)), most);
  }
  bool operator==(const LeastRadius&) const = default;
};

/// CacheFrame::routes.
using RouteTable = std::array<uint32_t, shared::k_delegated_states>;

/// The octree lists records that are evaluated, or a beginning of what is placed while radii are worked out;
/// the frame says how many are evaluated. Neither follows `records` by itself: who changes them builds the
/// octree and writes the frame.
struct LookupTables {
  Records records;
  lookup::Octree octree;
  gpu::Buffer frame;       ///< CacheFrame
  gpu::Buffer candidates;  ///< one a slot: where paths note that they found no record, or what they met
  RouteTable picture_routes, record_routes;  ///< where the picture's paths look up, and the records' rays
  LeastRadius least;

  LookupTables(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
               const CacheOptions& options);
  void bind(gpu::Resources& to) const;
  /// Over the first `count` records. Returns how many leaves list one of them, on average.
  double build_octree(transport::Wavefront& wavefront, uint32_t count);
  /// What paths know of the cache from here on: `count` records are evaluated; paths are to note what
  /// `probing` says (shared::k_probe_*), look up where `routes` says, and go on by so many branches where
  /// they gather.
  void write_frame(uint32_t count, uint32_t probing, const RouteTable& routes, uint32_t branches = 1);
  shared::CacheFrame frame_for(uint32_t count, uint32_t probing, const RouteTable& routes) const;
  /// Of an octree over so many records, and the records as it lists them.
  static lookup::OctreeOptions octree_options(uint32_t records);
  static lookup::Discs discs(const Records& records);
  /// Whether records' rays end in other records.
  bool records_look_up() const;
  /// Where paths look up that have passed the picture's lookups over and go on as the rays of records do.
  RouteTable routes_beyond_picture() const;
  /// How far off its plane a record of that radius serves [m], as lookup.glsl has it.
  float off_plane(const Place& place, float radius) const {
    return radius * (radius <= 1.001f * least.at(place.position) ? k_off_plane_least : k_off_plane);
  }
  uint64_t bytes() const;  ///< of device memory
};

}  // namespace lucerna::irradiance_cache
