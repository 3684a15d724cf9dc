#include "overlay/sight.h"

#include <algorithm>

namespace lucerna::overlay {

using namespace shared;

Sight::Sight(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines defines)
    : device_(device), compiler_(compiler), defines_(std::move(defines)) {}

void Sight::begin(const Frame& frame, uint32_t texels) {
  begun_ = false;
  width_ = frame.width, height_ = frame.height;
  parallel_ = frame.projection == k_projection_orthographic;
  for (stride_ = 1;; ++stride_) {
    across_ = (width_ + stride_ - 1) / stride_, down_ = (height_ + stride_ - 1) / stride_;
    if (uint64_t{across_} * down_ <= k_most_points) break;
  }
  pixel_ = 2 * glm::length(frame.camera_up) / float(frame.height) * float(stride_);
  done_ = 0;
  gpu::make_texel_room(device_, surfaces_, "surfaces of the picture",
                       uint64_t{points()} * texels * sizeof(vec4));
  begun_ = true;
}

bool Sight::see(transport::Wavefront& wavefront, const char* stage,
                const std::function<void(const SeePush&)>& note, const std::function<bool()>& cancel,
                const gpu::Kernel* vertex) {
  if (!centre_) centre_ = gpu::Kernel(device_, compiler_, "overlay/centre.comp", defines_);
  const SeePush push{done_, std::min(points() - done_, wavefront.slots()), across_, down_, stride_};
  wavefront.bind_paths(resources_);
  const auto begin = [&] {
    wavefront.stream().dispatch(centre_, resources_, push, gpu::groups_for(push.count, 64), stage);
  };
  const transport::PathEnds ends{
      .begin = begin, .first_hits = {}, .end = [&] { note(push); }, .vertex = vertex, .vertex_stage = stage};
  if (!wavefront.run(push.count, ends, cancel)) return false;
  done_ += push.count;
  return true;
}

void Sight::set(const std::vector<vec4>& surfaces) {
  surfaces_.write(std::span<const vec4>(surfaces));
  done_ = points();
}

}  // namespace lucerna::overlay
