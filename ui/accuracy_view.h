#pragma once
// What the accuracy panel shows besides the picture's figures: earlier runs, and the target's line.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "accuracy_plot.h"
#include "commands/open_scene.h"
#include "runs.h"

namespace lucerna::ui {

class AccuracyView {
 public:
  explicit AccuracyView(const commands::OpenScene& open) : open_(open) {}

  Runs runs;
  /// Sets the relative error of the forecast in uniform sampling. Adaptive sampling then starts with it.
  void set_what_if(double error) { what_if_ = error, what_if_asked_ = true; }
  /// Position of the target line: the setting in adaptive sampling, set_what_if() in uniform sampling.
  double target() const;
  /// Forecast of the seconds of rendering to reach it.
  std::optional<stats::Band> forecast();
  /// Settings, with values, that change together with one, so that the line stays in place when the sampling
  /// mode changes.
  std::vector<std::pair<std::string, std::string>> set_with(const std::string& key, const std::string& value);

  std::optional<PlotRange> held_range;  ///< fixed range of the plot while the target is dragged
  float held_offset = 0;                ///< of the pointer from the line

 private:
  const commands::OpenScene& open_;
  double what_if_ = 0.01;
  bool what_if_asked_ = false;  ///< set after the setting
  struct {
    std::shared_ptr<const session::Accuracy> of;
    double target = 0;
    std::optional<stats::Band> band;
  } forecast_;
};

}  // namespace lucerna::ui
