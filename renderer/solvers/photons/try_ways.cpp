#include <algorithm>
#include <utility>

#include "solvers/photons/solver.h"

namespace lucerna::photons {

using namespace shared;
using solvers::Cancel, solvers::Picture, solvers::Task;

namespace {

constexpr uint32_t k_trial_paths = 1u << 16, k_trial_round = 0xfffffd00u, k_trial_samples = 2;

/// Components that may be delegated; first none. Not secondary light without tertiary: photons would have to
/// compute at the second diffuse vertex what they now compute at the first.
std::vector<uint32_t> ways(uint32_t own) {
  const uint32_t deep = own & k_deep;
  if (deep == 0) return {};
  std::vector<uint32_t> all{0, deep};
  if (deep == k_deep) all.push_back(paths::k_tertiary_bit);
  return all;
}

}  // namespace

void PhotonSolver::begin_trials(const Picture& picture, bool stale) {
  // Records' rays that end in photons continue for all other light, and have no pixels to compare.
  const bool tries = sends_ && lights_.power() > 0 && !feeds_ && (picture.task.own & k_deep) != 0 &&
                     picture.task.settings.boolean("photons.efficiency");
  if (!stale && tries == tries_) return;
  tries_ = tries, tried_ = false;
  trials_.clear(), trial_film_.reset();
  delegate(picture, 0);
}

void PhotonSolver::read_standing(transport::Wavefront& wavefront, bool on) {
  if (std::exchange(reads_standing_, on) != on) wavefront.rebind_lookup();
}

void PhotonSolver::delegate(const Picture& picture, uint32_t components) {
  delegated_ = components;
  route(picture.task);
}

uint32_t PhotonSolver::missing(const Picture& picture) const {
  // Paths without records continue for it on their own.
  if (feeds_) return 0;
  const bool known = irradiance_ ? irradiance_->readable() : shown_map().complete();
  return known ? 0 : picture.task.own & k_drafted & ~delegated_;
}

bool PhotonSolver::try_ways(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  const Frame small = small_frame(picture);
  const double pixels = double(small.width) * small.height;
  const auto begin_trial = [&] {
    eye_schedule_.emplace((small.width + 7) / 8 * ((small.height + 7) / 8), k_trial_samples,
                          wavefront.slots(), true);
    trial_film_->clear(wavefront.stream());
    map_.clear();
    delegate(picture, trials_.back().delegated);
  };
  const std::vector<uint32_t> all = ways(picture.task.own);
  if (trials_.empty()) {
    trial_film_ = std::make_unique<film::Film>(device_, small.width, small.height);
    trials_.push_back({.delegated = all[0], .judged = picture.task.own & k_deep});
    begin_trial();
  }
  Trial& trial = trials_.back();
  const uint32_t delegated = trial.delegated, looked_up = picture.task.own & k_deep & ~delegated;
  const bool by_rounds = reads_rounds();
  const schedule::UniformSchedule before = *eye_schedule_;
  const schedule::WorkItem item = eye_schedule_->next();
  Round round = round_of(picture, k_trial_round + item.blocks.front().first_sample);
  if (by_rounds && !(map_.complete() && map_.round() == round.number)) {
    *eye_schedule_ = before;
    round.paths = std::min(round.paths, k_trial_paths);
    round.lookup = lookup_of(picture, picture.frame, radius_law(picture.task.settings).at(k_typical_round));
    store_parts(round.parts);
    return map_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel);
  }
  read_standing(wavefront, irradiance_ && !by_rounds);
  // Paths that compute only own light. They read known irradiance, unless they are to continue as if it were
  // unknown.
  Task task = picture.task;
  task.own &= ~delegated;
  solvers::Routing routing = routing_of(task);
  if (irradiance_) routing.fallback = picture.task.own;
  Frame frame = picture.frame_for(routing, delegated);
  if (irradiance_ && delegated != 0) transport::compute_everything(frame);
  transport::set_delegated_tables(frame, frame);
  frame.width = small.width, frame.height = small.height;
  wavefront.set_frame(frame, picture.task.own);
  const uint64_t rays = wavefront.stats().rays;
  const bool complete = wavefront.try_out(item, *trial_film_, cancel);
  if (complete) trial.cost += double(wavefront.stats().rays - rays) / (k_trial_samples * pixels);
  wavefront.set_frame(picture.frame, picture.task.enabled);
  if (!complete) *eye_schedule_ = before;
  if (!eye_schedule_->done()) return complete;

  const double picture_pixels = double(picture.width) * picture.height;
  if (by_rounds) {
    const auto wanted = double(round.paths);
    // Discs scale with the picture's pixels, of which a trial's pixel covers several.
    if (!irradiance_ && looked_up != 0) {
      const double radius = radius_law(picture.task.settings).at(k_typical_round);
      trial.pixels_in_common = std::max(1.0, double(k_pi) * radius * radius * pixels / picture_pixels);
    }
    trial.cost += k_cost_lookup + k_cost_light_path * wanted / picture_pixels;
    for (size_t c = 0; c < trial.variance_factor.size(); ++c)
      if (!irradiance_ && (looked_up >> c & 1u) != 0)
        trial.variance_factor[c] = double(map_.figures().paths) / wanted;
  }
  if (irradiance_ && looked_up != 0) {
    trial.cost +=
        k_cost_light_path * double(standing_->figures().paths) / (picture_pixels * k_first_gather_samples);
  }
  trial.image = trial_film_->read();
  if (trials_.size() < all.size()) {
    trials_.push_back({.delegated = all[trials_.size()], .judged = trial.judged});
    begin_trial();
    return true;
  }
  delegate(picture, trials_[judge(trials_)].delegated);
  for (Trial& t : trials_) t.image = {};
  trial_film_.reset();
  map_.clear();
  tried_ = true;
  if (irradiance_ && delegated_ != 0) {
    irradiance_->clear();
    wavefront.rebind_lookup();
  }
  read_standing(wavefront, irradiance_ && delegated_ == 0 && !reads_rounds());
  return true;
}

}  // namespace lucerna::photons
