#pragma once
// Carries out the steps of a script and the lines of the console, a little every frame, and measures.
#include <deque>
#include <optional>

#include "script.h"
#include "state.h"

namespace lucerna::ui {

/// Metadata that tells a picture of the window from other files.
inline constexpr const char* k_window_mark = "window";

class Runner {
 public:
  /// Registers the commands of script.h at the workspace and reads a script (see parse_script); `stay`: its
  /// end does not end the program. The workspace's commands refer to this object from now on.
  Runner(Ui& ui, const std::vector<std::string>& lines, const std::string& name, bool stay = false);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Goes on as far as it can without waiting; call at the start of every frame.
  void advance();
  /// Call after every presented frame. `interval_ms`: since the frame before was presented.
  void presented(double interval_ms);

  /// Whether steps of a script are left.
  bool running() const { return !steps_.empty(); }
  /// Whether frames are to be drawn all the time.
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

  /// True while what was commanded before has not the effect yet that the step reads.
  bool waits_for_earlier(const Step& step) const;
  /// True when the step is done; false: to be asked again.
  bool carry_out(const Step& step);
  /// Ends the script that the step belongs to, and the program if it is its own.
  void give_up(const Step& step);
  void run_script(const std::string& file);
  void measure(double seconds);
  bool measured();
  void console(const std::string& line);
  void add_commands();
  void add_script_commands();  ///< that act on scripts and the program as a whole
  void add_mouse_commands();   ///< the pointer's doings, files dropped by it too
  void add_key_commands();
  /// For commands that are done when two frames have been drawn.
  std::function<bool(const commands::Arguments&)> drawn();

  Ui& ui_;
  std::deque<Step> steps_;
  commands::Line current_;  ///< begun and not done
  double began_ = 0;        ///< when
  std::optional<Measure> measure_;
  int frames_ = 0;          ///< drawn since the step began
  bool in_script_ = false;  ///< a command is run for a step, not for a person
  int settled_ = 0;         ///< times in a row that nothing was left to do
};

}  // namespace lucerna::ui
