#pragma once
// Runs scripts (commands/script_runner.h) and the lines of the console, and measures. Registers the commands
// of scripts that need a window:
//
//   screenshot [FILE]        writes the window as PNG once its panels have settled; an existing file
//                            is replaced only if it is such a picture
//   measure SECONDS          draws continuously, moves the camera every 1.5 s, and prints one JSON line:
//                            {"measure": {"seconds", "frames", "frame_ms_p50", "frame_ms_p95",
//                            "frame_ms_max", "coarse_ms_median", "coarse_ms_max", "moves", "answered",
//                            "picture": [w, h]}}
//   drop FILE                does what dropping the file on the window does
//   mouse.move X Y | mouse.down [BUTTON] | mouse.up [BUTTON] | key NAME | type TEXT
#include <optional>
#include <vector>

#include "commands/script_runner.h"
#include "log_view.h"
#include "requests.h"
#include "viewport.h"

namespace lucerna::ui {

/// Metadata that identifies pictures of the window.
inline constexpr const char* k_window_mark = "window";

/// The value below which a share `p` (0..1) of the values lies, linear between neighbours; 0 for no values.
double percentile(std::vector<double> values, double p);

class Runner {
 public:
  /// Registers the commands at the workspace, which refer to this object afterwards. `areas`: of the window's
  /// parts. All must outlive it.
  Runner(Viewport& viewport, const Areas& areas, LogView& log, Requests& requests,
         commands::ReportFolder& report);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  commands::ScriptRunner scripts;

  /// Runs lines of the console, then steps until one has to wait; call at the start of each frame.
  void advance();
  /// Call after each presented frame. `interval_ms`: since the previous one.
  void presented(double interval_ms);

  bool running() const { return scripts.running(); }
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

  void measure(double seconds);
  bool measured();
  void console(const std::string& line);
  void add_picture_commands();  ///< screenshots and measurements
  void add_mouse_commands();    ///< pointer events, including dropped files
  void add_key_commands();
  /// For commands that are done after two drawn frames.
  std::function<bool(const commands::Arguments&)> drawn();

  commands::Workspace& work_;
  Actions& actions_;
  const Viewport& viewport_;
  LogView& log_;
  Requests& requests_;
  std::optional<Measure> measure_;
};

}  // namespace lucerna::ui
