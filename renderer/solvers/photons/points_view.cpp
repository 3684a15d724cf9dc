#include "solvers/photons/points_view.h"

namespace lucerna::photons {

using namespace shared;

namespace {
constexpr uint32_t k_most_points = 1u << 20;
}

PointsView::PointsView(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device), compiler_(compiler), painter_(device, compiler) {}

void PointsView::draw(const overlay::Canvas& canvas, const PhotonMap& map, uint32_t by) {
  const uint32_t photons = map.lookup().count;
  if (by == 0 || photons == 0) return;
  if (!kernel_) kernel_ = gpu::Kernel(device_, compiler_, "photons/points.comp");
  const uint32_t step = (photons + k_most_points - 1) / k_most_points, count = (photons + step - 1) / step;
  gpu::make_room(device_, points_,
                 {.name = "photon points", .bytes = uint64_t{count} * sizeof(OverlayPoint)});
  map.bind(resources_);
  resources_.set("OverlayPoints", points_);
  const PhotonPointsPush push{count, step, by, map.round()};
  canvas.stream().dispatch(kernel_, resources_, push, gpu::groups_for(count, 64));
  painter_.draw(canvas, {.points = {&points_, count}, .segments = {}, .discs = {}}, {.dimmed = true});
}

}  // namespace lucerna::photons
