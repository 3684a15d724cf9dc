#include "film/preview.h"

#include <algorithm>
#include <utility>

namespace lucerna::film {

using namespace shared;

namespace {

constexpr uint32_t k_filter_passes = 4;
constexpr uint64_t k_light_bytes = 16 * k_preview_texels;

uint32_t groups(uint64_t items) { return gpu::groups_for(items, 64); }

/// Components that a view shows.
uint32_t shown_components(const View& view) {
  return view.layer == k_layer_beauty ? view.show : 1u << (view.layer - k_layer_primary);
}

}  // namespace

bool PreviewCamera::operator==(const PreviewCamera& o) const {
  return axes.origin == o.axes.origin && axes.right == o.axes.right && axes.up == o.axes.up &&
         axes.forward == o.axes.forward && orthographic == o.orthographic;
}

Preview::Preview(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      pack_(device, compiler, "film/preview_pack.comp"),
      halve_(device, compiler, "film/preview_halve.comp"),
      filter_(device, compiler, "film/preview_filter.comp"),
      reproject_(device, compiler, "film/preview_reproject.comp"),
      resolve_(device, compiler, "film/preview_resolve.comp") {}

bool Preview::fits(const gpu::Limits& limits, uint32_t width, uint32_t height) {
  return uint64_t{width} * height * k_light_bytes <= limits.max_storage_buffer;
}

void Preview::forget() { shown_ = has_history_ = repainted_ = false; }

void Preview::keep(const vec3& scale, bool repainted) {
  if (shown_) {
    std::swap(now_, history_);
    history_camera_ = camera_, history_exposure_ = exposure_;
    history_scale_ = vec3(1);
    has_history_ = true;
    shown_ = false;
  }
  history_scale_ *= scale;
  repainted_ = repainted_ || repainted;
}

uint64_t Preview::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&now_.light, &now_.surfaces, &history_.light, &history_.surfaces,
                               &draft_.light, &draft_.surfaces, &grid_, &grid_surfaces_, &filtered_,
                               &before_[0], &before_[1], &noise_, &shares_, &depths_, &nearest_})
    if (*b) sum += b->bytes();
  return sum;
}

void Preview::make_room(uint32_t width, uint32_t height, const Film* draft) {
  const auto make = [&](gpu::Buffer& buffer, const char* name, uint64_t bytes) {
    gpu::make_texel_room(device_, buffer, name, bytes);
  };
  if (width != width_ || height != height_) forget();
  width_ = width, height_ = height;
  const uint64_t n = pixels(), cells = uint64_t{(width + 1) / 2} * ((height + 1) / 2);
  for (Pixels* p : {&now_, &history_}) {
    make(p->light, "preview", n * k_light_bytes);
    make(p->surfaces, "preview surfaces", n * 16);
  }
  const uint64_t drafted = draft ? uint64_t{draft->width()} * draft->height() : 1;
  make(draft_.light, "preview draft", drafted * k_light_bytes);
  make(draft_.surfaces, "preview draft surfaces", drafted * 16);
  make(grid_, "preview grid", cells * k_light_bytes);
  make(filtered_, "preview filtered", cells * k_light_bytes);
  make(grid_surfaces_, "preview grid surfaces", cells * 16);
  for (gpu::Buffer& b : before_) make(b, "preview before", cells * 16);
  make(noise_, "preview noise", cells * 16);
  gpu::make_room(device_, shares_,
                 {.name = "preview shares",
                  .bytes = groups(n) * sizeof(shared::PreviewShares),
                  .memory = gpu::Memory::host});
  make(depths_, "preview depths", n * 4);
  make(nearest_, "preview nearest", n * 4);
}

void Preview::pack(gpu::Stream& stream, const Film& film, const Pixels& to, float exposure, bool guided) {
  film.bind(resources_);
  resources_.set("Packed", to.light);
  resources_.set("PackedSurfaces", to.surfaces);
  resources_.set("history_surfaces", history_.surfaces);
  stream.dispatch(pack_, resources_, PreviewPackPush{film.width(), film.height(), exposure, guided},
                  groups(uint64_t{film.width()} * film.height()));
}

void Preview::reproject(gpu::Stream& stream, const PreviewCamera& now) {
  // What was developed last is kept or forgotten: its place is free.
  resources_.set("from_texels", history_.light);
  resources_.set("from_surfaces", history_.surfaces);
  resources_.set("NearestDepth", depths_);
  resources_.set("NearestPixel", nearest_);
  resources_.set("Packed", now_.light);
  resources_.set("PackedSurfaces", now_.surfaces);
  stream.fill(depths_, 0xffffffffu);
  stream.fill(nearest_, 0xffffffffu);
  for (uint32_t pass = 0; pass < 3; ++pass)
    stream.dispatch(reproject_, resources_,
                    PreviewReprojectPush{width_, height_, pass,
                                         uint32_t(history_camera_.orthographic) | now.orthographic << 1,
                                         history_camera_.axes, now.axes},
                    groups(pixels()));
  stream.run();
  std::swap(now_, history_);
  history_camera_ = now;
}

