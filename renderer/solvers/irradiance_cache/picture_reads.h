#pragma once
// Importance of records: how much the picture reads each, used to distribute rays. A record's noise adds to
// the picture's squared error its variance times the sum, over all pixels, of the squared share of the record
// in the pixel. Two independent paths are traced through every pixel; the product of the record's shares in
// their two lookups has that square as its mean, whatever mirrors, glass or coatings lie between, and however
// much of the record's disc is hidden.
//
// If records' rays end in other records, the picture also reads these indirectly: a few records in a bright
// room may light all of the dark one next to it. Paths therefore continue by one diffuse event, and the
// shares there count too, scaled by their part of the irradiance at the first lookup.
#include <functional>
#include <vector>

#include "gpu/kernel.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

class PictureReads {
 public:
  static constexpr uint32_t k_most_pixels = 1u << 17;

  /// Room for `capacity` records. `defines`: Cache::defines().
  PictureReads(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t capacity,
               const gpu::Defines& defines);

  /// Starts a picture with that frame, in larger pixels if it has more than k_most_pixels.
  void begin(const shared::Frame& frame);
  void forget() { begun_ = false; }
  bool begun() const { return begun_; }
  bool seen() const { return begun_ && done_ == blocks(); }
  /// Traces the next paths, as many as there are slots. The wavefront must have frame(). `write_frame` writes
  /// the cache frame: with k_probe_reads kernels note their lookups in `candidates`, with k_probe_next the
  /// lookups where the paths continue. `next`: include the latter. False if cancelled.
  bool see(transport::Wavefront& wavefront, const gpu::Buffer& candidates, bool next,
           const std::function<void(uint32_t probing)>& write_frame,
           const std::function<bool()>& cancel = {});
  const shared::Frame& frame() const { return frame_; }

  /// Sum over the pixels of the squared share of each of the first `count` records, in squares of the
  /// picture's height. `bind`: binds lookup.glsl, with the records in the octree. Runs the stream.
  /// Independent of the order of additions.
  std::vector<float> measure(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind,
                             uint32_t count);
  uint64_t bytes() const { return places_.bytes() + next_places_.bytes() + sums_.bytes(); }

 private:
  uint32_t blocks() const;
  uint32_t pixels() const { return 64 * blocks(); }
  gpu::Device& device_;
  gpu::Kernel keeping_, adding_;
  gpu::Buffer places_, next_places_, sums_;
  gpu::Resources resources_;
  shared::Frame frame_{};
  bool begun_ = false, next_ = false;
  uint32_t done_ = 0;  // blocks
};

}  // namespace lucerna::irradiance_cache
