// Filtered pictures: a finished one on request, and the window's between its samples.
#include <cmath>

#include "session/picture_output.h"

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

const Filtered& PictureOutput::filter() {
  if (!setup_.engine || !setup_.film || stats().paths == 0)
    throw Error("filter", "there is no picture to filter yet");
  mix_.settle();
  forget_filtered();  // frees its memory first
  PixelSight own(context_.device, context_.compiler);
  PictureFilter filter(context_.device, context_.compiler);
  filter.begin(filter_job());
  while (filter.working())
    filter.step(*setup_.engine, picture_view(), display_ ? display_->sight() : own, {});
  filtered_ = filter.take();
  return *filtered_;
}

const Filtered* PictureOutput::filtered() const {
  const bool same = filtered_ && filtered_->paths == stats().paths &&
                    filtered_->film->width() == setup_.film->width() &&
                    filtered_->film->height() == setup_.film->height();
  return same ? &*filtered_ : nullptr;
}

FilterJob PictureOutput::filter_job() const {
  uint32_t looked_up = 0;
  for (const auto& solver : setup_.engine->solvers())
    looked_up |= setup_.engine->plan().components_of(solver->info());
  looked_up &= paths::k_secondary_bit | paths::k_tertiary_bit;  // the components of records
  return {*setup_.film, setup_.tile_side(), setup_.seen_range().floor, stats().paths, looked_up};
}

bool PictureOutput::filters(const film::View& v) const {
  return window_filter_ && shared::is_component_layer(v.layer) &&
         setup_.settings.text("preview.filter") == "auto";
}

const Filtered* PictureOutput::shown_filtered(const film::View& v) const {
  return filters(v) ? window_filter_->result() : nullptr;
}

WindowFilter::Progress PictureOutput::filter_progress() const {
  return {.samples = sampling_.samples(),
          .paths = stats().paths,
          .render_s = progress_.render_seconds(),
          .done = sampling_.done(),
          .prepares = setup_.engine->unready() || setup_.engine->learns(sampling_.samples())};
}

bool PictureOutput::filter_due() const {
  return setup_.engine && setup_.film && !mix_.pending() && filters(view()) &&
         setup_.film->fits_storage_buffers() && window_filter_->due(filter_progress());
}

void PictureOutput::step_filter(const std::function<bool()>& cancel) {
  window_filter_->step(*setup_.engine, picture_view(), *display_, filter_job(), view(), filter_progress(),
                       cancel);
}

void PictureOutput::judge_filtered() {
  if (window_filter_ && !mix_.pending())
    window_filter_->judge(*setup_.engine, *display_, *setup_.film, stats().paths);
}

void PictureOutput::forget_filtered() {
  filtered_.reset();
  if (window_filter_) window_filter_->forget();
}

film::PreviewShares PictureOutput::preview_shares() const {
  if (!display_) return {};
  film::PreviewShares shares = display_->shares();
  if (setup_.engine && setup_.film && shown_filtered(view()))
    shares = {.stale = 0, .filtered = 1, .error = display_->filtered_error()};
  if (shares.error && progress_.lookup_errors_known()) {
    const film::ShownError lookups = lookup_errors(film::tile_errors(*setup_.film, setup_.tile_side()));
    shares.error->median = std::hypot(shares.error->median, lookups.median);
    shares.error->worst_tenth = std::hypot(shares.error->worst_tenth, lookups.worst_tenth);
  }
  return shares;
}

}  // namespace lucerna::session
