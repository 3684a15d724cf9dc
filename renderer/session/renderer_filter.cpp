// Filtered pictures: a finished one on request, and the window's between its samples.
#include <cmath>

#include "session/renderer.h"

namespace lucerna::session {

namespace {

/// Errors of what tiles look up. All samples share them, so samples cannot measure them.
film::ShownError lookup_errors(const std::vector<film::TileError>& tiles) {
  const film::TileSpread spread = film::tile_spread(tiles, [](const film::TileError& t) {
    return std::hypot(t.relative_lookup_noise, t.relative_interpolation);
  });
  return {spread.median, spread.worst_tenth};
}

}  // namespace

const Filtered& Renderer::filter() {
  if (!setup_.engine || !setup_.film || stats().paths == 0)
    throw Error("filter", "there is no picture to filter yet");
  settle_mix();
  forget_filtered();  // frees its memory first
  PixelSight own(*device_, *compiler_);
  PictureFilter filter(*device_, *compiler_);
  filter.begin(filter_job());
  while (filter.working())
    filter.step(*setup_.engine, picture_view(), display_ ? display_->sight() : own, {});
  filtered_ = filter.take();
  return *filtered_;
}

const Filtered* Renderer::filtered() const {
  const bool same = filtered_ && filtered_->paths == stats().paths &&
                    filtered_->film->width() == setup_.film->width() &&
                    filtered_->film->height() == setup_.film->height();
  return same ? &*filtered_ : nullptr;
}

FilterJob Renderer::filter_job() const {
  uint32_t looked_up = 0;
  for (const auto& solver : setup_.engine->solvers())
    looked_up |= setup_.engine->plan().components_of(solver->info());
  looked_up &= paths::k_secondary_bit | paths::k_tertiary_bit;  // the components of records
  return {*setup_.film, tile_side(), setup_.seen_range().floor, stats().paths, looked_up};
}

const Filtered* Renderer::shown_filtered(const film::View& v) const {
  const bool shows =
      window_filter_ && v.layer < shared::k_layer_albedo && setup_.settings.text("preview.filter") == "auto";
  return shows ? window_filter_->result() : nullptr;
}

WindowFilter::Progress Renderer::filter_progress() const {
  return {.samples = samples(),
          .paths = stats().paths,
          .render_s = progress_.render_seconds(),
          .done = done(),
          .prepares = preparing() || setup_.engine->learns(samples())};
}

bool Renderer::filter_due() const {
  return setup_.engine && setup_.film && window_filter_ && !mix_pending_ &&
         view().layer < shared::k_layer_albedo && setup_.settings.text("preview.filter") == "auto" &&
         setup_.film->fits_storage_buffers() && window_filter_->due(filter_progress());
}

void Renderer::forget_filtered() {
  filtered_.reset();
  if (window_filter_) window_filter_->forget();
}

film::PreviewShares Renderer::preview_shares() const {
  if (!display_) return {};
  film::PreviewShares shares = display_->shares();
  if (setup_.engine && setup_.film && shown_filtered(view()))
    shares = {.stale = 0, .filtered = 1, .error = display_->filtered_error()};
  if (shares.error && lookup_errors_known()) {
    const film::ShownError lookups = lookup_errors(film::tile_errors(*setup_.film, tile_side()));
    shares.error->median = std::hypot(shares.error->median, lookups.median);
    shares.error->worst_tenth = std::hypot(shares.error->worst_tenth, lookups.worst_tenth);
  }
  return shares;
}

}  // namespace lucerna::session
