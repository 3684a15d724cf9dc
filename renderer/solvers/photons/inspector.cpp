#include "solvers/photons/inspector.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lucerna::photons {

using namespace shared;

namespace {

constexpr float k_decades = 1e-3f;       // lower end of the scale, relative to its upper end
constexpr double k_smooth_photons = 16;  // approximate number of photons in the mean drawn at a pixel
constexpr uint32_t k_pixels_at_once = 1u << 15;
constexpr long k_most_taps = 8;  // pixels to either side
constexpr vec3 k_disc_ink{1.0f, 0.86f, 0.45f};

/// The next of 1, 2, 5, 10 ...
float rounded_up(float value) {
  const float ten = std::pow(10.0f, std::floor(std::log10(value)));
  for (const float step : {1.0f, 2.0f, 5.0f})
    if (value <= step * ten) return step * ten;
  return 10 * ten;
}

}  // namespace

PhotonInspector::PhotonInspector(gpu::Device& device, gpu::ShaderCompiler& compiler,
                                 const gpu::Defines& scene_defines)
    : device_(device),
      compiler_(compiler),
      most_(device, {.name = "greatest density", .bytes = 4, .memory = gpu::Memory::host}),
      inspection_(device,
                  {.name = "inspected photons",
                   .bytes = sizeof(PhotonInspectHeader) + k_photons_inspected * sizeof(PhotonInspected),
                   .memory = gpu::Memory::host}),
      painter_(device, compiler),
      through_(device, compiler, scene_defines) {}

const gpu::Kernel& PhotonInspector::ready(gpu::Kernel& kernel, const char* file) {
  if (!kernel) kernel = gpu::Kernel(device_, compiler_, file);
  return kernel;
}

bool PhotonInspector::look_up(const overlay::Canvas& sheet, const std::function<void(gpu::Resources&)>& bind,
                              uint32_t of) {
  const overlay::Canvas canvas = sheet.at_film();
  gpu::make_room(device_, densities_, {.name = "densities of photons", .bytes = canvas.pixels() * 4});
  canvas.bind(resources_);
  bind(resources_);
  through_.bind(resources_);
  resources_.set("PhotonDensities", densities_);
  resources_.set("PhotonDensityMost", most_);
  canvas.stream().fill(most_, 0);
  const auto pixels = uint32_t(canvas.pixels());
  for (uint32_t first = 0; first < pixels; first += k_pixels_at_once) {
    if (canvas.cancel && canvas.cancel()) return false;
    const uint32_t count = std::min(k_pixels_at_once, pixels - first);
    canvas.stream().dispatch(
        ready(density_, "photons/density.comp"), resources_,
        PhotonDensityPush{canvas.width(), canvas.height(), of, first, count, through_.grid()},
        gpu::groups_for(count, 64));
    canvas.finish();
  }
  return true;
}

