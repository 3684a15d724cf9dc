#pragma once
// Carries out the steps of a script, a little every frame, and measures.
#include <optional>

#include "script.h"
#include "state.h"

namespace lucerna::ui {

class Runner {
 public:
  explicit Runner(std::vector<Step> steps) : steps_(std::move(steps)) {}

  /// Goes on as far as it can without waiting; call at the start of every frame.
  void advance(Ui& ui);
  /// Call after every presented frame. `interval_ms`: since the frame before was presented.
  void presented(Ui& ui, double interval_ms);

  bool running() const { return next_ < steps_.size(); }
  /// Whether frames are to be drawn all the time.
  bool measuring() const { return measure_.has_value(); }
  std::optional<int> status;                ///< set when the program is to end
  std::optional<std::string> screenshot;    ///< file wanted of the next frame
  std::optional<std::pair<int, int>> size;  ///< window size wanted

 private:
  struct Measure {
    double start = 0, end = 0, next_move = 0;
    std::vector<double> frames, coarse;
    double moved_at = -1;
    uint64_t snapshot_at_move = 0;
    scene::Camera target;
    int moves = 0;
  };

  /// True when the step is done; false: to be asked again.
  bool step(Ui& ui, const Step& step);
  bool measure(Ui& ui, const Step& step);
  void fail(const Step& step, const std::string& why);

  std::vector<Step> steps_;
  size_t next_ = 0;
  double began_ = -1;  ///< when the step began, or -1
  uint64_t scene_before_ = 0;
  int frames_left_ = 0;
  uint64_t errors_before_ = 0;
  std::optional<Measure> measure_;
};

}  // namespace lucerna::ui
