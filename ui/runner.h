#pragma once
// Runs the steps of a script and the lines of the console, a few per frame, and measures.
#include <deque>
#include <optional>

#include "script.h"
#include "state.h"

namespace lucerna::ui {

/// Metadata that identifies pictures of the window.
inline constexpr const char* k_window_mark = "window";

class Runner {
 public:
  /// Registers the commands of script.h at the workspace and reads a script (see parse_script); `stay`: its
  /// end does not end the program. The workspace's commands refer to this object afterwards.
  Runner(Ui& ui, const std::vector<std::string>& lines, const std::string& name, bool stay = false);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Runs steps until one has to wait; call at the start of each frame.
  void advance();
  /// Call after each presented frame. `interval_ms`: since the previous one.
  void presented(double interval_ms);

  /// True if steps of a script remain.
  bool running() const { return !steps_.empty(); }
  /// True if frames must be drawn continuously.
  bool measuring() const { return measure_.has_value(); }

 private:
  struct Measure {
    double start = 0, end = 0, next_move = 0;
    std::vector<double> frames, coarse;
    double moved_at = -1;
    scene::Camera target;
    int moves = 0;
    bool begun = false;  ///< a frame has been shown since
  };

  /// True while earlier commands do not yet have the effect that the step reads.
  bool waits_for_earlier(const Step& step) const;
  /// True if the step is done; false: call again.
  bool carry_out(const Step& step);
  /// Ends the step's script, and the program if the script is its own.
  void give_up(const Step& step);
  void run_script(const std::string& file);
  void measure(double seconds);
  bool measured();
  void console(const std::string& line);
  void add_commands();
  void add_script_commands();  ///< that act on scripts and the program as a whole
  void add_mouse_commands();   ///< pointer events, including dropped files
  void add_key_commands();
  /// For commands that are done after two drawn frames.
  std::function<bool(const commands::Arguments&)> drawn();

  Ui& ui_;
  std::deque<Step> steps_;
  commands::Line current_;  ///< begun and not done
  double began_ = 0;        ///< when
  std::optional<Measure> measure_;
  int frames_ = 0;          ///< drawn since the step began
  bool in_script_ = false;  ///< the running command belongs to a script
  int settled_ = 0;         ///< consecutive frames without pending work
};

}  // namespace lucerna::ui
