#pragma once
// Evaluates records: rays over their hemispheres through the wavefront, summed to irradiance, gradients and
// distances.
#include <functional>
#include <memory>
#include <span>

#include "gpu/kernel.h"
#include "paths/automaton.h"
#include "solvers/irradiance_cache/records.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

struct EvaluateOptions {
  /// Strata of the hemisphere; their product is the rays of a level, at most the wavefront's slots and 4096.
  /// Four times as many azimuths as elevations make the cells about as wide as high.
  uint32_t elevations = 8, azimuths = 32;
  uint32_t rays_before =
      0;  ///< that these records have had in earlier levels; their result then weighs by its rays
  uint32_t parts =
      0b1110;  ///< bit p: shared::k_part_* p is gathered; they must be enabled in the wavefront's frame
  /// Their tertiary light is another solver's lookups': rays go in the states of paths that lookups have left
  /// alone, where that one brings it.
  bool elsewhere = false;
  uint32_t seed = 1;
  /// Says, too, how wide ellipses by the records' pilots may be for what these rays have met: of a first
  /// level.
  bool near = false;
  /// Of records that crowd: where light comes from takes the place of irradiance
  /// (irradiance_cache/guide.comp).
  bool guides = false;
};

class Evaluator {
 public:
  /// Of a record at once: lavapipe ends all loops of an invocation after 65535 iterations in all, without a
  /// word, and gather.comp takes up to 12 a ray.
  static constexpr uint32_t k_most_rays = 4096;
  /// `slots`: of the wavefronts that it will be used with. `groups`: of lights, that their paths keep in
  /// short and the records it will be used with keep (Records).
  Evaluator(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, uint32_t groups = 1);
  ~Evaluator();
  /// Evaluates the listed records (indices), a batch of the wavefront's slots at a time; `cancel` is asked
  /// between bounces. Returns how many of the list are done: they, and only they, are changed. The
  /// wavefront's frame must be that of the scene, with the parts' components enabled; its picture does not
  /// matter.
  size_t evaluate(transport::Wavefront& wavefront, const paths::Automaton& automaton, Records& records,
                  std::span<const uint32_t> list, const EvaluateOptions& options,
                  const std::function<bool()>& cancel = {});

  /// Only how far things are around the listed records: harmonic mean and least distance, from
  /// k_distance_rays rays each. Otherwise as evaluate().
  size_t measure(transport::Wavefront& wavefront, Records& records, std::span<const uint32_t> list,
                 uint32_t seed, const std::function<bool()>& cancel = {});
  static constexpr uint32_t k_distance_rays = 64, k_distance_elevations = 4;
  /// The same, and how the irradiance bends there (k_record_texels, texel 4): from rays that evaluate() never
  /// uses, so that what is decided by them does not depend on the light that it brings.
  size_t pilot(transport::Wavefront& wavefront, const paths::Automaton& automaton, Records& records,
               std::span<const uint32_t> list, const EvaluateOptions& options,
               const std::function<bool()>& cancel = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
