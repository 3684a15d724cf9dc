#include "session/sampling.h"

#include <bit>

#include "session/image_progress.h"

namespace lucerna::session {

void Sampling::start(schedule::UniformSchedule schedule, const schedule::Rectangle& region) {
  uniform_ = std::move(schedule), adaptive_.reset(), balanced_.reset();
  region_ = region;
}

void Sampling::start(schedule::AdaptiveSchedule schedule) {
  adaptive_.emplace(std::move(schedule)), balanced_.reset();
  region_ = adaptive_->options().region;
}

bool Sampling::done() const {
  if (judged_otherwise()) return false;
  return adaptive_ ? adaptive_->done() : balanced_ ? balanced_->done() : uniform_.done();
}

uint32_t Sampling::samples() const {
  return adaptive_   ? adaptive_->least_samples()
         : balanced_ ? balanced_->least_samples()
                     : uniform_.complete();
}

uint32_t Sampling::max_samples() const {
  return adaptive_   ? adaptive_->options().max_samples
         : balanced_ ? balanced_->options().samples
                     : uniform_.samples();
}

uint32_t Sampling::passes() const {
  return adaptive_ ? adaptive_->rounds() : balanced_ ? balanced_->rounds() : uniform_.passes();
}

std::vector<uint32_t> Sampling::counts() const {
  return adaptive_ ? adaptive_->counts() : balanced_ ? balanced_->counts() : uniform_.counts();
}

uint32_t Sampling::mark() const {
  if (balanced_) return std::bit_floor(uint32_t(balanced_->mean_before_round()));
  const uint32_t most = most_samples();
  return std::has_single_bit(most) ? most : 0;
}

uint32_t Sampling::most_samples() const {
  if (balanced_) return balanced_->most_samples();
  if (!adaptive_) return uniform_.complete();
  if (!whole()) return adaptive_->most_samples();
  const std::vector<uint32_t> all = counts();
  return all.empty() ? 0 : *std::max_element(all.begin(), all.end());
}

std::optional<schedule::Rectangle> Sampling::chosen_region() const {
  const auto region = schedule::parse_region(setup_.settings.text("sampling.region"), "sampling.region");
  if (!region) return std::nullopt;
  return schedule::pixels_of(*region, setup_.width, setup_.height);
}

bool Sampling::region_due() const { return region_waits_ && samples() >= k_around_region; }

schedule::Rectangle Sampling::scheduled_region() {
  const std::optional<schedule::Rectangle> pixels = chosen_region();
  region_waits_ = pixels && interactive_ && samples() < k_around_region;
  return pixels && !region_waits_ ? schedule::blocks_of(*pixels) : schedule::Rectangle{};
}

void Sampling::restart() {
  seen_ = setup_.seen_range();
  start(schedule::UniformSchedule(), {});
  const schedule::Rectangle blocks = scheduled_region();
  if (setup_.settings.text("sampling.mode") == "adaptive")
    start(schedule::AdaptiveSchedule(setup_.film->blocks_across(), setup_.film->blocks_down(),
                                     adaptive_options(blocks)));
  else
    start_even(std::vector<uint32_t>(setup_.film->blocks(), 0), blocks);
}

void Sampling::start_even(std::vector<uint32_t> have, const schedule::Rectangle& region) {
  const auto samples = uint32_t(setup_.settings.integer("samples"));
  const uint32_t slots = setup_.engine->wavefront().slots();
  const bool one = setup_.engine->in_rounds();
  if (setup_.settings.text("sampling.mode") == "balanced" && !one) {
    start(schedule::UniformSchedule(), region);
    balanced_.emplace(setup_.film->blocks_across(),
                      schedule::BalancedOptions{.samples = samples, .slots = slots, .region = region},
                      std::move(have));
    return;
  }
  if (region == schedule::Rectangle{}) {
    start(schedule::UniformSchedule(std::move(have), samples, slots, one), region);
    return;
  }
  std::vector<uint32_t> blocks =
      schedule::indices_of(region, setup_.film->blocks_across(), setup_.film->blocks_down());
  start(schedule::UniformSchedule(std::move(have), std::move(blocks), samples, slots, one), region);
}

void Sampling::change(const ImageProgress& progress) {
  seen_ = setup_.seen_range();
  std::vector<uint32_t> have = counts();
  const schedule::Rectangle blocks = scheduled_region();
  if (setup_.settings.text("sampling.mode") == "adaptive") {
    std::vector<schedule::TileErrors> errors;
    progress.estimate_error();
    for (const film::TileError& t : film::tile_errors(*setup_.film, setup_.tile_side()))
      errors.push_back({float(t.relative), float(t.relative_lookup_noise), float(t.relative_interpolation)});
    start(schedule::AdaptiveSchedule(setup_.film->blocks_across(), setup_.film->blocks_down(),
                                     adaptive_options(blocks), have, errors));
  } else {
    start_even(std::move(have), blocks);
  }
}

void Sampling::change_samples() {
  const auto samples = uint32_t(setup_.settings.integer("samples"));
  if (balanced_) return balanced_->set_samples(samples);
  uniform_.set_samples(samples);
}

void Sampling::retarget() {
  if (adaptive_) adaptive_->retarget(adaptive_options(region_));
}

schedule::AdaptiveOptions Sampling::adaptive_options(const schedule::Rectangle& region) const {
  return {
      .tile = setup_.tile_side(),
      .target_error = float(setup_.settings.real("sampling.target_error")),
      .min_samples = uint32_t(setup_.settings.integer("sampling.min_samples")),
      .max_samples = uint32_t(setup_.settings.integer("sampling.max_samples")),
      .slots = setup_.engine->wavefront().slots(),
      .one_sample = setup_.engine->in_rounds(),
      .region = region,
  };
}

}  // namespace lucerna::session