DensityScale PhotonInspector::draw_density(const overlay::Canvas& canvas,
                                           const std::function<void(gpu::Resources&)>& bind, uint32_t of,
                                           uint32_t photons, uint64_t version) {
  const bool every_pixel = through_.grid().across > 0 && through_.grid().stride == 1;
  const bool smooths = every_pixel && (of == k_density_of_photons || of == k_density_of_irradiance);
  if (of > k_density_of_irradiance || drawn_.of != of || drawn_version_ != version) {
    drawn_ = {};
    if (!look_up(canvas, bind, of)) return {};
    if (smooths) smooth(canvas.at_film(), photons);
    const auto most = std::bit_cast<float>(*static_cast<const uint32_t*>(most_.mapped()));
    drawn_ = {.of = of}, drawn_version_ = version;
    if (most > 0) drawn_.hi = rounded_up(most), drawn_.lo = k_decades * drawn_.hi;
  }
  const DensityScale& scale = drawn_;
  canvas.bind(resources_);
  resources_.set("PhotonDensities", smooths ? smoothed_ : densities_);
  canvas.stream().dispatch(ready(heat_, "photons/heat.comp"), resources_,
                           PhotonHeatPush{canvas.width(), canvas.height(), canvas.scale(),
                                          scale.hi > 0 ? scale.lo : 1.0f, scale.hi > 0 ? scale.hi : 2.0f},
                           gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
  return scale;
}

void PhotonInspector::smooth(const overlay::Canvas& canvas, uint32_t photons) {
  // As many pixels across as contain that many photons if these were uniform.
  const double across = std::sqrt(k_smooth_photons * double(canvas.pixels()) / std::max(1u, photons));
  const auto taps = uint32_t(std::clamp(std::lround(across), 1l, k_most_taps));
  for (gpu::Buffer* b : {&halfway_, &smoothed_})
    gpu::make_room(device_, *b, {.name = "smoothed densities", .bytes = canvas.pixels() * 4});
  canvas.stream().fill(most_, 0);
  for (const uint32_t down : {0u, 1u}) {
    resources_.set("PhotonDensities", down ? halfway_ : densities_);
    resources_.set("PhotonSmoothed", down ? smoothed_ : halfway_);
    canvas.stream().dispatch(ready(smooth_, "photons/smooth.comp"), resources_,
                             PhotonSmoothPush{canvas.width(), canvas.height(), taps, down},
                             gpu::groups_for(canvas.pixels(), 64));
    canvas.finish();
  }
}

std::vector<float> PhotonInspector::densities() const { return densities_.read_all<float>(); }

std::optional<Inspected> PhotonInspector::inspect(const overlay::Canvas& canvas,
                                                  const std::function<void(gpu::Resources&)>& bind,
                                                  const vec2& place) {
  const overlay::Canvas film = canvas.at_film();
  const auto at = [](float share, uint32_t pixels) {
    return std::min(uint32_t(std::clamp(share, 0.0f, 1.0f) * float(pixels)), pixels - 1);
  };
  const uint32_t pixel = at(place.y, film.height()) * film.width() + at(place.x, film.width());
  film.bind(resources_);
  bind(resources_);
  through_.bind(resources_);
  resources_.set("PhotonInspection", inspection_);
  canvas.stream().dispatch(ready(inspect_, "photons/inspect.comp"), resources_,
                           PhotonInspectPush{film.width(), film.height(), pixel, through_.grid()}, 1);
  canvas.finish();
  const auto* header = static_cast<const PhotonInspectHeader*>(inspection_.mapped());
  if (header->solid == 0) return std::nullopt;
  Inspected found{.at = *header, .photons = {}};
  const auto* first = reinterpret_cast<const PhotonInspected*>(header + 1);
  found.photons.assign(first, first + std::min(header->count, k_photons_inspected));
  std::stable_sort(
      found.photons.begin(), found.photons.end(),
      [](const PhotonInspected& a, const PhotonInspected& b) { return a.contribution > b.contribution; });
  draw_disc(canvas, found);
  return found;
}

void PhotonInspector::draw_disc(const overlay::Canvas& canvas, const Inspected& found) {
  const OverlayDisc disc{.position = found.at.position,
                         .radius = found.at.radius,
                         .normal = found.at.normal,
                         .half_width = 0.8f,
                         .color = k_disc_ink,
                         .alpha = 1,
                         .edge_width = 0.8f,
                         .strength = 1,
                         .rank = k_rank_most};
  std::vector<OverlayPoint> points;
  std::vector<OverlaySegment> segments;
  const float most = found.photons.empty() ? 1 : std::max(1e-37f, found.photons[0].contribution);
  for (const PhotonInspected& p : found.photons) {
    const vec3 light = glm::sqrt(p.flux / std::max(1e-37f, std::max({p.flux.x, p.flux.y, p.flux.z})));
    const float share = std::sqrt(p.contribution / most);
    points.push_back({.position = p.position,
                      .half_width = 0.8f + 1.6f * share,
                      .color = light,
                      .alpha = 1,
                      .edge_width = 0.8f,
                      .rank = k_rank_most});
    segments.push_back({.from = p.position,
                        .to = p.position + found.at.radius * (0.3f + 1.2f * share) * p.direction,
                        .half_width = 0.5f,
                        .edge_width = 0,
                        .color = light,
                        .alpha = 0.6f,
                        .strength = 1,
                        .slack = found.at.radius,
                        .rank = k_rank_least});
  }
  painter_.draw(canvas, points, segments, {&disc, 1});
}

}  // namespace lucerna::photons
