#pragma once
// Data of record lookups (shaders/irradiance_cache/lookup.glsl): records, octree, and the frame of
// parameters.
#include <algorithm>
#include <array>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

/// Largest difference between the normals of a point and its record, as 1 - cos: 20 degrees.
inline constexpr float k_normal_tolerance = 0.06f;
/// Largest distance of points from a record's plane, in its radius: less than the depth of a lamp's panel in
/// a ceiling.
inline constexpr float k_off_plane = 0.03f;
/// Likewise, for records of the minimum radius: for a radius of three pixels, half a pixel.
inline constexpr float k_off_plane_least = 0.16f;

/// Parameters of the minimum radius.
struct LeastRadius {
  vec3 eye{0};
  bool parallel = false;
  float of_distance = 0;  ///< over the distance from `eye`; if `parallel`, in metres
  float most = 0;         ///< [m]
  float at(const vec3& position) const {
    return std::min(of_distance * (parallel ? 1 : distance(position, eye)), most);
  }
  bool operator==(const LeastRadius&) const = default;
};

/// CacheFrame::routes.
using RouteTable = std::array<uint32_t, shared::k_delegated_states>;

/// What an octree will serve. More detail takes longer to build and makes lookups shorter; results are equal.
enum class IndexFor {
  radii,     ///< one lookup a record
  building,  ///< rays of records, and probing
  picture,
};

/// The octree lists the evaluated records, or the first of the placed ones while radii are computed; the
/// frame contains the number of evaluated ones. Neither is updated automatically: code that changes `records`
/// must build the octree and write the frame.
struct LookupTables {
  Records records;
  lookup::Octree octree;
  gpu::Buffer frame;                         ///< CacheFrame
  gpu::Buffer candidates;                    ///< for each slot: the place without a record, or the hit
  RouteTable picture_routes, record_routes;  ///< lookups of the picture's paths, and of the records' rays
  LeastRadius least;

  LookupTables(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
               const CacheOptions& options);
  void bind(gpu::Resources& to) const;
  /// Builds the octree over the first `count` records. Returns the mean number of leaves that list a record.
  double build_octree(transport::Wavefront& wavefront, uint32_t count, IndexFor use);
  /// Writes the frame: `count` records are evaluated; paths write notes by `probing` (shared::k_probe_*),
  /// look up by `routes`, and continue by `branches` where they gather.
  void write_frame(uint32_t count, uint32_t probing, const RouteTable& routes, uint32_t branches = 1);
  shared::CacheFrame frame_for(uint32_t count, uint32_t probing, const RouteTable& routes) const;
  /// Memory of an octree over that many records, including its copy of the records.
  static lookup::OctreeOptions octree_options(uint32_t records);
  static lookup::Discs discs(const Records& records);
  /// True if records' rays end at other records.
  bool records_look_up() const;
  /// Lookups of paths that have passed the picture's lookups and continue like rays of records.
  RouteTable routes_beyond_picture() const;
  /// Largest distance from its plane at which a record of that radius serves [m], as in lookup.glsl.
  float off_plane(const Place& place, float radius) const {
    return radius * (radius <= 1.001f * least.at(place.position) ? k_off_plane_least : k_off_plane);
  }
  uint64_t bytes() const;  ///< of device memory
};

}  // namespace lucerna::irradiance_cache
