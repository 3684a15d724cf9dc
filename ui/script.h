#pragma once
// Scripts for tests, screenshots, measurements and saved sessions: one command per line, as
// commands/registry.h reads them; # starts a comment. Besides the commands of the workspace (commands/) and
// of the window (window_commands.cpp) there are these:
//
//   quit [STATUS]            ends the program after all commands are done; without a status with 1
//                            if an error was logged since the script began, else with 0
//   screenshot [FILE]        writes the window as PNG once its panels have settled; an existing file
//                            is replaced only if it is such a picture
//   measure SECONDS          draws continuously, moves the camera every 1.5 s, and prints one JSON line:
//                            {"measure": {"seconds", "frames", "frame_ms_p50", "frame_ms_p95",
//                            "frame_ms_max", "coarse_ms_median", "coarse_ms_max", "moves", "answered",
//                            "picture": [w, h]}}
//   script.run FILE          runs another script, unless it is already running
//   drop FILE                does what dropping the file on the window does
//   mouse.move X Y | mouse.down [BUTTON] | mouse.up [BUTTON] | key NAME | type TEXT
//
// Waiting for a scene, for samples or for a file longer than limit=SECONDS (default 300) fails. If a step
// fails, its message is logged and the program ends with 1; a script run from the console stops. The end of
// the program's own script is a 'quit', unless the window is to stay.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "commands/registry.h"

namespace lucerna::ui {

/// A running script.
struct Call {
  std::string file;                ///< canonical path; "" if it is no file
  std::shared_ptr<const Call> by;  ///< the calling script; null: the program's own, or the console's
  bool own = false;                ///< the program's own
  uint64_t errors = 0;             ///< logged before it began
};

struct Step {
  std::string line;
  std::string where;  ///< "NAME: line 3", for messages
  std::shared_ptr<const Call> call = {};
};

/// Checks each line. Throws Error "NAME: line N: ..." at the first mistake.
std::vector<Step> parse_script(const commands::Registry& registry, const std::vector<std::string>& lines,
                               const std::string& name);
/// The lines of a file. Throws Error if it cannot be read, is a folder or no text.
std::vector<std::string> read_script(const std::string& file);

/// The value below which a share `p` (0..1) of the values lies, linear between neighbours; 0 for no values.
double percentile(std::vector<double> values, double p);

}  // namespace lucerna::ui
