#pragma once
// The picture filter: makes a film of the same picture with less noise. Method: README.md.
#include <deque>
#include <functional>

#include "film/film.h"
#include "shaders/shared/filter.h"

namespace lucerna::film {

class Filter {
 public:
  /// Compiles its kernels; throws Error, located.
  Filter(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Filters each component of `film`, with its mix of light groups, into `filtered`, a film of the same size
  /// with one group: halves are the filtered halves; samples and surfaces are those of `film`. Pixels with
  /// less than two samples are unchanged. `seen`: visible surfaces of the pixels, also in mirrors and through
  /// glass, one texel each (shaders/shared/preview.h); null: unknown. `looked_up`: components (bits) that
  /// look up stored light; its errors, if the film has them, do not count as light. Runs the stream. Throws
  /// Error, with nothing recorded on the stream, if memory is short or the film is larger than a storage
  /// buffer.
  void apply(gpu::Stream& stream, const Film& film, Film& filtered, const gpu::Buffer* seen = nullptr,
             uint32_t looked_up = 0);

  /// Likewise, in work items, between which other work may run: begin(), then step() until it returns false.
  /// The films, `seen` and their contents must stay unchanged until then, or until release().
  void begin(const Film& film, Film& filtered, const gpu::Buffer* seen = nullptr, uint32_t looked_up = 0);
  bool step(gpu::Stream& stream);
  /// Cancels the remaining work and frees its memory.
  void release();

 private:
  void plan_component(uint32_t component, Film& filtered);

  gpu::Device& device_;
  // The first regression compares pixels by guides, later ones by the light that they fit.
  gpu::Kernel pack_, spread_, tame_, outliers_, noise_, guide_, regress_, regress_again_, judge_, choose_,
      blend_;
  gpu::Buffer lights_, tamed_, taken_, surfaces_, guides_, fitted_, judged_, chosen_;
  gpu::Resources resources_;
  shared::FilterPush push_{};
  std::deque<std::function<void(gpu::Stream&)>> work_;
};

}  // namespace lucerna::film
