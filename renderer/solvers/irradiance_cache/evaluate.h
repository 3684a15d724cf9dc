#pragma once
// Evaluates records: traces rays over their hemispheres and computes irradiance, gradients and distances.
#include <functional>
#include <memory>
#include <span>

#include "gpu/kernel.h"
#include "paths/automaton.h"
#include "solvers/irradiance_cache/records.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

struct EvaluateOptions {
  /// Strata of the hemisphere; their product is the number of rays of a level, at most the wavefront's slots
  /// and 4096. With four times as many azimuths as elevations, cells are about as wide as high.
  uint32_t elevations = 8, azimuths = 32;
  uint32_t rays_before = 0;  ///< rays of earlier levels, which weigh the earlier results
  uint32_t parts =
      0b1110;  ///< bit p: shared::k_part_* p is gathered; must be enabled in the wavefront's frame
  /// Another solver provides their tertiary light: rays start in the fallback states, which read it.
  bool elsewhere = false;
  uint32_t seed = 1;
  /// First level only: also bounds the widths of the ellipses by the hit distances of these rays.
  bool near = false;
  /// For crowded records: stores guide tables instead of irradiance (irradiance_cache/guide.comp).
  bool guides = false;
};

class Evaluator {
 public:
  /// Maximum rays of a record at once, and iterations of gather.comp for each. Lavapipe silently ends all
  /// loops of an invocation after k_most_iterations.
  static constexpr uint32_t k_most_rays = 4096, k_ray_iterations = 12, k_most_iterations = 65535;
  static_assert(k_most_rays * k_ray_iterations < k_most_iterations);
  /// `slots`: of the wavefronts used with it. `groups`: light groups of their paths and of the records
  /// (Records).
  Evaluator(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, uint32_t groups = 1);
  ~Evaluator();
  /// Evaluates the listed records (indices), one batch of the wavefront's slots at a time; calls `cancel`
  /// between bounces. Returns how many of the list are done; only these are changed. The wavefront's frame
  /// must be of the scene and enable the parts' components; its picture does not matter.
  size_t evaluate(transport::Wavefront& wavefront, const paths::Automaton& automaton, Records& records,
                  std::span<const uint32_t> list, const EvaluateOptions& options,
                  const std::function<bool()>& cancel = {});

  /// Measures only distances around the listed records: harmonic mean and minimum, from k_distance_rays rays
  /// each. Otherwise as evaluate().
  size_t measure(transport::Wavefront& wavefront, Records& records, std::span<const uint32_t> list,
                 uint32_t seed, const std::function<bool()>& cancel = {});
  static constexpr uint32_t k_distance_rays = 64, k_distance_elevations = 4;
  /// Also computes the Hessian of the irradiance (k_record_texels, texel 4), from rays that evaluate() never
  /// uses, so that decisions do not correlate with the result of evaluate().
  size_t pilot(transport::Wavefront& wavefront, const paths::Automaton& automaton, Records& records,
               std::span<const uint32_t> list, const EvaluateOptions& options,
               const std::function<bool()>& cancel = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
