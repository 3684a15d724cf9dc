#pragma once
// Scripted runs of the window, for tests, screenshots and measurements, and to do a saved session again: one
// command a line, as commands/registry.h reads them; # starts a comment. Besides the commands of the
// workspace (commands/) and of the window (window_commands.cpp) these, which only a window can carry out:
//
//   quit [STATUS]            ends the program, once all that was commanded is done; without a status with 1
//                            where an error was logged since the script began, else with 0
//   screenshot [FILE]        writes the window as PNG once its panels have settled; a file that is there
//                            already is replaced only if it is such a picture
//   measure SECONDS          draws all the time, moves the camera every 1.5 s, and prints one JSON line:
//                            {"measure": {"seconds", "frames", "frame_ms_p50", "frame_ms_p95",
//                            "frame_ms_max", "coarse_ms_median", "coarse_ms_max", "moves", "answered",
//                            "picture": [w, h]}}
//   script.run FILE          carries out another script, but none that is being carried out
//   drop FILE                does what dropping the file on the window does
//   mouse.move X Y | mouse.down [BUTTON] | mouse.up [BUTTON] | key NAME | type TEXT
//
// Waiting for a scene, for samples or for a file longer than limit=SECONDS (300 when not said) fails. When a
// step fails its message is logged and the program ends with 1; a script that was run from the console stops
// there. The end of the program's own script is a 'quit', unless the window is to stay.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "commands/registry.h"

namespace lucerna::ui {

/// A script that is being carried out.
struct Call {
  std::string file;                ///< in the one form that it has; "" where it is none
  std::shared_ptr<const Call> by;  ///< whose step it is; null: the program's own, or the console's
  bool own = false;                ///< the program's own
  uint64_t errors = 0;             ///< that had been logged before it began
};

struct Step {
  std::string line;
  std::string where;  ///< "NAME: line 3", for messages
  std::shared_ptr<const Call> call = {};
};

/// Checks every line. Throws Error "NAME: line N: ..." at the first mistake.
std::vector<Step> parse_script(const commands::Registry& registry, const std::vector<std::string>& lines,
                               const std::string& name);
/// The lines of a file. Throws Error when it cannot be read, is a folder or no text.
std::vector<std::string> read_script(const std::string& file);

/// The value below which a share `p` (0..1) of the values lies; linear between neighbours. 0 for none.
double percentile(std::vector<double> values, double p);

}  // namespace lucerna::ui
