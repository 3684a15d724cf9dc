#pragma once
// Runs the steps of scripts, a few per call, over a workspace; with a window or without one. Registers the
// commands of scripts:
//
//   quit [STATUS]            ends the program after all commands are done; without a status with 1 if an
//                            expectation failed or an error was logged since the script began, else with 0
//   script.run FILE          runs another script, unless it is already running
//   wait CONDITION           see k_wait_help; fails after its limit
//   expect WHAT              checks something (expectation.h); a failure is noted and the script continues
//   fails TEXT LINE          runs a line that must be refused with a message that contains the text
//
// A command that fails ends its script: the program's own with status 1, one of the console alone.
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands/expectation.h"
#include "commands/script.h"
#include "commands/script_results.h"
#include "commands/workspace.h"

namespace lucerna::commands {

extern const char* const k_wait_help;

/// What the owner of a runner does; each may be empty.
struct ScriptHost {
  /// Requests another advance() soon; with a window, after that number of drawn frames.
  std::function<void(int frames)> wake = {};
  /// The program ends with this status.
  std::function<void(int status)> quit = {};
  /// True if this command must wait for the window.
  std::function<bool(const Command& command)> waits = {};
  /// True while a step may take as long as it likes.
  std::function<bool()> patient = {};
  /// Adds kinds of expectations, before the commands are registered.
  std::function<void(Expectations&)> add_kinds = {};
};

class ScriptRunner {
 public:
  /// `report` takes the pictures of failures; it must outlive the runner, as must `work`, whose commands
  /// refer to this object afterwards.
  ScriptRunner(Workspace& work, ReportFolder& report, ScriptHost host);
  ScriptRunner(const ScriptRunner&) = delete;
  ScriptRunner& operator=(const ScriptRunner&) = delete;

  Expectations expectations;

  /// Adds the program's own script; `stay`: its end does not end the program. Throws Error like parse_script.
  void start(const std::vector<std::string>& lines, const std::string& name, bool stay,
             const Variables& variables = {});
  /// Runs steps until one has to wait; call repeatedly, after Workspace::refresh().
  void advance();
  /// True if steps of a script remain.
  bool running() const { return !steps_.empty(); }
  /// True while a line of a script is executed, and not one of the console or a control.
  bool in_script() const { return in_script_; }
  /// Call after each drawn frame.
  void drawn() { ++frames_; }
  /// Frames drawn since the step began.
  int frames() const { return frames_; }
  /// Results of the program's own script so far.
  ScriptResult result() const;
  /// True if a step of the waiting ones needs a window.
  bool needs_window() const;

 private:
  bool waits_for_earlier(const Step& step) const;
  /// True if the step is done; false: call again.
  bool carry_out(const Step& step);
  void note(const Step& step, ScriptCase::Outcome outcome, const std::string& message,
            std::vector<DifferentPicture> pictures = {});
  /// Ends the step's script, and the program if the script is its own.
  void give_up(const Step& step, const std::string& message);
  void run_script(const std::string& file);
  void add_commands();
  void add_quit();
  void add_wait();
  void add_expect();
  void add_fails();
  /// Errors that no expectation has stated, since that number.
  std::vector<std::string> unexpected_errors(uint64_t since) const;
  ExpectContext context(bool keeps);

  Workspace& work_;
  ReportFolder& report_;
  ScriptHost host_;
  std::deque<Step> steps_;
  Line current_;      ///< begun and not done
  double began_ = 0;  ///< when
  double limit_ = 0;  ///< of the current wait; 0: the usual one
  int frames_ = 0;
  bool ended_ = false;  ///< it was found done once
  bool in_script_ = false;
  int settled_ = 0;  ///< consecutive calls without pending work
  Check check_;      ///< of the current expectation
  std::optional<Verdict> verdict_;
  ScriptResult result_;
  std::optional<double> started_;  ///< when its first step was run
};

}  // namespace lucerna::commands
