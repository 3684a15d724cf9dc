#include "commands/path_inquiry.h"

#include <fmt/ranges.h>

#include "base/future.h"
#include "base/log.h"

namespace lucerna::commands {

void PathInquiry::refresh() {
  if (done() || !is_ready(traced)) return;
  try {
    paths = traced.get();
    order = recording::by_contribution(*paths);
    double light = 0;
    for (const recording::Path& path : paths->paths) {
      const double y = recording::luminance_of(paths->events_of(path));
      light += y, dark += y <= 0 ? 1 : 0;
    }
    mean_light = light / double(std::max<size_t>(order.size(), 1));
    std::string text = fmt::format("{} paths of pixel {} {}: mean light {:.4g}", order.size(),
                                   order.empty() ? 0 : paths->paths[0].pixel % paths->width,
                                   order.empty() ? 0 : paths->paths[0].pixel / paths->width, mean_light);
    if (!order.empty()) text += "; brightest: " + recording::path_text(*paths, order[0]);
    if (const uint64_t lost = paths->lost())
      text += fmt::format("; {} events had no room: their light is missing", lost);
    log::info("{}", text);
  } catch (const std::exception& error) {
    problem = error.what();
    log::error("{}", problem);
  }
  traced = {};
}

session::ShownPaths PathInquiry::shown() const {
  const bool follows = paths && followed >= 0 && size_t(followed) < order.size();
  return {paths, follows ? int(order[size_t(followed)]) : -1, follows ? vertex : -1};
}

void NoiseInquiry::refresh() {
  if (done() || !is_ready(explained)) return;
  try {
    report = explained.get();
    log::info("{}", fmt::join(recording::noise_lines(*report), "\n"));
  } catch (const std::exception& error) {
    problem = error.what();
    log::error("{}", problem);
  }
  explained = {};
}

}  // namespace lucerna::commands
