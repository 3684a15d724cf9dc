// Display of the cache: overlays, report, statistics.
#include <algorithm>

#include "solvers/irradiance_cache/report.h"
#include "solvers/irradiance_cache/solver.h"

namespace lucerna::irradiance_cache {

using overlay::Canvas, solvers::Picture;

namespace {

uint32_t pixel_at(float place, uint32_t pixels) {
  return std::min(uint32_t(std::clamp(place, 0.0f, 1.0f) * float(pixels)), pixels - 1);
}

}  // namespace

Inspector& CacheSolver::inspector() {
  if (!inspector_) inspector_ = std::make_unique<Inspector>(device_, compiler_);
  return *inspector_;
}

void CacheSolver::draw(const Canvas& canvas, const Picture& picture) {
  const OptionValues& settings = picture.task.settings;
  const CacheView seen = view(picture);
  if (const auto of = uint32_t(settings.choice("overlay.discontinuity")); of > 0)
    cache_.draw_discontinuity(canvas, seen, Discontinuity::Of(of - 1),
                              uint32_t(settings.integer("overlay.discontinuity_level")));
  const auto placement = PlacementShow(settings.choice("overlay.placement"));
  if (placement != PlacementShow::off) {
    if (!placement_view_) placement_view_ = std::make_unique<PlacementView>(device_, compiler_);
    // Drawn first, because it dims the picture.
    placement_view_->draw(canvas, cache_, placement);
  }
  const auto color = uint32_t(settings.choice("overlay.records_by"));
  const bool overlap = settings.boolean("overlay.overlap");
  if ((overlap || looked_at_) && !cache_.look_at_picture(canvas.wavefront, seen, canvas.cancel)) return;
  cache_.draw(canvas, {.discs = settings.boolean("overlay.records"), .overlap = overlap, .color = color});
  inspection_ = {};
  if (settings.boolean("overlay.normals")) inspector().draw_normals(canvas, cache_, color);
  if (!looked_at_) return;
  inspection_ = inspector().inspect(canvas, cache_, pixel_at(looked_at_->x, canvas.film.width()),
                                    pixel_at(looked_at_->y, canvas.film.height()));
  inspector().draw_lines(canvas, cache_, inspection_);
}

const Overlap& CacheSolver::overlap(const Canvas& canvas, const Picture& picture) {
  if (!overlap_) {
    cache_.look_at_picture(canvas.wavefront, view(picture));
    overlap_ = inspector().overlap(canvas, cache_);
  }
  return *overlap_;
}

CacheReport CacheSolver::state(const Canvas& canvas, const Picture& picture, bool sampled) {
  const OptionValues& settings = picture.task.settings;
  CacheReport all;
  all.status = cache_.status();
  const auto placement = PlacementShow(settings.choice("overlay.placement"));
  if (placement != PlacementShow::off) all.placement = placement_drawn(placement, cache_.placement());
  all.placed = cache_.records().size();
  all.refines = cache_.refines();
  all.room = cache_.records().capacity();
  all.color = uint32_t(settings.choice("overlay.records_by"));
  all.scale = cache_.scale(all.color);
  all.looked_at = looked_at_;
  all.inspection = inspection_;
  if (cache_.ready() && sampled) all.overlap = overlap(canvas, picture);
  return all;
}

std::shared_ptr<const solvers::Report> CacheSolver::report(const Canvas& canvas, const Picture& picture,
                                                           bool sampled) {
  return std::make_shared<const solvers::Report>(
      make_report(state(canvas, picture, sampled), picture.task.settings));
}

nlohmann::ordered_json CacheSolver::statistics(const Canvas& canvas, const Picture& picture) {
  const CacheStatus& s = cache_.status();
  nlohmann::ordered_json j{
      {"passes", s.pass},
      {"records", s.records},
      {"loaded", s.loaded},
      {"rays", s.rays},
      {"uncovered_share", double(s.probed.uncovered) / double(std::max<uint64_t>(1, s.probed.paths))},
      {"bytes", s.bytes},
      {"stopped_by", k_stop_reasons[size_t(s.stop)]}};
  if (cache_.ready()) {
    const Overlap& o = overlap(canvas, picture);
    j["overlap"] = {{"mean", o.mean},
                    {"most", o.most},
                    {"listed", o.listed},
                    {"pixels", o.pixels},
                    {"gathered_share", double(o.gathered) / double(std::max<uint64_t>(1, o.pixels))}};
  }
  for (const CachePass& p : s.passes) {
    nlohmann::ordered_json steps;
    for (size_t k = 0; k < p.ms.size(); ++k) steps[k_build_steps[k]] = p.ms[k];
    j["building"].push_back({{"paths", p.paths},
                             {"uncovered", p.uncovered},
                             {"uncovered_world", p.uncovered_world},
                             {"screen", p.screen},
                             {"candidates", p.candidates},
                             {"tried", p.tried},
                             {"records", p.records},
                             {"rays", p.rays},
                             {"ms", p.total_ms()},
                             {"ms_of", steps}});
  }
  return j;
}

std::map<std::string, double> CacheSolver::figures() const {
  const CacheStatus& s = cache_.status();
  return {{"records", double(s.records)}, {"rays", double(s.rays)}, {"passes", double(s.pass)}};
}

void CacheSolver::look_up_picture(const Canvas& canvas, const Picture& picture) {
  cache_.look_at_picture(canvas.wavefront, view(picture));
  inspector().look_up(canvas, cache_, defines());
}

}  // namespace lucerna::irradiance_cache
