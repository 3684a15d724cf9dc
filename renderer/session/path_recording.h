#pragma once
// Records paths of the present picture (recording/recording.h), with the names of what they meet.
#include <functional>
#include <optional>
#include <vector>

#include "recording/recording.h"
#include "session/engine.h"
#include "transport/path_recorder.h"

namespace lucerna::session {

/// Which samples of which pixels are recorded.
struct PathSelection {
  uint32_t left = 0, top = 0, right = 0, bottom = 0;  ///< pixels; right and bottom are excluded
  uint32_t first_sample = 0, samples = 1;
  uint32_t every = 1;  ///< every n-th of them
};
/// The selected paths, clipped to the picture, in parts: pixel by pixel in raster order, samples in theirs.
class PathChoices {
 public:
  PathChoices(const PathSelection& selection, uint32_t width, uint32_t height);
  uint64_t count() const { return (all_ + every_ - 1) / every_; }
  bool done() const { return next_ >= all_; }
  std::vector<shared::PathChoice> take(size_t most);

 private:
  PathSelection of_;
  uint32_t width_;
  uint64_t every_, all_ = 0, next_ = 0;  ///< in all, without `every`
};
std::vector<shared::PathChoice> choices_of(const PathSelection& selection, uint32_t width, uint32_t height);

/// The pixel at a place of the picture, 0..1 to the right and down.
uvec2 pixel_at(const vec2& place, uint32_t width, uint32_t height);

class PathRecording {
 public:
  /// Kernels are compiled on first use. Both must outlive it.
  PathRecording(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

  /// A recording without paths, with the size of the picture and all names.
  recording::Recording begin(const PictureView& picture) const;
  /// Appends these paths. `events_per_path`: room for each. Throws Error: kernels do not compile, memory.
  /// False if cancelled: then some are missing. The engine's frame is the picture's afterwards.
  bool record(Engine& engine, const PictureView& picture, std::span<const shared::PathChoice> choices,
              recording::Recording& into, const std::function<bool()>& cancel = {},
              uint32_t events_per_path = transport::PathRecorder::k_events);

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::optional<transport::PathRecorder> recorder_;
  uint32_t events_per_path_ = 0;
};

}  // namespace lucerna::session
