#include "overlay/learned_lights.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/ramp.h"

namespace lucerna::overlay {

using namespace shared;

namespace {

/// Length of an arrow's head over the arrow's, and its width over its length.
constexpr float k_head = 0.12f, k_head_width = 0.35f;

/// A line with two short lines at its end, perpendicular to the view.
void add_arrow(std::vector<OverlaySegment>& to, const vec3& from, const vec3& at, float share,
               const vec3& forward) {
  OverlaySegment line{.from = from,
                      .to = at,
                      .half_width = 0.6f + 1.8f * std::sqrt(share),
                      .edge_width = 0.8f,
                      .color = share_ink(share),
                      .alpha = 1,
                      .strength = 1,
                      .slack = 0,
                      .rank = k_rank_most};
  to.push_back(line);
  const vec3 along = at - from;
  const float length = glm::length(along);
  if (!(length > 0)) return;
  vec3 side = glm::cross(along / length, forward);
  if (glm::length(side) < 1e-3f) return;  // parallel to the view
  side = k_head_width * k_head * length * glm::normalize(side);
  for (const float turn : {-1.f, 1.f}) {
    line.from = at - k_head * along + turn * side, line.to = at;
    to.push_back(line);
  }
}

}  // namespace

vec3 share_ink(float share) {
  return ramp_color(k_ramp_viridis, 0.15f + 0.85f * ramp_position(share, k_least_share, 1.f, 1u));
}

LearnedLightsPainter::LearnedLightsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device), compiler_(compiler), painter_(device, compiler) {}

const gpu::Kernel& LearnedLightsPainter::ready(gpu::Kernel& kernel, const char* file) {
  if (!kernel) kernel = gpu::Kernel(device_, compiler_, file);
  return kernel;
}

std::optional<ServedPoint> LearnedLightsPainter::draw_arrows(const Canvas& canvas,
                                                             const transport::LightLearning& learning,
                                                             uint32_t x, uint32_t y, const Frame& frame,
                                                             float far_away) {
  gpu::make_room(device_, points_,
                 {.name = "inspected lights", .bytes = sizeof(LearnedPoint), .memory = gpu::Memory::host});
  canvas.bind(resources_);
  learning.bind(resources_);
  resources_.set("LearnedPoints", points_);
  canvas.stream().dispatch(
      ready(point_, "overlay/learned_point.comp"), resources_,
      LearnedViewPush{canvas.width(), canvas.height(), y * canvas.width() + x, learning.rows()}, 1);
  canvas.finish();
  LearnedPoint point{};
  points_.read(&point, sizeof point);
  if (point.solid == 0 || point.row >= learning.rows()) return std::nullopt;
  ServedPoint served{.position = point.position, .normal = point.normal};
  served.arrived = learning.row_arrived()[point.row];
  const std::vector<float> shares = learning.row(point.row);
  const upload::LightClusters& clusters = learning.clusters();
  for (uint32_t c = 0; c < shares.size(); ++c)
    if (shares[c] > 0) served.clusters.push_back({c, shares[c], clusters.plain[c]});
  std::stable_sort(served.clusters.begin(), served.clusters.end(),
                   [](const ServingCluster& a, const ServingCluster& b) { return a.share > b.share; });
  std::vector<OverlaySegment> segments;
  // The largest share last, over the others.
  const size_t most = std::min(k_most_arrows, served.clusters.size());
  for (size_t i = most; i-- > 0;) {
    const ServingCluster& c = served.clusters[i];
    if (c.share < k_least_share) continue;
    const upload::ClusterPlace& place = clusters.places[c.cluster];
    add_arrow(segments, point.position, place.is_far ? point.position + far_away * place.at : place.at,
              c.share, frame.camera_forward);
  }
  const OverlayPoint dot{.position = point.position,
                         .half_width = 2.5f,
                         .color = vec3(1),
                         .alpha = 1,
                         .edge_width = 1,
                         .rank = k_rank_most};
  painter_.draw(canvas, {&dot, 1}, segments, {});
  return served;
}

void LearnedLightsPainter::draw_arrival(const Canvas& canvas, const transport::LightLearning& learning) {
  const std::vector<float>& shares = learning.row_arrived();
  gpu::make_room(device_, arrivals_,
                 {.name = "shadow rays that arrive",
                  .bytes = std::max<uint64_t>(16, shares.size() * sizeof(float)),
                  .memory = gpu::Memory::host});
  arrivals_.write(std::span<const float>(shares));
  canvas.bind(resources_);
  learning.bind(resources_);
  resources_.set("RowArrivals", arrivals_);
  canvas.stream().dispatch(ready(arrival_, "overlay/light_arrival.comp"), resources_,
                           LearnedViewPush{canvas.width(), canvas.height(), 0, uint32_t(shares.size())},
                           gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
}

}  // namespace lucerna::overlay
