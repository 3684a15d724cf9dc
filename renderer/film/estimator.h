#pragma once
// Estimates the noise in the blocks of a film from its halves (shaders/film/error.comp), into film.errors().
#include <optional>

#include "film/error.h"

namespace lucerna::film {

/// Records on the caller's streams. The caller runs them before the next call and accounts for the stages
/// "ledger" and "stopping".
class ErrorEstimator {
 public:
  /// `lookup_errors`: the film may have errors of lookups (Film::complete_lookup_errors, lookup_bias_known).
  /// Compiles its kernels; throws Error, located.
  ErrorEstimator(gpu::Device& device, gpu::ShaderCompiler& compiler, bool lookup_errors);

  /// Estimates all blocks, of the layers by path expressions too, whose kernel is compiled with the first.
  /// `seen`: visible range of luminance. Throws Error like the constructor.
  void estimate(gpu::Stream& stream, const Film& film, const SeenRange& seen);
  /// Estimates only these blocks, and only the fields that relative_error() reads; the rest stays.
  void estimate_stopping(gpu::Stream& stream, std::span<const shared::WorkBlock> blocks, const Film& film,
                         const SeenRange& seen);

 private:
  void record(gpu::Stream& stream, const gpu::Kernel& kernel, std::span<const shared::WorkBlock> blocks,
              const Film& film, const SeenRange& seen, const char* stage);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel error_, stopping_;
  std::optional<gpu::Kernel> layers_;
  gpu::Buffer blocks_;
  gpu::Resources resources_;
};

}  // namespace lucerna::film
