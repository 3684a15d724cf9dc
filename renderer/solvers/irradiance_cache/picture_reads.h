#pragma once
// How much of the picture reads each record, by which rays are shared out among them: what a record's noise
// makes of the picture's squared error is the variance times the sum over all pixels of the square of the
// share that the record has in them. Two independent paths are sent through every pixel; where both look up,
// the product of the record's shares in the two lookups is, on average, that square: whatever mirrors, glass
// or a coat's reflection lie between, and however much of a record's disc is hidden.
//
// Where records' rays end in other records these are read by the picture too, once removed: a few records in
// a bright room next door may light all of a dark one. So the paths go on by one diffuse event, and the
// shares of records there count as well, by how much of the irradiance at the first lookup they are to bring.
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

  /// Forgets what was seen: the picture is to be that of `frame`, in larger pixels where there are more than
  /// k_most_pixels.
  void begin(const shared::Frame& frame);
  void forget() { begun_ = false; }
  bool begun() const { return begun_; }
  bool seen() const { return begun_ && done_ == blocks(); }
  /// Sends the next paths, as many as there are slots. The wavefront's frame is to be frame(). `write_frame`
  /// writes the cache frame: with k_probe_reads kernels note in `candidates` where they look up, with
  /// k_probe_next where the paths go on to. `next`: that counts too. False when it was cancelled.
  bool see(transport::Wavefront& wavefront, const gpu::Buffer& candidates, bool next,
           const std::function<void(uint32_t probing)>& write_frame,
           const std::function<bool()>& cancel = {});
  const shared::Frame& frame() const { return frame_; }

  /// Of the first `count` records the sum over the pixels of the squared share, in squares of the picture's
  /// height. `bind`: what lookup.glsl reads, with the records in the octree. The stream is run. The same
  /// whatever the order in which invocations add.
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
