#include "commands/exposure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/future.h"
#include "base/log.h"
#include "commands/text.h"
#include "plan/settings.h"

namespace lucerna::commands {

void Exposure::measure(std::optional<vec2> at) { measure(at, Reason::request); }

void Exposure::measure(std::optional<vec2> at, Reason reason, uint64_t step) {
  failure_.clear();
  measuring_ = Measuring{open_.session.measure(at, open_.id()),
                         at.has_value(),
                         reason,
                         step,
                         camera_.view_scene,
                         open_.setting("film.ev")};
}

bool Exposure::allowed(bool interactive) const {
  const std::string& when = open_.setting("film.exposure_at_load");
  return interactive ? when != "never" : when == "always";
}

void Exposure::daylight_replaced(bool interactive, uint64_t step) {
  if (camera_.view_scene == open_.id() && allowed(interactive)) measure(std::nullopt, Reason::daylight, step);
}

bool Exposure::done() const {
  if (!failure_.empty()) throw Error("", failure_);
  return !measuring_;
}

void Exposure::begin_scene() {
  measuring_.reset();
  const auto sets = [](const auto& settings) {
    return std::any_of(settings.begin(), settings.end(),
                       [](const auto& setting) { return setting.first == "film.ev"; });
  };
  const bool sets_exposure = sets(open_.scene->settings) || sets(open_.scene->own_settings);
  due_ = sets_exposure || std::exchange(given_, false) ? 0 : camera_.view_scene;
}

void Exposure::follow(bool interactive, const std::function<void(const Found&)>& found) {
  if (due_ != 0 && due_ == camera_.view_scene && open_.snapshot && !open_.snapshot->rgba.empty() &&
      !measuring_) {
    if (allowed(interactive)) measure(std::nullopt, Reason::load);
    due_ = 0;
  }
  if (!measuring_ || !is_ready(measuring_->result)) return;
  const Measuring requested = *measuring_;
  measuring_.reset();
  if (requested.scene != camera_.view_scene) return;
  try {
    const film::Brightness brightness = requested.result.get();
    if (!brightness.ev)
      throw Error("", requested.at_point ? "it is black there: no exposure makes it grey"
                                         : "the picture is black: no exposure shows it");
    const float ev = std::round(*brightness.ev * 100) / 100;
    // A value that the user has set meanwhile stays.
    if (requested.reason == Reason::load &&
        open_.setting("film.ev") != plan::find_option("film.ev")->fallback)
      return;
    if (requested.reason == Reason::daylight &&
        (open_.setting("film.ev") != requested.ev ||
         std::abs(ev - float(open_.setting_real("film.ev"))) <= k_tolerated_ev))
      return;
    if (number_text(ev) != open_.setting("film.ev")) found({ev, requested.reason, requested.step});
  } catch (const std::exception& error) {
    failure_ = error.what();
    if (requested.reason == Reason::request) log::error("exposure: {}", error.what());
  }
}

}  // namespace lucerna::commands
