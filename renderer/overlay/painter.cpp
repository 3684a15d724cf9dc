#include "overlay/painter.h"

#include <algorithm>

namespace lucerna::overlay {

using namespace shared;

namespace {
/// Maximum pixels along a segment per invocation; lavapipe ends long loops.
constexpr uint32_t k_piece = 1024;
}  // namespace

Painter::Painter(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

const gpu::Kernel& Painter::ready(gpu::Kernel& kernel, const char* file) {
  if (!kernel) kernel = gpu::Kernel(device_, compiler_, file);
  return kernel;
}

void Painter::draw(const Canvas& canvas, const Drawing& drawing, const Style& style) {
  const uint64_t all =
      uint64_t{drawing.points.count} + drawing.segments.count + uint64_t{drawing.discs.count};
  if (all > k_most_strokes)
    throw_error("overlay", "{} points, segments and discs at once; at most {}", all, k_most_strokes);
  if (all == 0 && !style.dimmed) return;
  gpu::Stream& stream = canvas.stream();
  gpu::make_room(device_, marks_, {.name = "overlay marks", .bytes = 4 * canvas.pixels()});
  gpu::make_room(device_, inks_,
                 {.name = "overlay inks", .bytes = sizeof(vec4) * std::max<uint64_t>(all, 1)});
  canvas.bind(resources_);
  resources_.set("OverlayMarks", marks_);
  resources_.set("OverlayInks", inks_);
  stream.fill(marks_, 0);
  OverlayMarkPush push{canvas.width(), canvas.height(), 0, 0, 1};
  const auto mark = [&](gpu::Kernel& kernel, const char* file, const char* block, const Strokes& strokes,
                        uint32_t pieces) {
    push.count = strokes.count, push.pieces = pieces;
    if (strokes.count > 0) {
      resources_.set(block, *strokes.of);
      stream.dispatch(ready(kernel, file), resources_, push,
                      gpu::groups_for(uint64_t{strokes.count} * pieces, 64));
    }
    push.first += strokes.count;
  };
  mark(points_, "overlay/points.comp", "OverlayPoints", drawing.points, 1);
  mark(segments_, "overlay/segments.comp", "OverlaySegments", drawing.segments,
       (std::max(canvas.width(), canvas.height()) - 1) / k_piece + 1);
  mark(discs_, "overlay/discs.comp", "OverlayDiscs", drawing.discs, k_disc_pieces);
  stream.dispatch(ready(lay_, "overlay/lay.comp"), resources_,
                  OverlayLayPush{canvas.width(), canvas.height(), style.dimmed, style.edge_alpha},
                  gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
}

void Painter::draw(const Canvas& canvas, std::span<const OverlayPoint> points,
                   std::span<const OverlaySegment> segments, std::span<const OverlayDisc> discs,
                   const Style& style) {
  const auto given = [&](gpu::Buffer& buffer, auto strokes) {
    if (strokes.empty()) return Strokes{};
    gpu::make_room(device_, buffer,
                   {.name = "overlay strokes", .bytes = strokes.size_bytes(), .memory = gpu::Memory::host});
    buffer.write(strokes);
    return Strokes{&buffer, static_cast<uint32_t>(strokes.size())};
  };
  draw(canvas, {given(given_[0], points), given(given_[1], segments), given(given_[2], discs)}, style);
}

}  // namespace lucerna::overlay
