#pragma once
// Traces chosen samples of pixels again and records their events (shaders/shared/path_events.h).
//
// A recorded path is the path of that sample: same random numbers, same kernels with the sink compiled in.
// The picture's kernels and film are not touched. Light that a solver computes again for each sample (photons
// in rounds, light tracing) and learned light selection are those of the moment of recording.
#include <functional>
#include <span>
#include <vector>

#include "shaders/shared/path_events.h"
#include "transport/wavefront.h"

namespace lucerna::transport {

/// The events of one path, in the order of their numbers.
struct RecordedPath {
  shared::PathChoice of;
  std::span<const shared::PathEvent> events;
  uint32_t lost = 0;  ///< events for which there was no room; their light is missing
};

class PathRecorder {
 public:
  static constexpr uint32_t k_events = 128;  ///< room per path

  /// `path_defines`: of the wavefront's kernels for vertices. Throws Error, located: a kernel does not
  /// compile.
  PathRecorder(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& path_defines,
               uint32_t events_per_path = k_events);
  const gpu::Defines& path_defines() const { return path_defines_; }

  /// Traces the paths in batches and calls `sink` with each, in their order. `frame`: that of the wavefront's
  /// set_frame(). `far`: distance at which background is placed [m]. The wavefront's stats() are unchanged.
  /// False if cancelled.
  bool record(Wavefront& wavefront, const shared::Frame& frame, std::span<const shared::PathChoice> choices,
              float far, const std::function<void(const RecordedPath&)>& sink,
              const std::function<bool()>& cancel = {});

 private:
  /// Of cameras with a lens, with a section plane.
  const gpu::Kernel& camera(const shared::Frame& frame);
  bool record_batch(Wavefront& wavefront, const gpu::Kernel& camera,
                    std::span<const shared::PathChoice> choices,
                    const std::function<void(const RecordedPath&)>& sink,
                    const std::function<bool()>& cancel);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines path_defines_, defines_;  ///< without and with the sink
  uint32_t events_per_path_;
  std::array<gpu::Kernel, 4> cameras_;
  gpu::Kernel shade_, shadow_;
  gpu::Buffer block_, choices_, states_, events_;
};

}  // namespace lucerna::transport
