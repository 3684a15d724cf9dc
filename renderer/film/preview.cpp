#include "film/preview.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <utility>

namespace lucerna::film {

using namespace shared;

namespace {

constexpr uint32_t k_filter_passes = 4;
constexpr float k_most_light = 60000;  // range of half floats
// Filtered picture: mean absolute deviation of 3x3 pixels' means over a pixel's standard error.
constexpr float k_filter_deviation = 0.72f;
constexpr uint64_t k_light_bytes = 16 * k_preview_texels;

uint32_t groups(uint64_t items) { return gpu::groups_for(items, 64); }

/// Number of blocks along a side of that many cells.
uint32_t change_blocks(uint32_t cells) { return gpu::groups_for(cells, k_preview_change_step); }

uint32_t tile_count(uint32_t pixels) { return gpu::groups_for(pixels, k_preview_tile); }

/// Components that a view shows.
uint32_t shown_components(const View& view) {
  return view.layer == k_layer_beauty ? view.show : 1u << (view.layer - k_layer_primary);
}

}  // namespace

bool PreviewCamera::operator==(const PreviewCamera& o) const {
  return axes.origin == o.axes.origin && axes.right == o.axes.right && axes.up == o.axes.up &&
         axes.forward == o.axes.forward && projection == o.projection && section == o.section;
}

Preview::Preview(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      compiler_(compiler),
      pack_(device, compiler, "film/preview_pack.comp"),
      halve_(device, compiler, "film/preview_halve.comp"),
      change_(device, compiler, "film/preview_change.comp"),
      first_filter_(device, compiler, "film/preview_filter.comp", {{"LUCERNA_PREVIEW_FIRST", "1"}}),
      filter_(device, compiler, "film/preview_filter.comp"),
      scatter_(device, compiler, "film/preview_scatter.comp"),
      gather_(device, compiler, "film/preview_gather.comp"),
      fetch_(device, compiler, "film/preview_fetch.comp"),
      recall_(device, compiler, "film/preview_recall.comp"),
      resolve_(device, compiler, "film/preview_resolve.comp"),
      judge_(device, compiler, "film/preview_judge.comp") {}

bool Preview::fits(const gpu::Limits& limits, uint32_t width, uint32_t height) {
  return uint64_t{width} * height * k_light_bytes <= limits.max_storage_buffer;
}

void Preview::forget() {
  shown_ = history_.known = history_.recoloured = repainted_ = false;
  for (History& h : aside_) h.known = false;
  moved_camera_.reset();
  judged_.reset();
  filtered_shown_.reset();
  errors_.restart();
}

void Preview::keep(const vec3& scale, bool repainted, bool same_light, float doubt, uint64_t light) {
  if (shown_) {
    // A newer picture of the same light takes the place of the former one.
    if (history_.known && history_.light != 0 && history_.light != light) {
      if (aside_[0].light != history_.light) std::swap(aside_[0], aside_[1]);
      std::swap(aside_[0], history_);
    }
    std::swap(now_, history_.pixels);
    history_.light = light;
    history_.known = true, history_.surfaces = surfaces_known_;
    history_.camera = camera_, history_.exposure = exposure_;
    history_.scale = vec3(1);
    history_.same_light = true, history_.recoloured = false, history_.doubt = 0;
    moved_camera_.reset();
    shown_ = false;
  }
  judged_.reset();
  filtered_shown_.reset();
  errors_.restart();
  history_.scale *= scale;
  history_.recoloured |= repainted;
  history_.same_light &= same_light;
  history_.doubt = std::max(history_.doubt, doubt);
  repainted_ |= repainted;
}

bool Preview::put_back(uint64_t light) {
  const auto is_of = [&](const History& h) { return h.known && h.light == light && h.pixels.light; };
  if (!is_of(history_)) {
    const auto found = std::find_if(aside_.begin(), aside_.end(), is_of);
    if (found == aside_.end()) return false;
    std::swap(*found, history_);
    moved_camera_.reset();
  }
  history_.scale = vec3(1);
  history_.same_light = true, history_.recoloured = false, history_.doubt = 0;
  return true;
}

void Preview::better() {
  // The shown picture is mostly the one before, if it is steady, and otherwise has noisier light.
  const bool same_light = history_.known && history_.same_light;
  keep();
  history_.same_light = same_light;
}

uint64_t Preview::bytes() const {
  uint64_t sum = 0;
  const auto add = [&](const gpu::Buffer& b) {
    if (b) sum += b.bytes();
  };
  for (const Pixels* p : {&now_, &history_.pixels, &aside_[0].pixels, &aside_[1].pixels, &moved_, &draft_})
    add(p->light), add(p->surfaces);
  for (const gpu::Buffer* b :
       {&grid_,       &grid_surfaces_,   &filtered_,        &before_[0], &before_[1], &lost_[0],    &lost_[1],
        &texture_[0], &texture_[1],      &noise_,           &changes_,   &ratios_,    &shares_,     &depths_,
        &nearest_,    &pixels_shown_[0], &pixels_shown_[1], &sums_[0],   &sums_[1],   &draft_sums_, &tiles_})
    add(*b);
  return sum;
}

void Preview::make_pixels(Pixels& to) {
  gpu::make_texel_room(device_, to.light, "preview", pixels() * k_light_bytes);
  gpu::make_texel_room(device_, to.surfaces, "preview surfaces", pixels() * uint64_t{16});
}

void Preview::make_room(uint32_t width, uint32_t height, const Film* draft) {
  const auto make = [&](gpu::Buffer& buffer, const char* name, uint64_t bytes) {
    gpu::make_texel_room(device_, buffer, name, bytes);
  };
  if (width != width_ || height != height_) forget();
  width_ = width, height_ = height;
  const uint64_t n = pixels(), cells = uint64_t{(width + 1) / 2} * ((height + 1) / 2);
  make_pixels(now_), make_pixels(history_.pixels);
  const uint64_t drafted = draft ? uint64_t{draft->width()} * draft->height() : 1;
  make(draft_.light, "preview draft", drafted * k_light_bytes);
  make(draft_.surfaces, "preview draft surfaces", drafted * 16);
  make(grid_, "preview grid", cells * k_light_bytes);
  make(filtered_, "preview filtered", cells * k_light_bytes);
  make(grid_surfaces_, "preview grid surfaces", cells * 16);
  for (gpu::Buffer& b : before_) make(b, "preview before", cells * 16);
  for (gpu::Buffer& b : lost_) make(b, "preview lost", cells * 16);
  for (gpu::Buffer& b : texture_) make(b, "preview texture", cells * 16);
  make(noise_, "preview noise", cells * 16);
  const uint64_t blocks = uint64_t{change_blocks((width + 1) / 2)} * change_blocks((height + 1) / 2);
  make(changes_, "preview changes", blocks * k_preview_change_texels * 16);
  make(ratios_, "preview ratios", (blocks + 1) * 16);
  gpu::make_room(device_, shares_,
                 {.name = "preview shares",
                  .bytes = groups(n) * sizeof(shared::PreviewShares),
                  .memory = gpu::Memory::host});
  for (gpu::Buffer* b : {&depths_, &nearest_}) make(*b, "preview nearest", n * 4);
  for (gpu::Buffer& b : pixels_shown_) make(b, "preview shown", n * 4);
  for (gpu::Buffer& b : sums_) make(b, "preview sums", n * 8);
  make(draft_sums_, "preview draft sums", drafted * 8);
  gpu::make_room(device_, tiles_,
                 {.name = "preview tiles",
                  .bytes = uint64_t{tile_count(width)} * tile_count(height) * sizeof(PreviewTile),
                  .memory = gpu::Memory::host});
}

void Preview::pack(gpu::Stream& stream, const Film& film, const Pixels& to, const View& view,
                   const gpu::Buffer* guide, const gpu::Buffer& sums, float noise, bool taken) {
  film.bind(resources_);
  resources_.set("guide_surfaces", guide ? *guide : history_.pixels.surfaces);
  resources_.set("Packed", to.light);
  resources_.set("PackedSurfaces", to.surfaces);
  resources_.set("PackedSums", sums);
  stream.dispatch(pack_, resources_,
                  PreviewPackPush{film.width(), film.height(), view.exposure, guide != nullptr,
                                  shown_components(view), noise, taken},
                  groups(uint64_t{film.width()} * film.height()));
}

void Preview::move(gpu::Stream& stream, PreviewReprojectPush push) {
  make_pixels(moved_);
  resources_.set("from_texels", history_.pixels.light);
  resources_.set("from_surfaces", history_.pixels.surfaces);
  resources_.set("NearestDepth", depths_);
  resources_.set("NearestPixel", nearest_);
  resources_.set("nearest_depths", depths_);
  resources_.set("nearest_pixels", nearest_);
  resources_.set("Packed", moved_.light);
  resources_.set("PackedSurfaces", moved_.surfaces);
  stream.fill(depths_, k_preview_none);
  stream.fill(nearest_, k_preview_none);
  for (push.pass = 0; push.pass < 2; ++push.pass)
    stream.dispatch(scatter_, resources_, push, groups(pixels()));
  stream.dispatch(gather_, resources_, push, groups(pixels()));
}

void Preview::fetch(gpu::Stream& stream, const PreviewCamera& now, const gpu::Buffer& seen, uint32_t width,
                    uint32_t height, const Pixels& to, bool keep) {
  resources_.set("from_texels", history_.pixels.light);
  resources_.set("from_surfaces", history_.pixels.surfaces);
  resources_.set("seen_surfaces", seen);
  resources_.set("Packed", to.light);
  resources_.set("PackedSurfaces", to.surfaces);
  stream.dispatch(
      fetch_, resources_,
      PreviewFetchPush{width_, height_, width, height, history_.camera.projection | now.projection << 4, keep,
                       history_.camera.axes, now.axes},
      groups(std::max(uint64_t{width} * height, uint64_t{1})));
}

/// The previous picture from the present camera. It always comes from the picture as it was shown, not from a
/// reprojection, so that nothing is lost on the way.
const Preview::Pixels& Preview::history(gpu::Stream& stream, const PreviewCamera& now,
                                        const gpu::Buffer* seen) {
  if (!history_.known || history_.camera == now) return history_.pixels;
  const bool by_surfaces = seen && history_.surfaces;
  if (moved_camera_ == now && moved_by_surfaces_ == by_surfaces) return moved_;
  if (by_surfaces) {
    make_pixels(moved_);
    fetch(stream, now, *seen, width_, height_, moved_, false);
  } else {
    move(stream, PreviewReprojectPush{width_, height_, 0, history_.camera.projection | now.projection << 4,
                                      history_.camera.axes, now.axes});
  }
  stream.run();
  moved_camera_ = now, moved_by_surfaces_ = by_surfaces;
  return moved_;
}

gpu::Kernel& Preview::by_lut(const gpu::Buffer* lut, gpu::Kernel& kernel, gpu::Kernel& with_lut,
                             const char* file) {
  if (!lut) return kernel;
  if (!with_lut) with_lut = gpu::Kernel(device_, compiler_, file, {{"LUCERNA_DISPLAY_LUT", "1"}});
  resources_.set("DisplayLut", *lut);
  return with_lut;
}

void Preview::show(gpu::Stream& stream, const Film& film, const Pixels& seen, PreviewRecallPush push,
                   const gpu::Buffer* lut) {
  gpu::Kernel& recall = by_lut(lut, recall_, recall_by_lut_, "film/preview_recall.comp");
  resources_.set("history_texels", seen.light);
  resources_.set("history_surfaces", seen.surfaces);
  resources_.set("Picture", film.picture());
  resources_.set("shown_texels", texture_[0]);
  constexpr uint32_t k_step = k_preview_first_step;
  const uint32_t cells = ((push.width + k_step - 1) / k_step) * ((push.height + k_step - 1) / k_step);
  push.across = width_, push.down = height_;
  for (push.pass = 0; push.pass < (push.seen ? 4u : 3u); ++push.pass) {
    resources_.set("cell_texels", before_[(push.pass + 1) % 2]);
    resources_.set("Cells", push.pass == 2 ? texture_[0] : before_[push.pass % 2]);
    stream.dispatch(recall, resources_, push,
                    groups(push.pass < 2    ? cells
                           : push.pass == 2 ? push.width * push.height
                                            : pixels()));
  }
  stream.run();
  stream.take_times();
}

void Preview::warm(gpu::Stream& stream, const Film& film) {
  resources_.set("grid_texels", grid_);
  resources_.set("grid_surfaces", grid_surfaces_);
  resources_.set("before_texels", before_[0]);
  resources_.set("Sums", changes_);
  resources_.set("Ratios", ratios_);
  stream.dispatch(change_, resources_, PreviewChangePush{.all = 1}, 1);  // without blocks
  move(stream, {});                                                      // without pixels
  fetch(stream, camera_, moved_.surfaces, 0, 0, moved_, false);
  show(stream, film, moved_, {}, nullptr);
}

void Preview::recall(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera) {
  show(stream, film, history(stream, camera),
       {.width = width_,
        .height = height_,
        .show = shown_components(view),
        .curve = view.curve,
        .history_scale = history_.scale_for(view),
        .tint = view.tint_former},
       view.display_lut);
}

void Preview::recall_on(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera,
                        const gpu::Buffer& seen, uint32_t width, uint32_t height) {
  const uint64_t count = uint64_t{width} * height;
  gpu::make_texel_room(device_, draft_.light, "preview draft", count * k_light_bytes);
  gpu::make_texel_room(device_, draft_.surfaces, "preview draft surfaces", count * 16);
  fetch(stream, camera, seen, width, height, draft_, true);
  show(stream, film, draft_,
       {.width = width,
        .height = height,
        .show = shown_components(view),
        .curve = view.curve,
        .history_scale = history_.scale_for(view),
        .seen = 1,
        .tint = view.tint_former},
       view.display_lut);
}

void Preview::take(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera,
                   float noise, const gpu::Buffer* seen) {
  make_room(film.width(), film.height(), nullptr);
  pack(stream, film, now_, view, seen, sums_[0], noise, true);
  stream.run();
  camera_ = camera, exposure_ = view.exposure;
  surfaces_known_ = true;
  shown_ = true;
}

std::span<const PreviewTile> Preview::tiles() const {
  return {static_cast<const PreviewTile*>(tiles_.mapped()), size_t{tile_count(width_)} * tile_count(height_)};
}

void Preview::judge_tiles(gpu::Stream& stream, const Film& by, uint32_t step, const gpu::Buffer& shown) {
  resources_.set("ShownBefore", pixels_shown_[1]);
  resources_.set("ShownNow", shown);
  resources_.set("SumsBefore", sums_[1]);
  resources_.set("SumsNow", sums_[0]);
  resources_.set("Tiles", tiles_);
  stream.dispatch(judge_, resources_, PreviewJudgePush{width_, height_, by.width(), by.height(), step},
                  tile_count(width_) * tile_count(height_));
}

bool Preview::judge(gpu::Stream& stream, const Film& by, const View& view) {
  const uint32_t step = width_ / by.width();
  const Judged now{step, view.exposure, shown_components(view)};
  const bool measured = judged_ == now && k_preview_tile % step == 0;
  judge_tiles(stream, by, measured ? step : 0, pixels_shown_[0]);
  std::swap(pixels_shown_[0], pixels_shown_[1]);
  std::swap(sums_[0], sums_[1]);
  judged_ = now;
  filtered_shown_.reset();
  return measured;
}

ShownError Preview::show_filtered(gpu::Stream& stream, const Film& film, std::span<const float> luminances,
                                  std::span<const float> errors, const View& view) {
  make_room(film.width(), film.height(), nullptr);
  std::vector<uint32_t> shown(luminances.size());
  for (size_t i = 0; i < shown.size(); ++i) {
    const float light = view.exposure * luminances[i],
                error = k_filter_deviation * view.exposure * errors[i] / std::max(light, k_preview_dark);
    shown[i] = glm::packHalf2x16(vec2(std::min(light, k_most_light), std::min(error, 1.0f)));
  }
  pixels_shown_[1].write(std::span<const uint32_t>(shown));
  // Only the sums are needed: what was shown stays the history of the next edit until take().
  make_pixels(moved_), moved_camera_.reset();
  pack(stream, film, moved_, view, nullptr, sums_[1]);
  judge_tiles(stream, film, 0, pixels_shown_[1]);
  stream.run();
  stream.take_times();
  filtered_shown_ = {view, errors_};
  judged_.reset();
  return errors_.judge(tiles(), tile_count(width_), false);
}

std::optional<ShownError> Preview::judge_filtered(gpu::Stream& stream, const Film& film) {
  if (!filtered_shown_ || film.width() != width_ || film.height() != height_) return std::nullopt;
  make_pixels(moved_), moved_camera_.reset();
  pack(stream, film, moved_, filtered_shown_->view, nullptr, sums_[0]);
  judge_tiles(stream, film, 1, pixels_shown_[1]);
  stream.run();
  stream.take_times();
  errors_ = filtered_shown_->before;
  return errors_.judge(tiles(), tile_count(width_), true);
}

PreviewShares Preview::develop(gpu::Stream& stream, const Film& film, const Film* draft, const View& view,
                               const PreviewCamera& camera, bool filtered, Sampled sampled,
                               const gpu::Buffer* seen) {
  make_room(film.width(), film.height(), draft);
  const Pixels& before_edit = history(stream, camera, seen);
  const gpu::Buffer* guide = seen ? seen : history_.known ? &before_edit.surfaces : nullptr;
  const uint32_t surfaces = seen             ? k_preview_surface_seen
                            : history_.known ? k_preview_surface_before
                                             : k_preview_surface_unknown;
  const bool repainted = repainted_ && !seen, moved = history_.known && history_.camera != camera;
  // Wide cells lose nothing while each has at most one preview sample.
  const bool wide = sampled == Sampled::none && draft && draft->width() <= width_ / k_preview_first_step;
  const uint32_t step = wide ? k_preview_first_step : k_preview_step;
  const uint32_t across = (width_ + step - 1) / step, down = (height_ + step - 1) / step,
                 cells = across * down;
  const bool by_draft = sampled == Sampled::none;
  if (!by_draft) pack(stream, film, now_, view, guide, sums_[0]);
  if (draft) pack(stream, *draft, draft_, view, nullptr, by_draft ? sums_[0] : draft_sums_);

  resources_.set("packed_texels", now_.light);
  resources_.set("surface_texels", now_.surfaces);
  resources_.set("draft_texels", draft_.light);
  resources_.set("draft_surfaces", draft_.surfaces);
  resources_.set("guide_surfaces", guide ? *guide : before_edit.surfaces);
  resources_.set("history_texels", before_edit.light);
  resources_.set("history_surfaces", before_edit.surfaces);
  resources_.set("GridBefore", before_[0]);
  resources_.set("GridTexture", texture_[0]);
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
      .history = history_.known,
      .repainted = repainted,
      .history_scale = history_.scale_for(view),
      .draft_share = draft ? float(draft->width()) * float(draft->height()) / float(cells) : 0,
      .step = step,
      .sampled = sampled != Sampled::none,
      .surfaces = surfaces,
      .moved = moved};
  stream.dispatch(halve_, resources_, halve, groups(cells));
  // Changed light on the same surfaces: measures the change.
  const bool changed = history_.known && !history_.same_light;
  const uvec2 blocks = changed ? uvec2(change_blocks(across), change_blocks(down)) : uvec2(0);
  resources_.set("change_texels", ratios_);
  if (changed) {
    resources_.set("grid_texels", grid_);
    resources_.set("before_texels", before_[0]);
    resources_.set("Sums", changes_);
    resources_.set("Ratios", ratios_);
    PreviewChangePush push{across, down, blocks.x, blocks.y, 0};
    stream.dispatch(change_, resources_, push, blocks.x * blocks.y);
    push.all = 1;
    stream.dispatch(change_, resources_, push, 1);
  }
  const gpu::Buffer *from = &grid_, *to = &filtered_, *before = &before_[0], *before_to = &before_[1],
                    *lost = &lost_[0], *lost_to = &lost_[1], *texture = &texture_[0],
                    *texture_to = &texture_[1];
  // Cells that show one pixel of a preview sample have no information about its noise.
  const uint32_t base = draft && 3 * draft->width() < 2 * across ? 2 : 1;
  for (uint32_t pass = 0; pass < k_filter_passes; ++pass) {
    resources_.set("grid_texels", *from);
    resources_.set("Filtered", *to);
    resources_.set("before_texels", *before);
    resources_.set("FilteredBefore", *before_to);
    resources_.set("lost_texels", *lost);
    resources_.set("FilteredLost", *lost_to);
    resources_.set("texture_texels", *texture);
    resources_.set("FilteredTexture", *texture_to);
    const PreviewFilterPush push{.across = across,
                                 .down = down,
                                 // The last pass mixes even and odd cells.
                                 .step = pass + 1 == k_filter_passes && base == 2 ? 1 : base << pass,
                                 .projection = camera.projection,
                                 .history = history_.known,
                                 .blocks_across = blocks.x,
                                 .blocks_down = blocks.y,
                                 .right = camera.axes.right,
                                 .up = camera.axes.up,
                                 .forward = camera.axes.forward};
    stream.dispatch(pass == 0 ? first_filter_ : filter_, resources_, push, groups(cells));
    std::swap(from, to);
    std::swap(before, before_to);
    std::swap(lost, lost_to);
    std::swap(texture, texture_to);
  }
  resources_.set("filtered_texels", *from);
  resources_.set("before_texels", *before);
  resources_.set("lost_texels", *lost);
  resources_.set("texture_texels", *texture);
  resources_.set("Packed", now_.light);
  resources_.set("PackedSurfaces", now_.surfaces);
  resources_.set("Picture", film.picture());
  resources_.set("Shares", shares_);
  resources_.set("Shown", pixels_shown_[0]);
  const PreviewResolvePush resolve{.width = width_,
                                   .height = height_,
                                   .across = across,
                                   .down = down,
                                   .show = shown_components(view),
                                   .curve = view.curve,
                                   .filtering = filtered,
                                   .history = history_.known,
                                   .repainted = repainted,
                                   .history_scale = history_.scale_for(view),
                                   .step = step,
                                   .sampled = sampled != Sampled::none,
                                   .same_light = history_.same_light,
                                   .recoloured = history_.recoloured,
                                   .blocks_across = blocks.x,
                                   .blocks_down = blocks.y,
                                   .surfaces = surfaces,
                                   .moved = moved,
                                   .tint = view.tint_former,
                                   .doubt = history_.doubt};
  stream.dispatch(by_lut(view.display_lut, resolve_, resolve_by_lut_, "film/preview_resolve.comp"),
                  resources_, resolve, groups(pixels()));
  const bool measured = judge(stream, by_draft && draft ? *draft : film, view);
  stream.run();
  stream.take_times();
  camera_ = camera, exposure_ = view.exposure;
  shown_ = draft || sampled != Sampled::none;
  surfaces_known_ = seen || sampled == Sampled::all;
  repainted_ = repainted_ && sampled != Sampled::all;

  PreviewShares shares;
  double all = 0;
  const auto* sums = static_cast<const shared::PreviewShares*>(shares_.mapped());
  for (uint32_t g = 0; g < groups(pixels()); ++g)
    all += sums[g].all, shares.stale += sums[g].stale, shares.filtered += sums[g].filtered;
  shares.error = errors_.judge(tiles(), tile_count(width_), measured);
  if (all > 0) shares.stale /= all, shares.filtered /= all;
  return shares;
}

}  // namespace lucerna::film
