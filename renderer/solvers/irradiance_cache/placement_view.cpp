#include "solvers/irradiance_cache/placement_view.h"

#include <algorithm>
#include <cmath>

#include "gpu/stream.h"
#include "overlay/painter.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Maximum number of drawn points: in the first pass nearly all pixels may be candidates, and some are
/// skipped.
constexpr size_t k_most_points = 1u << 20;
static_assert(2 * k_most_points <= k_most_strokes);
/// Radius of candidate dots [pixels]: as wide as their spacing allows.
constexpr float k_least_dot = 0.6f, k_most_dot = 1.5f, k_dot_of_room = 0.25f;
/// ... and of chosen places.
constexpr float k_least_tried = 1.3f, k_most_tried = 2.2f, k_tried_of_room = 0.2f;

}  // namespace

std::vector<PlacedPoint> placement_points(PlacementShow drawn, const PlacementShown& placement, size_t most,
                                          uint32_t& rings) {
  std::vector<PlacedPoint> points;
  rings = 0;
  if (drawn == PlacementShow::off) return points;
  const auto bits = [](uint32_t kind, const Place& p) { return kind | p.origin << k_placed_origin_shift; };
  if (drawn != PlacementShow::candidates) {
    std::vector<bool> kept(placement.tried.size(), false);
    for (const uint32_t i : placement.kept) kept[i] = true;
    const bool outcome = drawn == PlacementShow::chosen, thinned = !placement.kept.empty();
    for (size_t i = 0; i < std::min(most, placement.tried.size()); ++i) {
      const Place& p = placement.tried[i];
      const uint32_t kind = !outcome || !thinned ? k_placed_tried
                            : kept[i]            ? k_placed_chosen
                                                 : k_placed_rejected;
      const bool ring = outcome && kind != k_placed_rejected;
      points.push_back({p.position, bits(kind, p), p.normal, ring ? placement.radii[i] : 0});
    }
    std::stable_partition(points.begin(), points.end(), [](const PlacedPoint& p) { return p.radius > 0; });
    while (rings < points.size() && points[rings].radius > 0) ++rings;
  }
  if (drawn == PlacementShow::chosen || points.size() == most) return points;
  const size_t room = most - points.size(), all = placement.candidates.size();
  const size_t stride = (all + room - 1) / room;
  points.reserve(points.size() + all / stride + 1);
  for (size_t i = 0; i < all; i += stride) {
    const Place& p = placement.candidates[i];
    const uint32_t cluster = placement.cluster.empty() ? 0 : 1 + placement.cluster[i];
    points.push_back(
        {p.position, bits(k_placed_candidate, p) | cluster << k_placed_cluster_shift, p.normal, 0});
  }
  return points;
}

struct PlacementView::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Kernel kernel;
  gpu::Buffer places, points, discs;
  gpu::Resources resources;
  overlay::Painter painter;
  uint64_t version = 0;  // of `places`, and how it was shown
  PlacementShow drawn = PlacementShow::off;
  uint32_t count = 0, rings = 0;

  Impl(gpu::Device& d, gpu::ShaderCompiler& c) : device(d), compiler(c), painter(d, c) {}

  void room_for(gpu::Buffer& buffer, const char* name, uint64_t bytes, gpu::Memory memory) {
    gpu::make_room(device, buffer, {.name = name, .bytes = bytes + bytes / 4, .memory = memory});
  }
};

PlacementView::PlacementView(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : impl_(new Impl(device, compiler)) {}
PlacementView::~PlacementView() = default;

void PlacementView::draw(const overlay::Canvas& canvas, const Cache& cache, PlacementShow show) {
  Impl& i = *impl_;
  const PlacementShown placement = cache.placement();
  const PlacementShow drawn = placement_drawn(show, placement);
  if (drawn == PlacementShow::off) return;
  if (!i.kernel) i.kernel = gpu::Kernel(i.device, i.compiler, "irradiance_cache/places.comp");
  if (i.version != placement.version || i.drawn != drawn) {
    const std::vector<PlacedPoint> places = placement_points(drawn, placement, k_most_points, i.rings);
    i.count = uint32_t(places.size());
    i.room_for(i.places, "cache placement", places.size() * sizeof(PlacedPoint), gpu::Memory::host);
    i.places.write(std::span<const PlacedPoint>(places));
    i.version = placement.version, i.drawn = drawn;
    i.room_for(i.points, "cache placement dots", i.count * sizeof(OverlayPoint), gpu::Memory::device);
    i.room_for(i.discs, "cache placement rings", i.rings * sizeof(OverlayDisc), gpu::Memory::device);
  }
  i.resources.set("Places", i.places);
  i.resources.set("OverlayPoints", i.points);
  i.resources.set("OverlayDiscs", i.discs);
  const auto room = [&](size_t points) {
    return std::sqrt(float(canvas.pixels()) / float(std::max<size_t>(1, points)));
  };
  const PlacementPush push{
      i.count, i.rings,
      std::clamp(k_dot_of_room * room(placement.candidates.size()), k_least_dot, k_most_dot),
      std::clamp(k_tried_of_room * room(placement.tried.size()), k_least_tried, k_most_tried),
      drawn == PlacementShow::clusters};
  canvas.stream().dispatch(i.kernel, i.resources, push, gpu::groups_for(i.count, 64));
  i.painter.draw(canvas, {.points = {&i.points, i.count}, .segments = {}, .discs = {&i.discs, i.rings}},
                 {.dimmed = true});
}

}  // namespace lucerna::irradiance_cache
