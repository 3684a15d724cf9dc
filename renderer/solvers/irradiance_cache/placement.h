#pragma once
// Which of the places that ask for a record get one: candidates are gathered on the device, put
// in Morton order, cut into clusters, and of each cluster some are drawn until each candidate is covered.
// What is chosen, some thousand places, comes to the host.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/stream.h"
#include "shaders/shared/irradiance_cache/placement.h"
#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

/// How far a candidate stands for others: the greatest of what applies to it.
struct ReachOptions {
  float spacing = 0.1f;      ///< [m]; of what paths ask for
  float spacing_beyond = 0;  ///< [m]; of what other records ask for (k_origin_recursive)
  /// This share of the distance from `eye`, or of 1 m where the view is parallel.
  float spacing_of_distance = 0;
  vec3 eye{0};
  bool parallel = false;
};

struct ChoiceOptions {
  float normal_tolerance =
      0.015f;           ///< a chosen place covers those whose normals differ by no more, as 1 - cos
  uint32_t seed = 1;    ///< of the order in which places are drawn
  uint32_t most = ~0u;  ///< places to choose at most; then every cluster gets its share in turn
};

/// The candidates of a pass and what became of them.
struct Choice {
  std::vector<Place> candidates;  ///< in Morton order, equal codes in the order in which they were collected
  std::vector<uint32_t> cluster;  ///< of each candidate; from 0 on, rising
  std::vector<uint32_t> chosen;   ///< indices of candidates, rising
};

class Placement {
 public:
  /// What is collected of a picture that it has been laid over (discontinuity.h).
  struct Screen {
    const gpu::Buffer &surfaces, &taken, &levels;  ///< surface_texels; 0 or 1 a point; its level
    uint32_t points = 0;
    float pixel = 0;    ///< shared::DetailPush::pixel
    float cell = 0.5f;  ///< what a candidate stands for, of the width of its level's cells
  };

  Placement(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~Placement();
  /// Forgets all candidates.
  void clear();
  uint32_t size() const;  ///< candidates
  uint64_t bytes() const;
  /// Adds the candidates that paths have left in the first `slots` slots of `candidates`
  /// (shared::k_candidate_texels), block by block of 64 pixels with their `samples` paths each, so that the
  /// order does not depend on how many blocks are looked along at once; those that the camera sees straight
  /// only with `screen_too`. Returns of each block how many slots hold one, by shared::k_origin_*, those that
  /// were left out too. The stream is run. Throws Error when there is no memory for them.
  std::vector<std::array<uint32_t, 3>> collect(gpu::Stream& stream, const gpu::Buffer& candidates,
                                               uint32_t slots, uint32_t samples, bool screen_too,
                                               const ReachOptions& reach);
  /// Adds the points that are taken, in raster order; returns how many.
  uint32_t collect(gpu::Stream& stream, const Screen& screen, const ReachOptions& reach);
  /// For tests: adds these, whose reach is set.
  void add(gpu::Stream& stream, std::span<const Place> places);
  /// In Morton order; the same for the same candidates on any device. A place covers those of its cluster
  /// that are no farther than both reaches. The stream is run.
  std::vector<Place> choose(gpu::Stream& stream, const ChoiceOptions& options);
  /// As choose() has last seen the candidates; before, those there are in the order in which they were
  /// collected, without clusters. Reads them from the device.
  Choice choice() const;
  uint32_t clusters() const;  ///< of the last choice; 0 before

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct ThinningOptions {
  /// Of its radius: where a record that is kept makes others superfluous. The less, the more overlap.
  float share = 0.6f;
  float normal_tolerance = 0.015f;  ///< as the lookup has it
  /// Records that other records' rays ask for (k_origin_recursive) go where they are narrower [m]: rays go on
  /// there, for less than it takes to cover what is narrow.
  float least_beyond = 0;
};

/// Of records whose radii are known those that are needed, the widest first: indices in rising order. A
/// record goes when another that is kept would serve its place with a weight of at least 1 - share. On the
/// host: it is a decision after the other, over what has been chosen.
/// `off_planes`: how far off the plane between its own and a place's tangent plane each serves [m].
std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               std::span<const float> off_planes, const ThinningOptions& options);

}  // namespace lucerna::irradiance_cache
