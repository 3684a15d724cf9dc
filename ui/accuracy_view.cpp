#include "accuracy_view.h"

#include <fmt/format.h>

namespace lucerna::ui {

double AccuracyView::target() const {
  const bool adaptive = open_.setting("sampling.mode") == "adaptive";
  return adaptive ? open_.setting_real("sampling.target_error") : what_if_;
}

std::optional<stats::Band> AccuracyView::forecast() {
  if (!open_.snapshot || !open_.snapshot->accuracy) return std::nullopt;
  const session::Accuracy& a = *open_.snapshot->accuracy;
  const double wanted = target();
  if (a.adaptive && wanted == a.target) return a.forecast;
  if (forecast_.of != open_.snapshot->accuracy || forecast_.target != wanted)
    forecast_ = {open_.snapshot->accuracy, wanted, session::seconds_to(a, wanted)};
  return forecast_.band;
}

std::vector<std::pair<std::string, std::string>> AccuracyView::set_with(const std::string& key,
                                                                        const std::string& value) {
  if (key == "sampling.target_error") what_if_asked_ = false;
  if (key != "sampling.mode" || value == open_.setting(key)) return {};
  if (value == "uniform") {
    what_if_ = open_.setting_real("sampling.target_error"), what_if_asked_ = false;
  } else if (std::exchange(what_if_asked_, false)) {
    return {{"sampling.target_error", fmt::format("{:.4g}", what_if_)}};
  }
  return {};
}

}  // namespace lucerna::ui
