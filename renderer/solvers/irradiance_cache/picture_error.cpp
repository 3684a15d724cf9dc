#include "solvers/irradiance_cache/picture_error.h"

#include <algorithm>

#include "shaders/shared/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_propagating = "records' error";
constexpr uint32_t k_error_paths = 2;  ///< per pixel

/// Frame of a picture whose pixels are `side` film pixels wide, and may extend over the right and lower
/// border.
Frame coarser(Frame f, uint32_t side) {
  const uint32_t across = (f.width + side - 1) / side, down = (f.height + side - 1) / side;
  const float x = float(across * side) / float(f.width), y = float(down * side) / float(f.height);
  const vec3 shift = (x - 1) * f.camera_right - (y - 1) * f.camera_up;
  const bool wide = f.projection >= k_projection_panorama;
  f.width = across, f.height = down;
  // Angles count from the axis, so the border cannot move alone. Pixels become a little narrower instead:
  // errors are then estimated up to one of these pixels aside.
  if (wide) return f;
  if (f.projection == k_projection_orthographic)
    f.camera_origin += shift;
  else
    f.camera_forward += shift;
  f.camera_right *= x, f.camera_up *= y;
  return f;
}

uint32_t side_for(const Frame& f) {
  uint32_t side = 1;
  while (side < k_block && uint64_t{f.width} * f.height > uint64_t{PictureError::k_most_pixels} * side * side)
    side *= 2;
  return side;
}

}  // namespace

PictureError::PictureError(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines)
    : device_(device),
      leave_one_out_(device, compiler, "irradiance_cache/leave_one_out.comp", defines),
      propagating_(device, compiler, "irradiance_cache/propagate_errors.comp", defines) {}

void PictureError::leave_one_out(const Work& w) {
  if (residuals_.bytes() > 0 && residuals_for_ == w.records) return;
  gpu::make_texel_room(device_, residuals_, "residuals of records",
                       uint64_t{std::max(w.records, 1u)} * k_residual_texels * sizeof(vec4));
  w.bind(resources_);
  resources_.set("Residuals", residuals_);
  w.wavefront.stream().dispatch(leave_one_out_, resources_, PoolPush{0, w.records},
                                gpu::groups_for(w.records, 64), k_propagating);
  residuals_for_ = w.records;
}

bool PictureError::step(const Work& w) {
  w.film.make_room_for_lookup_errors();
  leave_one_out(w);
  const uint32_t side = side_for(w.frame);
  const Frame frame = coarser(w.frame, side);
  const uint32_t blocks = (frame.width + k_block - 1) / k_block * ((frame.height + k_block - 1) / k_block);
  const uint32_t end = std::min(blocks, done_ + std::max(1u, w.wavefront.slots() / (64 * k_error_paths)));
  w.wavefront.set_frame(frame, w.enabled);
  const bool complete = propagate(w, side, end);
  w.write_frame(k_probe_none);
  w.wavefront.set_frame(w.frame, w.enabled);
  if (!complete) return false;
  done_ = end;
  if (done_ == blocks) w.film.complete_lookup_errors();
  return true;
}

bool PictureError::propagate(const Work& w, uint32_t side, uint32_t end) {
  schedule::WorkItem item{{}, k_error_paths};
  for (uint32_t b = done_; b < end; ++b) item.blocks.push_back({b, 0});
  gpu::Stream& stream = w.wavefront.stream();
  gpu::make_texel_room(device_, first_, "first lookups", w.candidates.bytes());
  for (const uint32_t probing : {k_probe_errors, k_probe_errors_beyond}) {
    if (probing == k_probe_errors_beyond && !w.recursive) continue;
    stream.fill(w.candidates, 0);
    w.write_frame(probing);
    if (!w.wavefront.probe(item, w.cancel)) return false;
    if (probing == k_probe_errors && w.recursive) stream.copy(w.candidates, first_, w.candidates.bytes());
  }
  gpu::make_room(
      device_, blocks_,
      {.name = "blocks", .bytes = item.blocks.size() * sizeof(WorkBlock), .memory = gpu::Memory::host});
  blocks_.write(std::span<const WorkBlock>(item.blocks));
  w.bind(resources_);
  w.film.bind(resources_);
  resources_.set("WorkBlocks", blocks_);
  resources_.set("candidate_texels", w.recursive ? first_ : w.candidates);
  resources_.set("beyond_texels", w.candidates);
  resources_.set("residual_texels", residuals_);
  const uint32_t pixels = 64 * uint32_t(item.blocks.size());
  const PropagatePush push{w.film.width(), w.film.height(), side, pixels, w.recursive};
  stream.dispatch(propagating_, resources_, push, gpu::groups_for(pixels, 64), k_propagating);
  stream.run();
  return true;
}

}  // namespace lucerna::irradiance_cache
