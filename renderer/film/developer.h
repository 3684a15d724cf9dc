#pragma once
// Develops a film: its picture of 8-bit sRGB, tone-mapped or as a heat map, with the state of the tiles over
// it.
#include <map>

#include "film/film.h"

namespace lucerna::film {

class Developer {
 public:
  /// Compiles its kernels; throws Error, located.
  Developer(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Film -> its picture. `coarse` fills pixels without samples, if given (it is tone-mapped first). Runs the
  /// stream; what it takes is nobody's stage.
  void tone_map(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse = nullptr);
  /// The film's picture of all components as its groups of lights are mixed (Film::set_mix), of what it
  /// keeps to show that at once (Film::quick). Compiles its kernel, unless prepare_mix() has. Runs the
  /// stream.
  void mix(gpu::Stream& stream, const Film& film, const View& view);
  /// So that the first mix does not wait for a compiler. Does nothing where it has been done, and where the
  /// film is not Film::quick(). Runs the stream. Throws Error, located.
  void prepare_mix(gpu::Stream& stream, const Film& film, const View& view);
  /// Draws over a picture the state of the film's tiles, where the view has any. `scale`: pixels of that
  /// picture per pixel of the film, along a side; lines are one pixel of it wide. Runs the stream.
  void draw_tiles(gpu::Stream& stream, const Film& film, const View& view, const gpu::Buffer& picture,
                  uint32_t scale);

 private:
  void develop(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse);

  gpu::Kernel& mix_kernel(const Film& film, const View& view);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel tonemap_, heat_, tiles_;
  std::map<std::pair<bool, uint32_t>, gpu::Kernel> mixes_;  ///< by Film::is_compact and curve
  gpu::Buffer no_coarse_;
  gpu::Resources resources_;
};

}  // namespace lucerna::film
