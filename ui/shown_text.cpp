#include "shown_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "chart.h"

namespace lucerna::ui {

bool shows_former(const session::Snapshot& s) {
  constexpr double k_least_stale = 0.005;
  return s.stale > k_least_stale;
}

std::vector<std::string> shown_texts(const session::Snapshot& s) {
  constexpr double k_least_filtered = 0.02;
  const std::string off = s.shown_error ? percent_text(s.shown_error->median) + " off" : "";
  if (shows_former(s)) {
    const std::string before = fmt::format("{:.0f} % from {}", 100 * s.stale,
                                           s.stale_is_preview ? "the preview" : "before the edit");
    return off.empty() ? std::vector{before} : std::vector{off + ", " + before, before};
  }
  if (off.empty())
    return s.filtered > k_least_filtered ? std::vector<std::string>{"filtered"} : std::vector<std::string>{};
  return {fmt::format("{}, worst tenth {}", off, percent_text(s.shown_error->worst_tenth)), off};
}

std::string usable_text(const session::Snapshot& s) {
  if (!s.shown_error) return "";
  if (session::usable(*s.shown_error)) return s.coarse ? ": usable, still coarse" : ": usable";
  const double excess = std::max(s.shown_error->median / session::k_usable_error.median,
                                 s.shown_error->worst_tenth / session::k_usable_error.worst_tenth);
  // During preparation the picture has little of the time.
  if (!s.preparing.empty()) return ", not usable yet";
  constexpr double k_least_seconds = 0.1;
  const double seconds = s.seconds - s.prepared_seconds;
  if (seconds <= k_least_seconds) return "";
  return fmt::format(", usable in about {}", about_text(seconds * (excess * excess - 1)));
}

std::string paused_text(const session::Snapshot& s) {
  if (!s.paused || s.samples > 0 || !s.activity.empty()) return "";
  return "Paused before the first sample. Space resumes.";
}

}  // namespace lucerna::ui