void Preview::take(gpu::Stream& stream, const Film& film, float exposure, const PreviewCamera& camera) {
  make_room(film.width(), film.height(), nullptr);
  pack(stream, film, now_, exposure, false);
  stream.run();
  camera_ = camera, exposure_ = exposure;
  shown_ = true;
}

PreviewShares Preview::develop(gpu::Stream& stream, const Film& film, const Film* draft, const View& view,
                               const PreviewCamera& camera, bool filtered, bool sampled) {
  make_room(film.width(), film.height(), draft);
  if (has_history_ && !(history_camera_ == camera)) reproject(stream, camera);
  const uint32_t across = (width_ + 1) / 2, down = (height_ + 1) / 2, cells = across * down;
  pack(stream, film, now_, view.exposure, has_history_);
  if (draft) pack(stream, *draft, draft_, view.exposure, false);

  const vec3 history_scale = history_scale_ * (view.exposure / history_exposure_);
  resources_.set("packed_texels", now_.light);
  resources_.set("surface_texels", now_.surfaces);
  resources_.set("draft_texels", draft_.light);
  resources_.set("draft_surfaces", draft_.surfaces);
  resources_.set("history_texels", history_.light);
  resources_.set("history_surfaces", history_.surfaces);
  resources_.set("GridBefore", before_[0]);
  resources_.set("Grid", grid_);
  resources_.set("GridSurfaces", grid_surfaces_);
  resources_.set("grid_surfaces", grid_surfaces_);
  resources_.set("GridNoise", noise_);
  resources_.set("noise_texels", noise_);
  const PreviewHalvePush halve{
      .width = width_,
      .height = height_,
      .across = across,
      .down = down,
      .draft_width = draft ? draft->width() : 0,
      .draft_height = draft ? draft->height() : 0,
      .history = has_history_,
      .repainted = repainted_,
      .history_scale = history_scale,
      .draft_share = draft ? float(draft->width()) * float(draft->height()) / float(cells) : 0};
  stream.dispatch(halve_, resources_, halve, groups(cells));
  const gpu::Buffer *from = &grid_, *to = &filtered_, *before = &before_[0], *before_to = &before_[1];
  // Cells that show one pixel of a draft tell nothing of its noise.
  const uint32_t base = draft && 3 * draft->width() < 2 * across ? 2 : 1;
  for (uint32_t pass = 0; pass < k_filter_passes; ++pass) {
    resources_.set("grid_texels", *from);
    resources_.set("Filtered", *to);
    resources_.set("before_texels", *before);
    resources_.set("FilteredBefore", *before_to);
    const PreviewFilterPush push{.across = across,
                                 .down = down,
                                 .step = base << pass,
                                 .first = pass == 0,
                                 .orthographic = camera.orthographic,
                                 .right = camera.axes.right,
                                 .up = camera.axes.up,
                                 .forward = camera.axes.forward};
    stream.dispatch(filter_, resources_, push, groups(cells));
    std::swap(from, to);
    std::swap(before, before_to);
  }
  resources_.set("filtered_texels", *from);
  resources_.set("before_texels", *before);
  resources_.set("Packed", now_.light);
  resources_.set("PackedSurfaces", now_.surfaces);
  resources_.set("Picture", film.picture());
  resources_.set("Shares", shares_);
  const PreviewResolvePush resolve{.width = width_,
                                   .height = height_,
                                   .across = across,
                                   .down = down,
                                   .show = shown_components(view),
                                   .curve = view.curve,
                                   .filtering = filtered,
                                   .history = has_history_,
                                   .repainted = repainted_,
                                   .history_scale = history_scale};
  stream.dispatch(resolve_, resources_, resolve, groups(pixels()));
  stream.run();
  stream.take_times();
  camera_ = camera, exposure_ = view.exposure;
  shown_ = true;
  repainted_ = repainted_ && !sampled;

  PreviewShares told;
  double all = 0;
  const auto* sums = static_cast<const shared::PreviewShares*>(shares_.mapped());
  for (uint32_t g = 0; g < groups(pixels()); ++g)
    all += sums[g].all, told.stale += sums[g].stale, told.filtered += sums[g].filtered;
  if (all > 0) told.stale /= all, told.filtered /= all;
  return told;
}

}  // namespace lucerna::film
