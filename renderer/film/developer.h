#pragma once
// Develops a film: its 8-bit sRGB picture, tone-mapped or as a heat map, with the state of the tiles over it.
#include <map>

#include "film/film.h"

namespace lucerna::film {

class Developer {
 public:
  /// Compiles its kernels; throws Error, located.
  Developer(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Tone-maps the film, by the view's display_lut if it has one. `coarse`: fills pixels without samples, if
  /// given (it is tone-mapped first). Runs the stream; its time belongs to no stage.
  void tone_map(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse = nullptr);
  /// Picture of all components with the mix of light groups (Film::set_mix), by the view's tone curve, from
  /// the data for immediate display (Film::quick). Compiles its kernel unless prepare_mix() has. Runs the
  /// stream.
  void mix(gpu::Stream& stream, const Film& film, const View& view);
  /// Compiles the kernel of mix(), so that the first mix does not wait. Does nothing if already done or if
  /// the film is not Film::quick(). Runs the stream. Throws Error, located.
  void prepare_mix(gpu::Stream& stream, const Film& film, const View& view);
  /// Draws the state of the film's tiles over a picture, if the view shows it. `scale`: pixels of that
  /// picture per pixel of the film, along a side; lines are one of its pixels wide. Runs the stream.
  void draw_tiles(gpu::Stream& stream, const Film& film, const View& view, const gpu::Buffer& picture,
                  uint32_t scale);

 private:
  void develop(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse);
  gpu::Kernel& tonemap_kernel(const View& view);

  gpu::Kernel& mix_kernel(const Film& film, const View& view);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel tonemap_, heat_, tiles_;
  /// For views of layers by path expressions, and with a display_lut; compiled at the first use.
  std::map<std::pair<bool, bool>, gpu::Kernel> tonemaps_;
  std::map<std::pair<bool, uint32_t>, gpu::Kernel> mixes_;  ///< by Film::is_compact and curve
  gpu::Buffer no_coarse_;
  gpu::Resources resources_;
};

}  // namespace lucerna::film
