#include "session/pixel_sight.h"

#include "base/timer.h"

namespace lucerna::session {

namespace {

/// Maximum number of mirrors and glass surfaces along a ray: two panes seen in a mirror are five.
constexpr uint32_t k_most_turns = 6;

}  // namespace

film::PreviewCamera preview_camera(const shared::Frame& f) {
  return {{f.camera_origin, f.camera_right, f.camera_up, f.camera_forward},
          f.projection,
          vec4(f.section_normal, f.section_offset)};
}

const gpu::Buffer* PixelSight::surfaces(const film::PreviewCamera& camera, uint32_t width,
                                        uint32_t height) const {
  const auto& rays = full_.rays;
  const bool known = rays && rays->seen() && rays->stride() == 1 && rays->width() == width &&
                     rays->height() == height && full_.camera == camera;
  return known ? &rays->surfaces() : nullptr;
}

const gpu::Buffer* PixelSight::surfaces(const Engine& engine, const PictureView& view) const {
  return surfaces(preview_camera(engine.frame(view, view.width, view.height)), view.width, view.height);
}

bool PixelSight::wanted(const Engine& engine, const PictureView& view) const {
  return uint64_t{view.width} * view.height <= overlay::Sight::k_most_points && !surfaces(engine, view);
}

bool PixelSight::see(Engine& engine, const PictureView& view, const std::function<bool()>& cancel) {
  return see(engine, view, engine.frame(view, view.width, view.height), full_, cancel);
}

std::optional<PixelSight::Coarse> PixelSight::see_coarse(Engine& engine, const PictureView& view) {
  if (!full_.rays || defines_ != engine.defines()) return std::nullopt;
  uint32_t step = 2;
  const auto points = [&] { return uint64_t{view.width / step} * (view.height / step); };
  while (step < 4 && double(points()) * point_s_ > k_coarse_s) ++step;
  if (points() == 0 || points() > overlay::Sight::k_most_points) return std::nullopt;
  const shared::Frame frame = engine.frame(view, view.width / step, view.height / step);
  const Timer timer;
  coarse_.camera = {};
  do see(engine, view, frame, coarse_, {});
  while (!coarse_.rays->seen());
  const double pace = timer.seconds() / double(points());
  point_s_ = point_s_ > 0 ? 0.5 * (point_s_ + pace) : pace;
  return Coarse{&coarse_.rays->surfaces(), frame.width, frame.height};
}

bool PixelSight::see(Engine& engine, const PictureView& view, const shared::Frame& of, Grid& grid,
                     const std::function<bool()>& cancel) {
  transport::Wavefront& wavefront = engine.wavefront();
  shared::Frame frame = of;
  const film::PreviewCamera camera = preview_camera(frame);
  if (defines_ != engine.defines() || !look_) {
    full_.rays.reset(), coarse_.rays.reset();
    look_ = gpu::Kernel(device_, compiler_, "film/preview_look.comp", engine.defines());
    note_ = gpu::Kernel(device_, compiler_, "film/preview_sight.comp");
    defines_ = engine.defines();
    point_s_ = 0;
  }
  if (!grid.rays) grid.rays.emplace(device_, compiler_, engine.defines());
  overlay::Sight& rays = *grid.rays;
  if (!rays.begun() || rays.width() != frame.width || rays.height() != frame.height || grid.camera != camera)
    rays.begin(frame, 1);
  grid.camera = camera;
  const auto note = [&](const shared::SeePush& push) {
    wavefront.bind_paths(resources_);
    resources_.set("Surfaces", rays.surfaces());
    wavefront.stream().dispatch(note_, resources_, push, gpu::groups_for(push.count, 64));
  };
  frame.max_depth = k_most_turns;
  wavefront.set_frame(frame, engine.enabled());
  bool complete = true;
  wavefront.uncounted([&] { complete = rays.see(wavefront, "sight", note, cancel, &look_); });
  wavefront.set_frame(engine.frame(view, view.width, view.height), engine.enabled());
  return complete;
}

}  // namespace lucerna::session
