#include "commands/live_difference.h"

#include "base/future.h"
#include "commands/view_transform.h"

namespace lucerna::commands {
namespace {

constexpr double k_more_light = 1.25, k_more_figures = 2;  // factors on the samples

bool rests(const session::Snapshot& s) { return s.resting || s.finished || s.paused; }

}  // namespace

std::string LiveDifference::shown_light(const OpenScene& open) {
  std::string text = open.snapshot->accuracy ? std::to_string(open.snapshot->accuracy->run) : "";
  for (const char* key : {"film.layer", "relight.mix", "preview.filter"}) text += " " + open.setting(key);
  for (const char* component : session::k_component_names)
    text += " " + open.setting(std::string("show.") + component);
  // A picture that rests may be filtered a moment later.
  if (rests(*open.snapshot) && open.snapshot->filtered >= 1) text += " filtered";
  return text;
}

void LiveDifference::take_light() {
  if (!is_ready(requested_)) return;
  try {
    light_ = requested_.get();
    light_of_ = requested_for_;
    refused_ = false;
    ++version_;
  } catch (const std::exception& error) {
    light_.reset(), figures_.reset();
    light_of_ = requested_for_;
    refused_ = true;
    problem_ = error.what();
  }
  requested_ = {};
}

void LiveDifference::take_figures() {
  if (!is_ready(measuring_)) return;
  try {
    const Measured measured = measuring_.get();
    if (measured.held != held_ || measured.version < oldest_ || measured.view != view_) return;
    figures_ = measured.figures;
    figures_version_ = measured.version;
  } catch (const std::exception& error) {  // memory
    refused_ = true;
    problem_ = error.what();
  }
}

void LiveDifference::restart() {
  requested_ = {}, light_.reset(), figures_.reset(), light_of_.clear();
  oldest_ = version_ + 1;
}

void LiveDifference::follow(const OpenScene& open, const HeldResult* held) {
  take_light();
  take_figures();
  if (held_ != (held ? held->id : 0)) {
    held_ = held ? held->id : 0;
    figures_.reset(), figures_samples_ = 0;
  }
  comparable_ = false;
  if (!held || !open.snapshot || !open.scene || open.loading()) return problem_.clear();
  const session::Snapshot& s = *open.snapshot;
  const std::string why_not = why_not_comparable(*held, s, open.scene->name);
  if (!why_not.empty() || !refused_) problem_ = why_not;
  if (!why_not.empty()) return figures_.reset();
  comparable_ = true;
  if (const film::ViewTransform view = view_transform(open); view != view_) {
    view_ = view;
    figures_.reset(), figures_samples_ = 0;
  }
  const std::string now = shown_light(open);
  if (now != light_of_ && light_) {
    figures_.reset(), figures_samples_ = 0;
    light_.reset(), oldest_ = version_ + 1;
  }
  if (s.samples == 0 || !open.up_to_date()) return;

  const bool old = now != light_of_ || (light_ && s.mean_samples > light_->samples &&
                                        (rests(s) || s.mean_samples >= k_more_light * light_->samples));
  if (old && !requested_.valid()) {
    requested_for_ = now;
    requested_ = open.session.held_picture(open.id());
  }
  const bool fits = light_ && !refused_ && light_->light.size() == held->picture->light.size();
  const bool due =
      fits && (!figures_ || (figures_version_ < version_ &&
                             (light_->samples >= k_more_figures * figures_samples_ || rests(s))));
  if (due && !measuring_.valid()) {
    figures_samples_ = light_->samples;
    measuring_ = std::async(std::launch::async, [live = light_, other = held->picture, id = held->id,
                                                 version = version_, view = view_] {
      const auto measure = other->displayed ? film::display_difference : film::light_difference;
      return Measured{measure(live->width, live->light, other->light, view), id, version, view};
    });
  }
}

}  // namespace lucerna::commands
