#pragma once
// The filter for finished pictures: a film -> a film of the same picture with less noise. README.md.
#include "film/film.h"
#include "shaders/shared/filter.h"

namespace lucerna::film {

class Filter {
 public:
  /// Compiles its kernels; throws Error, located.
  Filter(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Filters each component of `film`, as its groups of lights are mixed, into `filtered`, a film of the same
  /// size and of one group: its halves are the filtered halves, its samples and surfaces those of `film`.
  /// Pixels with less than two samples stay as they are. Runs the stream. Throws Error when memory is short
  /// or the film is larger than a storage buffer.
  void apply(gpu::Stream& stream, const Film& film, Film& filtered);

 private:
  gpu::Device& device_;
  gpu::Kernel pack_, tame_, outliers_, noise_, guide_, regress_, judge_, choose_, blend_;
  gpu::Buffer lights_, tamed_, taken_, surfaces_, guides_, fitted_, judged_, chosen_;
  gpu::Resources resources_;
};

}  // namespace lucerna::film
