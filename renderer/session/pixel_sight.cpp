#include "session/pixel_sight.h"

namespace lucerna::session {

namespace {

/// Maximum number of mirrors and glass surfaces along a ray: two panes seen in a mirror are five.
constexpr uint32_t k_most_turns = 6;

}  // namespace

film::PreviewCamera preview_camera(const shared::Frame& f) {
  return {{f.camera_origin, f.camera_right, f.camera_up, f.camera_forward}, f.orthographic != 0};
}

const gpu::Buffer* PixelSight::surfaces(const Engine& engine, const PictureView& view) const {
  const bool known = rays_ && rays_->seen() && rays_->stride() == 1 && rays_->width() == view.width &&
                     rays_->height() == view.height &&
                     camera_ == preview_camera(engine.frame(view, view.width, view.height));
  return known ? &rays_->surfaces() : nullptr;
}

bool PixelSight::wanted(const Engine& engine, const PictureView& view) const {
  return uint64_t{view.width} * view.height <= overlay::Sight::k_most_points && !surfaces(engine, view);
}

bool PixelSight::see(Engine& engine, const PictureView& view, const std::function<bool()>& cancel) {
  transport::Wavefront& wavefront = engine.wavefront();
  shared::Frame frame = engine.frame(view, view.width, view.height);
  const film::PreviewCamera camera = preview_camera(frame);
  if (!rays_ || defines_ != engine.defines()) {
    rays_.emplace(device_, compiler_, engine.defines());
    look_ = gpu::Kernel(device_, compiler_, "film/preview_look.comp", engine.defines());
    note_ = gpu::Kernel(device_, compiler_, "film/preview_sight.comp");
    defines_ = engine.defines();
  }
  if (!rays_->begun() || rays_->width() != view.width || rays_->height() != view.height || camera_ != camera)
    rays_->begin(frame, 1);
  camera_ = camera;
  const auto note = [&](const shared::SeePush& push) {
    wavefront.bind_paths(resources_);
    resources_.set("Surfaces", rays_->surfaces());
    wavefront.stream().dispatch(note_, resources_, push, gpu::groups_for(push.count, 64));
  };
  frame.max_depth = k_most_turns;
  wavefront.set_frame(frame, engine.plan().enabled());
  bool complete = true;
  wavefront.uncounted([&] { complete = rays_->see(wavefront, "sight", note, cancel, &look_); });
  wavefront.set_frame(engine.frame(view, view.width, view.height), engine.plan().enabled());
  return complete;
}

}  // namespace lucerna::session
