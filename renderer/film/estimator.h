#pragma once
// What the halves of a film say of the noise in its blocks (shaders/film/error.comp), into film.errors().
#include "film/error.h"

namespace lucerna::film {

/// Records on streams of others and leaves it to them to run these, and to account for the stages "ledger"
/// and "stopping": once before it is called again.
class ErrorEstimator {
 public:
  /// `lookup_errors`: light may be looked up, so that pixels may know what that is wrong by
  /// (Film::complete_record_errors, lookup_bias_known). Compiles its kernels; throws Error, located.
  ErrorEstimator(gpu::Device& device, gpu::ShaderCompiler& compiler, bool lookup_errors);

  /// Of all blocks. `seen`: what of them is seen.
  void estimate(gpu::Stream& stream, const Film& film, const SeenRange& seen);
  /// Of these blocks alone, and only what relative_error() reads; the rest of film.errors() stays.
  void estimate_stopping(gpu::Stream& stream, std::span<const shared::WorkBlock> blocks, const Film& film,
                         const SeenRange& seen);

 private:
  void record(gpu::Stream& stream, const gpu::Kernel& kernel, std::span<const shared::WorkBlock> blocks,
              const Film& film, const SeenRange& seen, const char* stage);

  gpu::Device& device_;
  gpu::Kernel error_, stopping_;
  gpu::Buffer blocks_;
  gpu::Resources resources_;
};

}  // namespace lucerna::film
