#pragma once
// The user's work: the open scene, camera and selection, history, and the commands that change them.
// run(line) is the only way to change it. Not thread-safe.
//
// Edits are sent in the order of the lines, so each line acts on the result of the lines before. If the
// session refuses one, it is removed from the undo history and the script.
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/log.h"
#include "commands/comparing.h"
#include "commands/exposure.h"
#include "commands/history.h"
#include "commands/navigation.h"
#include "commands/open_scene.h"
#include "commands/path_inquiry.h"
#include "commands/pixel_report.h"
#include "commands/registry.h"
#include "commands/saved_files.h"
#include "commands/scene_file.h"
#include "commands/values.h"

namespace lucerna::commands {

/// What the owner of a workspace does about changes. Each may be empty.
struct WorkspaceEvents {
  /// Another scene has appeared and its view is set up.
  std::function<void()> scene_changed = {};
  /// A measurement has set the exposure; `text`: the value.
  std::function<void(const std::string& text)> measured = {};
  /// The session has refused the latest requested size; the picture keeps this one.
  std::function<void(uint32_t width, uint32_t height)> size_refused = {};
  /// A picture has been written; `name`: its file and the way of writing.
  std::function<void(const std::string& name)> written = {};
  /// Settings, with values, that change in the same step when one is set to a value.
  std::function<std::vector<std::pair<std::string, std::string>>(const std::string& key,
                                                                 const std::string& value)>
      set_with = {};
  /// True if exposure is measured for a new scene that sets none; empty: false.
  std::function<bool()> exposes_at_load = {};
};

/// An error or a warning that was logged.
struct LoggedProblem {
  std::string text;
  uint64_t error = 0;     ///< its number among the errors, from 1; 0: a warning
  bool expected = false;  ///< a script has stated it
  std::string during;     ///< place of the script's line that was running; "": none
};

/// A pixel that is being reported, or has been.
struct PixelInquiry {
  vec2 at;  ///< 0..1 to the right and down
  std::shared_future<film::FilmImage> layers;
  std::vector<std::string> lines;  ///< empty until they are known; an error's message if they cannot be
  PixelReport report = {};         ///< the first lines as data, unless there was an error
  std::vector<std::string> surface = {};  ///< the lines after them: "object: Chair"

  /// Makes the lines when the layers are there, and logs them.
  void follow(const OpenScene& open, const Navigation& camera);
};

class Workspace {
 public:
  explicit Workspace(session::Session& session, WorkspaceEvents events = {});
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  session::Session& session;
  OpenScene open;
  Navigation camera;
  History history;
  Exposure exposure;
  SceneFile scene_file;
  SavedFiles files;
  Values values;      ///< what lines can read; others may be added
  Registry registry;  ///< contains the commands of this module; others may be added
  WorkspaceEvents events;
  double now = 0;                      ///< seconds on the caller's clock
  uint64_t error_count = 0;            ///< number of logged errors so far, counted by note_log()
  std::deque<LoggedProblem> problems;  ///< the latest errors and warnings
  std::string script_line;             ///< place of the script's line that is running; "": none
  std::optional<PixelInquiry> pixel;   ///< by inspect.pixel
  std::optional<PathInquiry> traced;   ///< by inspect.trace
  std::optional<NoiseInquiry> noise;   ///< by inspect.noise
  Comparing compare;                   ///< by compare.hold and others
  uint64_t inspections = 0;            ///< inspect.at commands so far

  /// Reads what the session has published since. Call before reading state and before running commands.
  void refresh(double time);

  /// Notes a line of the log; the owner calls it from its listener, on this thread.
  void note_log(log::Level level, const std::string& text);

  /// Executes a line. Lines of one `gesture` (not 0) on the same target are one undo step and one line of the
  /// script: the last. Throws Error, at `where`, if it is invalid or cannot be executed; then nothing has
  /// changed. Returns the parsed line.
  Line run(const std::string& line, uint64_t gesture = 0, const std::string& where = "");

  /// Output of 'help TOPIC'; "": list of commands. Throws Error if there is no such topic.
  std::string manual(const std::string& topic) const;

  Box selection_bounds() const {
    return commands::selection_bounds(open.scene.get(), open.lights(), camera.selection, camera.core);
  }
  std::string selection_name() const {
    return commands::selection_name(open.scene.get(), open.lights(), camera.selection);
  }

 private:
  bool interactive() const;
  void expose(const Exposure::Found& found);
  void follow_scene();
  void carry_out(const Line& line, uint64_t gesture, const std::string& where);
  void execute_edit(const Line& line, uint64_t gesture, const std::string& where);
  void record(const Line& line, History::Executed executed);
};

}  // namespace lucerna::commands
