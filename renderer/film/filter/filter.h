#pragma once
// The filter for pictures: a film -> a film of the same picture with less noise. README.md.
#include <deque>
#include <functional>

#include "film/film.h"
#include "shaders/shared/filter.h"

namespace lucerna::film {

class Filter {
 public:
  /// Compiles its kernels; throws Error, located.
  Filter(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Filters each component of `film`, as its groups of lights are mixed, into `filtered`, a film of the same
  /// size and of one group: its halves are the filtered halves, its samples and surfaces those of `film`.
  /// Pixels with less than two samples stay as they are. `seen`: what surfaces the pixels show, in mirrors
  /// and through glass too, a texel each as shaders/shared/preview.h says; null: not known. `looked_up`:
  /// components (bits) that look records up; what these err by, where the film knows it, is not taken for
  /// light. Runs the stream. Throws Error when memory is short or the film is larger than a storage buffer;
  /// the stream has nothing recorded then.
  void apply(gpu::Stream& stream, const Film& film, Film& filtered, const gpu::Buffer* seen = nullptr,
             uint32_t looked_up = 0);

  /// The same in work items, between which other work may run: begin(), then step() until it returns false.
  /// The films, `seen` and their contents must stay unchanged until then, or until release().
  void begin(const Film& film, Film& filtered, const gpu::Buffer* seen = nullptr, uint32_t looked_up = 0);
  bool step(gpu::Stream& stream);
  /// Cancels the remaining work and frees its memory.
  void release();

 private:
  void plan_component(uint32_t component, Film& filtered);

  gpu::Device& device_;
  gpu::Kernel pack_, tame_, outliers_, noise_, guide_, regress_, judge_, choose_, blend_;
  gpu::Buffer lights_, tamed_, taken_, surfaces_, guides_, fitted_, judged_, chosen_;
  gpu::Resources resources_;
  shared::FilterPush push_{};
  std::deque<std::function<void(gpu::Stream&)>> work_;
};

}  // namespace lucerna::film
