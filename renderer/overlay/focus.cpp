#include "overlay/focus.h"

#include <algorithm>
#include <limits>

#include "scene/scene.h"

namespace lucerna::overlay {

using namespace shared;

DepthOfField depth_of_field(const Frame& frame) {
  if (frame.lens_radius == 0) return {};
  // On the film, at the focal length, a point at depth z has a blur of diameter f * 2 r |1/z - 1/focus|.
  const float focal_length = 0.5f * scene::k_film_width / glm::length(frame.camera_right);
  const float allowed = k_sharp_blur / (2 * frame.lens_radius * focal_length), at = 1 / frame.focus_distance;
  return {.nearest = 1 / (at + allowed), .farthest = at > allowed ? 1 / (at - allowed) : k_infinity};
}

void FocusPainter::draw(const Canvas& canvas, const Frame& frame) {
  if (!kernel_) kernel_ = gpu::Kernel(device_, compiler_, "overlay/focus.comp");
  const DepthOfField sharp = depth_of_field(frame);
  canvas.bind(resources_);
  resources_.set("Picture", canvas.picture());
  canvas.stream().dispatch(
      kernel_, resources_,
      OverlayFocusPush{canvas.width(), canvas.height(), frame.focus_distance, sharp.nearest,
                       std::min(sharp.farthest, std::numeric_limits<float>::max()), k_focus_line,
                       k_sharp_tint},
      gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
}

}  // namespace lucerna::overlay
