#pragma once
// The window: a lookdev viewer over one Session. It never waits for the renderer: it sends commands to the
// session and shows its snapshots.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "commands/script_runner.h"
#include "session/session.h"

namespace lucerna::ui {

struct ViewerOptions {
  std::filesystem::path scene;         ///< loaded at the start; empty: the window invites to open one
  int width = 1440, height = 900;      ///< of the window, in units of the desktop (pixels on X11)
  bool hidden = false;                 ///< no visible window (drawing and screenshots work all the same)
  float scale = 0;                     ///< of text and controls; 0: the desktop's
  bool remember = true;                ///< keep recent files and panel sizes in the user's state folder
  std::vector<std::string> set;        ///< settings, KEY=VALUE each, above those of the scene
  std::vector<std::string> script;     ///< steps carried out in order, one command a line: commands/script.h
  std::string script_name = "script";  ///< for messages: "NAME:3: ..."
  commands::Variables variables = {};  ///< of the script
  commands::ReportFolder* report = nullptr;  ///< takes pictures of failures; null: a new folder
  bool stay = false;                         ///< the window stays open when the script has ended
  std::function<bool()> interrupted;         ///< ends the window as closing it does; empty: nothing does
};

/// Opens the window and runs until it is closed or the script quits or ends. Returns the exit status: 0, the
/// value given to the script's `quit`, or 1 if a scripted step failed or, if `quit` had no value, if there
/// was an error (messages are logged). Throws Error if there is no display or no OpenGL 3.3, or if the script
/// does not parse.
/// `result`: what the script has found; may be null.
int run_viewer(session::Session& session, const ViewerOptions& options,
               commands::ScriptResult* result = nullptr);

/// Runs the script with the session alone: no window, no OpenGL, no display. The picture has the size of
/// 'view.size', or k_headless_size. Returns and throws as run_viewer; throws Error as well if the script
/// needs a window.
int run_headless(session::Session& session, const ViewerOptions& options,
                 commands::ScriptResult* result = nullptr);
inline constexpr std::pair<uint32_t, uint32_t> k_headless_size{960, 540};

/// True if the script needs a window. Throws Error if it does not parse. Opens none.
bool needs_window(session::Session& session, const ViewerOptions& options);

/// True if a window can be opened (an X or Wayland display answers). Cheap; opens nothing.
bool display_available();

}  // namespace lucerna::ui
