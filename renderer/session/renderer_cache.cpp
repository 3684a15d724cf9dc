// The cache as the renderer shows it: what lies over the picture, and what is told of it.
#include <algorithm>

#include "base/log.h"
#include "session/renderer.h"
#include "solvers/irradiance_cache/placement_view.h"

namespace lucerna::session {

void Renderer::warn_of_full_cache() {
  const bool full = cache_->status().stop == irradiance_cache::StopReason::records;
  const uint32_t at = full ? cache_->status().records : 0;
  if (full && at != full_at_)
    log::warning(
        "the irradiance cache is full with {} records: where none serves, light is path traced, which is as "
        "right and slower; cache.max_records gives it more room",
        at);
  full_at_ = at;
}

void Renderer::heed_pauses() {
  if (cache_ && options_.pauses) cache_->pause(irradiance_cache::PauseAfter(settings_.choice("cache.pause")));
}

void Renderer::step_cache() {
  if (cache_) cache_->go_on(true);
}

void Renderer::run_cache() {
  if (cache_) cache_->go_on(false);
}

overlay::Canvas Renderer::canvas() { return {*wavefront_, *film_, *coarse_}; }

irradiance_cache::Inspector& Renderer::inspector() {
  if (!inspector_) inspector_ = std::make_unique<irradiance_cache::Inspector>(*device_, *compiler_);
  return *inspector_;
}

void Renderer::draw_cache() {
  if (const uint32_t of = uint32_t(settings_.choice("overlay.discontinuity")); of > 0)
    cache_->draw_discontinuity(*wavefront_, *film_, cache_view(), irradiance_cache::Discontinuity::Of(of - 1),
                               uint32_t(settings_.integer("overlay.discontinuity_level")));
  const auto placement = irradiance_cache::PlacementShow(settings_.choice("overlay.placement"));
  if (placement != irradiance_cache::PlacementShow::off) {
    if (!placement_view_)
      placement_view_ = std::make_unique<irradiance_cache::PlacementView>(*device_, *compiler_);
    // Below the others, for it dims the picture.
    placement_view_->draw(canvas(), *cache_, placement);
  }
  const auto color = uint32_t(settings_.choice("overlay.records_by"));
  const bool overlap = settings_.boolean("overlay.overlap");
  if (overlap || looked_at_) cache_->look_at_picture(*wavefront_, cache_view());
  cache_->draw(canvas(), {.discs = settings_.boolean("overlay.records"), .overlap = overlap, .color = color});
  inspection_ = {};
  const bool normals = settings_.boolean("overlay.normals");
  if (normals) inspector().draw_normals(canvas(), *cache_, color);
  if (!looked_at_) return;
  const auto pixel = [](float place, uint32_t pixels) {
    return std::min(uint32_t(std::clamp(place, 0.0f, 1.0f) * float(pixels)), pixels - 1);
  };
  inspection_ = inspector().ask(canvas(), *cache_, pixel(looked_at_->x, film_->width()),
                                pixel(looked_at_->y, film_->height()));
  inspector().draw_lines(canvas(), *cache_, inspection_);
}

void Renderer::look_up_picture() {
  if (!cache_ || !wavefront_) return;
  cache_->look_at_picture(*wavefront_, cache_view());
  inspector().look_up(canvas(), *cache_,
                      irradiance_cache::Cache::defines(record_routes_, cache_options().metric));
}

std::shared_ptr<const CacheReport> Renderer::cache_report() {
  if (!cache_ || !wavefront_) return nullptr;
  auto report = std::make_shared<CacheReport>();
  report->status = cache_->status();
  const auto placement = irradiance_cache::PlacementShow(settings_.choice("overlay.placement"));
  if (placement != irradiance_cache::PlacementShow::off)
    report->placement = irradiance_cache::placement_drawn(placement, cache_->placement());
  report->room = cache_->records().capacity();
  report->color = uint32_t(settings_.choice("overlay.records_by"));
  report->scale = cache_->scale(report->color);
  report->looked_at = looked_at_;
  report->inspection = inspection_;
  if (cache_->ready() && samples() > 0) {
    if (overlap_.first != restarts_) {
      cache_->look_at_picture(*wavefront_, cache_view());
      overlap_ = {restarts_, inspector().overlap(canvas(), *cache_)};
    }
    report->overlap = overlap_.second;
  }
  return report;
}

}  // namespace lucerna::session
