#pragma once
// Chooses the candidates that become records. Candidates are collected on the device, sorted in Morton order
// and cut into clusters; from each cluster places are drawn until every candidate is covered. The host reads
// only the chosen places, some thousands.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/stream.h"
#include "shaders/shared/irradiance_cache/placement.h"
#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

/// Reach of a candidate: the maximum of these.
struct ReachOptions {
  float spacing = 0.1f;      ///< [m]; of candidates from paths
  float spacing_beyond = 0;  ///< [m]; of candidates from other records' rays (k_origin_recursive)
  /// Fraction of the distance from `eye`, or of 1 m if the view is parallel.
  float spacing_of_distance = 0;
  vec3 eye{0};
  bool parallel = false;
};

struct ChoiceOptions {
  float normal_tolerance = 0.015f;  ///< largest difference of normals that a chosen place covers, as 1 - cos
  uint32_t seed = 1;                ///< of the random order of drawing
  uint32_t most = ~0u;  ///< maximum number of places; if exceeded, clusters get their share in turn
};

/// Candidates of a pass and the choice among them.
struct Choice {
  std::vector<Place> candidates;  ///< in Morton order; equal codes in order of collection
  std::vector<uint32_t> cluster;  ///< cluster of each candidate, rising from 0
  std::vector<uint32_t> chosen;   ///< indices of candidates, rising
};

class Placement {
 public:
  /// Points of the screen-space stage to collect (discontinuity.h).
  struct Screen {
    const gpu::Buffer &surfaces, &taken,
        &levels;  ///< surface_texels; 0 or 1 for each point; level of each point
    uint32_t points = 0;
    float pixel = 0;    ///< shared::DetailPush::pixel
    float cell = 0.5f;  ///< reach of a candidate, in cells of its level
  };

  Placement(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~Placement();
  /// Removes all candidates.
  void clear();
  uint32_t size() const;  ///< number of candidates
  uint64_t bytes() const;
  /// Adds the candidates that paths have left in the first `slots` slots of `candidates`
  /// (shared::k_candidate_texels), block by block of 64 pixels with `samples` paths each, so the order does
  /// not depend on the number of blocks in one call. Candidates at directly visible surfaces only with
  /// `screen_too`. Returns for each block the number of slots with a candidate by shared::k_origin_*,
  /// including skipped ones. Runs the stream. Throws Error: memory.
  std::vector<std::array<uint32_t, 3>> collect(gpu::Stream& stream, const gpu::Buffer& candidates,
                                               uint32_t slots, uint32_t samples, bool screen_too,
                                               const ReachOptions& reach);
  /// Adds the points that are taken, in raster order; returns their number.
  uint32_t collect(gpu::Stream& stream, const Screen& screen, const ReachOptions& reach);
  /// For tests: adds these, whose reach is set.
  void add(gpu::Stream& stream, std::span<const Place> places);
  /// Returns places in Morton order; the same for the same candidates on any device. A place covers those of
  /// its cluster within both reaches. Runs the stream.
  std::vector<Place> choose(gpu::Stream& stream, const ChoiceOptions& options);
  /// Candidates as of the last choose(); before it, in order of collection and without clusters. Reads them
  /// from the device.
  Choice choice() const;
  uint32_t clusters() const;  ///< of the last choice; 0 before

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct ThinningOptions {
  /// Fraction of its radius within which a kept record removes others. Smaller: more overlap.
  float share = 0.6f;
  float normal_tolerance = 0.015f;  ///< as in lookups
  /// Records for other records' rays (k_origin_recursive) are dropped if narrower [m]: tracing rays on costs
  /// less than covering narrow geometry.
  float least_beyond = 0;
};

/// Indices, rising, of the records to keep, widest first: a record is dropped if a kept one would serve its
/// place with a weight of at least 1 - share. Runs on the host, because decisions are sequential.
/// `off_planes`: largest served distance of each record from the plane midway between its own and a place's
/// tangent plane [m].
std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               std::span<const float> off_planes, const ThinningOptions& options);

}  // namespace lucerna::irradiance_cache
