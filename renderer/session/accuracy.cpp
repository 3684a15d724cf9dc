#include "session/accuracy.h"

#include <algorithm>
#include <cmath>

#include "session/renderer.h"

namespace lucerna::session {
namespace {

constexpr size_t k_passes = 64;
/// Samples a pixel from which heavy tails can be distinguished from a bad start.
constexpr uint32_t k_tail_samples = 32;

/// Seconds per ray over the last half of the work, so that the first, short passes do not count.
double seconds_a_ray(const stats::Ledger& ledger) {
  const auto& lines = ledger.entries();
  if (lines.empty() || lines.back().rays == 0) return 0;
  const stats::Entry& last = lines.back();
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    if (2 * (line->rays - line->prepared_rays) <= last.rays - last.prepared_rays)
      return (last.wall_s - line->wall_s) / static_cast<double>(last.rays - line->rays);
  return (last.wall_s - last.prepared_s) /
         std::max(1.0, static_cast<double>(last.rays) - static_cast<double>(last.prepared_rays));
}

/// True if only a region of the picture gets samples: the ledger then does not predict its time.
bool of_region(const Accuracy& a) {
  const auto region = a.settings.find("sampling.region");
  return region != a.settings.end() && !region->second.empty();
}

}  // namespace

std::array<double, stats::k_layers> Accuracy::error() const {
  return ledger.entries().empty() ? std::array<double, stats::k_layers>{} : ledger.entries().back().error;
}

uint32_t Accuracy::count(uint32_t state) const {
  return static_cast<uint32_t>(
      std::count_if(tiles.begin(), tiles.end(), [&](const TileStatus& t) { return t.state == state; }));
}

std::optional<stats::Band> seconds_to(const Accuracy& a, double target) {
  if (of_region(a)) return std::nullopt;
  if (!a.adaptive) return stats::seconds_to(a.ledger, target);
  const double each = seconds_a_ray(a.ledger);
  if (a.ledger.entries().empty() || a.tiles.empty() || each <= 0 || a.paths <= 0 || !(target > 0))
    return std::nullopt;
  const stats::Entry& last = a.ledger.entries().back();
  std::vector<stats::TileProgress> tiles;
  tiles.reserve(a.tiles.size());
  double paths = 0;
  for (const TileStatus& t : a.tiles) {
    // A tile that is done for one target may be open for another.
    const double goal = schedule::paths_goal(float(target), t.records, t.interpolation);
    const bool open = t.samples < a.max_samples && (t.samples < a.min_samples || t.error > goal ||
                                                    (target >= a.target && t.state <= shared::k_tile_active));
    tiles.push_back({.error = std::max(0.0, double{t.error}),
                     .goal = goal,
                     .samples = double(t.samples),
                     .pixels = double(t.pixels),
                     .open = open,
                     .earlier_error = double(t.earlier_error),
                     .earlier_samples = double(t.earlier_samples)});
    paths += double(t.samples) * t.pixels;
  }
  const auto total = stats::total_paths(tiles, a.across, target, a.min_samples, a.max_samples);
  if (!total) return std::nullopt;
  const double rays_a_path =
      static_cast<double>(last.rays - last.prepared_rays) / static_cast<double>(last.paths);
  const double spread = std::exp(stats::spread_of_pace(a.ledger));
  const auto seconds = [&](double all, double rate) {
    return last.wall_s + rate * std::max(0.0, all - static_cast<double>(last.paths)) * rays_a_path * each;
  };
  return stats::Band{seconds(total->low, 1 / spread), seconds(total->middle, 1),
                     seconds(total->high, spread)};
}

uint32_t tiles_out_of_reach(const Accuracy& a, double target) {
  return static_cast<uint32_t>(std::count_if(a.tiles.begin(), a.tiles.end(), [&](const TileStatus& t) {
    const double goal = schedule::paths_goal(float(target), t.records, t.interpolation);
    if (of_region(a) && t.state == shared::k_tile_done) return false;
    if (t.error <= goal || t.samples < stats::Outlook::k_least_samples) return false;
    const stats::TileProgress tile{.error = double(t.error), .samples = double(t.samples)};
    return !(goal > 0) || stats::samples_to(tile, goal, stats::k_usual_k) > a.max_samples;
  }));
}

std::optional<double> seconds_to_end(const Accuracy& a) {
  if (a.adaptive || a.ledger.entries().empty() || of_region(a)) return std::nullopt;
  const stats::Entry& last = a.ledger.entries().back();
  if (a.max_samples <= last.samples) return last.wall_s;
  const double each = stats::seconds_a_path(a.ledger);
  if (each <= 0 || last.samples <= 0) return std::nullopt;
  return last.wall_s + each * static_cast<double>(last.paths) * (a.max_samples / last.samples - 1);
}

/// Of the pixels of a tile.
uint32_t least_samples(const schedule::BalancedSchedule& s, const film::Film& film, uint32_t side,
                       size_t tile) {
  const uint32_t each = side / shared::k_block, across = (film.blocks_across() + each - 1) / each;
  const uint32_t left = uint32_t(tile) % across * each, top = uint32_t(tile) / across * each;
  uint32_t least = ~0u;
  for (uint32_t y = top; y < std::min(top + each, film.blocks_down()); ++y)
    for (uint32_t x = left; x < std::min(left + each, film.blocks_across()); ++x)
      least = std::min(least, s.counts()[y * film.blocks_across() + x]);
  return least;
}

std::vector<TileStatus> tile_status(const Setup& setup, const Sampling& sampling,
                                    const ImageProgress& progress, bool flags) {
  const std::vector<film::TileError> errors =
      flags || !sampling.adaptive() ? progress.tile_errors() : std::vector<film::TileError>();
  std::vector<TileStatus> tiles(sampling.adaptive() ? sampling.adaptive()->tiles().size() : errors.size());
  const double target = setup.settings.real("sampling.target_error");
  const auto side = setup.tile_side();
  const size_t across = (setup.film->width() + side - 1) / side;
  for (size_t i = 0; i < tiles.size(); ++i) {
    TileStatus& t = tiles[i];
    const auto along = [&](size_t index, uint32_t whole) {
      return std::min(whole, (static_cast<uint32_t>(index) + 1) * side) - static_cast<uint32_t>(index) * side;
    };
    t.pixels = along(i % across, setup.film->width()) * along(i / across, setup.film->height());
    if (const schedule::AdaptiveSchedule* adaptive = sampling.adaptive()) {
      const schedule::Tile& known = adaptive->tiles()[i];
      t.samples = known.samples;
      if (known.samples >= 2) t.error = known.error;
      t.records = known.records, t.interpolation = known.interpolation;
      t.state = known.state == schedule::TileState::resting ? shared::k_tile_done
                                                            : static_cast<uint32_t>(known.state);
      t.earlier_error = known.earlier.error, t.earlier_samples = known.earlier.samples;
    } else {
      t.samples = sampling.balanced() ? least_samples(*sampling.balanced(), *setup.film, side, i)
                                      : sampling.samples();
      if (errors[i].pixels > 0) {
        t.error = static_cast<float>(errors[i].relative);
        t.records = static_cast<float>(errors[i].relative_lookup_noise);
        t.interpolation = static_cast<float>(errors[i].relative_interpolation);
        t.state = t.sum() <= target ? shared::k_tile_done
                  : sampling.done() ? shared::k_tile_capped
                                    : shared::k_tile_active;
      }
    }
    t.heavy_tailed = flags && errors[i].heavy_tailed && t.samples >= k_tail_samples;
  }
  return tiles;
}

void AccuracyKeeper::follow(const Renderer& r, uint64_t scene_id) {
  if (!r.ready()) return;
  if (r.restarts() != restarts_) {
    restarts_ = r.restarts();
    const uint64_t run = now_.run + 1;
    now_ = {};
    now_.run = run;
    passes_ = r.sampling().passes();
    pass_ms_.clear(), pass_paths_ = 0;
    changed_ = true;
  }
  now_.scene_id = scene_id;
  if (r.sampling().passes() != passes_) note_pass(r);
  if (r.progress().ledger().changes() == now_.ledger.changes()) return;
  now_.ledger = r.progress().ledger();
  const auto& lines = now_.ledger.entries();
  double hardest = 0;
  if (r.sampling().adaptive())
    for (const schedule::Tile& t : r.sampling().adaptive()->tiles())
      if (t.state != schedule::TileState::capped && t.state != schedule::TileState::resting && t.samples >= 2)
        hardest = std::max(hardest, double{t.sum()});
  now_.hardest.resize(lines.size(), hardest);
  if (!lines.empty()) now_.hardest.back() = hardest;
  changed_ = true;
}

void AccuracyKeeper::note_pass(const Renderer& r) {
  passes_ = r.sampling().passes();
  const transport::TransportStats& stats = r.stats();
  PassStatus pass;
  if (pass_ms_.empty())
    for (const transport::StageSum& s : r.progress().prepared().stages) pass_ms_.push_back(s.ms);
  now_.stages.clear();
  for (size_t i = 0; i < stats.stages.size(); ++i) {
    now_.stages.push_back(stats.stages[i].name);
    pass.stage_ms.push_back(static_cast<float>(stats.stages[i].ms - (i < pass_ms_.size() ? pass_ms_[i] : 0)));
    if (i < pass_ms_.size())
      pass_ms_[i] = stats.stages[i].ms;
    else
      pass_ms_.push_back(stats.stages[i].ms);
  }
  pass.paths = stats.paths - pass_paths_;
  pass_paths_ = stats.paths;
  pass.samples = r.sampling().adaptive() ? r.sampling().adaptive()->most_samples()
                                         : uint32_t(r.sampling().mean_samples());
  now_.passes.push_back(std::move(pass));
  if (now_.passes.size() > k_passes) now_.passes.pop_front();
  changed_ = true;
}

std::shared_ptr<const Accuracy> AccuracyKeeper::publish(const Renderer& r, bool tiles) {
  if (published_ && !changed_ && !tiles) return published_;
  if (tiles || changed_) {
    now_.settings = r.settings().all();
    now_.adaptive = r.sampling().adaptive() != nullptr;
    now_.finished = r.done();
    now_.target = r.settings().real("sampling.target_error");
    now_.min_samples = r.sampling().adaptive() ? r.sampling().adaptive()->options().min_samples : 0;
    now_.max_samples = r.sampling().max_samples();
    now_.tile = r.setup().tile_side();
    now_.across = (r.film().width() + now_.tile - 1) / now_.tile;
    now_.pixels = double(r.film().width()) * r.film().height();
    now_.reference = r.progress().reference() ? r.progress().reference()->file.filename().string() : "";
    now_.reference_applies = r.progress().reference_applies();
    for (size_t c = 0; c < now_.bias.size(); ++c) now_.bias[c] = r.progress().bias(c);
    now_.tiles.clear();
    const bool shown = r.output().view().tiles > 0;
    if (shown || now_.adaptive) now_.tiles = tile_status(r.setup(), r.sampling(), r.progress(), shown);
  }
  now_.paths = double(r.stats().paths), now_.rays = double(r.stats().rays);
  if (now_.adaptive && (tiles || changed_)) now_.forecast = seconds_to(now_, now_.target);
  changed_ = false;
  published_ = std::make_shared<const Accuracy>(now_);
  return published_;
}

}  // namespace lucerna::session
