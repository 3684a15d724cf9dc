#pragma once
// Scripted runs of the window, for tests, screenshots and measurements. One step a line; words are separated
// by blanks, a word with blanks is put in double quotes; # starts a comment.
//
//   wait SECONDS                 lets the window run
//   wait_scene                   until a scene is loaded (or has failed to: then the script fails)
//   wait_samples N               until the picture holds N complete samples a pixel, or is finished
//   load FILE                    opens a scene
//   set KEY VALUE                a setting
//   camera NAME|NUMBER           takes a scene camera (numbers start at 1)
//   orbit DX DY | look DX DY     turns, radians
//   pan DX DY                    drags by pixels
//   dolly STEPS                  comes closer by tenths
//   fly RIGHT UP FORWARD         metres
//   frame                        frames the selection, or the scene
//   select material|instance|light N   selects (numbers start at 1)
//   solo N                       shows component N alone (1 to 4); again: as before
//   size W H                     resizes the window
//   tab                          hides or shows the panels
//   open_dialog | save_dialog    opens the file dialog
//   dismiss                      takes away the error strip, or the dialog
//   pause | resume | restart | reload | cancel
//   save FILE                    writes the picture (.exr or .png)
//   screenshot FILE              writes the window as PNG
//   measure SECONDS              draws all the time, moves the camera every 1.5 s, and prints one JSON line
//   on standard output:
//                                {"measure": {"seconds", "frames", "frame_ms_p50", "frame_ms_p95",
//                                "frame_ms_max", "coarse_ms_median", "coarse_ms_max", "moves", "picture": [w,
//                                h]}}
//   quit [STATUS]                ends the program (default 0)
//
// A wait that lasts longer than 300 seconds fails. When a step fails its message is logged and the program
// ends with 1.
#include <string>
#include <vector>

namespace lucerna::ui {

struct Step {
  std::string verb;
  std::vector<std::string> text;  ///< the arguments as written
  std::vector<double> number;     ///< the arguments that are numbers, in order; NaN for those that are not
  std::string where;              ///< "NAME: line 3", for messages
};

/// Parses and checks verbs and arguments. Throws Error "NAME: line N: ..." at the first mistake.
std::vector<Step> parse_script(const std::vector<std::string>& lines, const std::string& name);

/// The value below which a share `p` (0..1) of the values lies; linear between neighbours. 0 for none.
double percentile(std::vector<double> values, double p);

}  // namespace lucerna::ui
