#include "commands/script_runner.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "commands/waits.h"

namespace lucerna::commands {
namespace {

using Outcome = ScriptCase::Outcome;

constexpr double k_longest_wait = 300;  // seconds

/// The first script in the chain of calls.
const Call& root(const Call& call) {
  const Call* at = &call;
  while (at->by) at = at->by.get();
  return *at;
}

/// Without the beginning that names the place.
std::string without(const std::string& where, const std::string& message) {
  return message.starts_with(where + ": ") ? message.substr(where.size() + 2) : message;
}

}  // namespace

ScriptRunner::ScriptRunner(Workspace& work, ReportFolder& report, ScriptHost host)
    : work_(work), report_(report), host_(std::move(host)) {
  add_expectations(work_, expectations);
  if (host_.add_kinds) host_.add_kinds(expectations);
  add_commands();
}

void ScriptRunner::start(const std::vector<std::string>& lines, const std::string& name, bool stay,
                         const Variables& variables) {
  result_.script = name;
  const auto call = std::make_shared<const Call>(Call{.file = canonical_path(name), .by = {}, .own = true});
  for (Step& step : parse_script(work_.registry, lines, name, variables)) steps_.push_back(std::move(step));
  if (!stay) steps_.push_back({"quit", name + ": end", "", {}});
  for (Step& step : steps_) step.call = call;
}

bool ScriptRunner::needs_window() const {
  return commands::needs_window(work_.registry, {steps_.begin(), steps_.end()});
}

ScriptResult ScriptRunner::result() const {
  ScriptResult result = result_;
  result.seconds = work_.now - started_.value_or(work_.now);
  return result;
}

void ScriptRunner::advance() {
  if (running() && !started_) started_ = work_.now;
  while (running()) {
    // A script may insert steps behind the one that is running.
    const Step step = steps_.front();
    work_.script_line = step.where;
    if (!current_.command && waits_for_earlier(step)) {
      if (host_.wake) host_.wake(2);
      return;
    }
    std::optional<std::string> failure;
    try {
      if (!carry_out(step)) {
        const double limit = limit_ > 0 ? limit_ : k_longest_wait;
        if (work_.now - began_ > limit && !(host_.patient && host_.patient()))
          throw_error(step.where, "{}: gave up after {:.3g} s", current_.command->name, limit);
      }
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if (failure) {
      give_up(step, *failure);
      return;
    }
    if (current_.command) return;
    steps_.pop_front();
    if (host_.wake) host_.wake(3);
  }
  work_.script_line.clear();
}

bool ScriptRunner::waits_for_earlier(const Step& step) const {
  const Command* next = work_.registry.parse(step.line, step.where).command;
  if (!next) return false;
  if (next->needs_outcome && work_.open.snapshot && !work_.open.up_to_date() && !work_.open.loading())
    return true;
  return host_.waits && host_.waits(*next);
}

bool ScriptRunner::carry_out(const Step& step) {
  if (!current_.command) {
    began_ = work_.now, frames_ = 0, limit_ = 0, ended_ = false;
    verdict_.reset();
    in_script_ = true;
    try {
      const Line line = work_.registry.parse(step.line, step.where);
      if (line.command && line.arguments.has("limit")) limit_ = line.arguments.real("limit");
      current_ = work_.run(step.line, 0, step.where);
    } catch (...) {
      in_script_ = false;
      throw;
    }
    in_script_ = false;
    if (host_.wake) host_.wake(2);
    if (current_.command->done) return false;
  } else {
    try {
      if (!current_.command->done(current_.arguments)) return false;
      // What it has logged arrives with the next call: while this line still runs.
      if (current_.command->needs_outcome && !verdict_ && !std::exchange(ended_, true)) return false;
    } catch (const Error& error) {
      const std::string head = current_.command->name + ": ", what = error.what();
      throw Error(step.where, what.starts_with(head) ? what : head + what);
    }
  }
  if (verdict_) {
    note(step, verdict_->passed ? Outcome::passed : Outcome::failed, verdict_->message, verdict_->pictures);
    if (!verdict_->passed) {
      log::error("{}: {}", step.where, verdict_->message);
      for (const DifferentPicture& p : verdict_->pictures)
        log::warning("to accept the new picture: {}", p.accept);
    }
  } else if (current_.command->name.starts_with("wait") || current_.command->name == "fails") {
    note(step, Outcome::passed, "");
  }
  current_ = {};
  return true;
}

void ScriptRunner::note(const Step& step, Outcome outcome, const std::string& message,
                        std::vector<DifferentPicture> pictures) {
  if (!root(*step.call).own) return;
  result_.cases.push_back({step.where, step.line, outcome, message, work_.now - began_, std::move(pictures)});
}

void ScriptRunner::give_up(const Step& step, const std::string& message) {
  log::error("{}", message);
  note(step, Outcome::error, without(step.where, message));
  const Call* script = &root(*step.call);
  current_ = {};
  check_ = {}, verdict_.reset();
  const size_t before = steps_.size();
  std::erase_if(steps_, [&](const Step& s) { return &root(*s.call) == script; });
  if (!script->own) return;
  result_.not_run = before - steps_.size() - 1;
  if (result_.not_run > 0) --result_.not_run;  // the end of the script
  if (host_.quit) host_.quit(1);
}

void ScriptRunner::run_script(const std::string& file) {
  const std::shared_ptr<const Call> by = in_script_ ? steps_.front().call : nullptr;
  const std::string form = canonical_path(file);
  for (const Call* call = by.get(); call; call = call->by.get())
    if (call->file == form) throw Error(file, "is already running: a script cannot run itself");
  const auto call =
      std::make_shared<const Call>(Call{.file = form, .by = by, .own = false, .errors = work_.error_count});
  auto steps = parse_script(work_.registry, read_script(file), file);
  for (Step& step : steps) step.call = call;
  // After the running step, which is at the front.
  steps_.insert(steps_.begin() + (steps_.empty() ? 0 : 1), steps.begin(), steps.end());
}

std::vector<std::string> ScriptRunner::unexpected_errors(uint64_t since) const {
  std::vector<std::string> texts;
  for (const LoggedProblem& line : work_.problems)
    if (line.error > since && !line.expected)
      texts.push_back(line.text + (line.during.empty() ? "" : " (logged during " + line.during + ")"));
  return texts;
}

ExpectContext ScriptRunner::context(bool keeps) {
  return {.folder = steps_.empty() || !in_script_ ? "" : steps_.front().folder,
          .report = report_,
          .keeps = keeps};
}

void ScriptRunner::add_commands() {
  add_quit();
  add_wait();
  add_expect();
  add_fails();
  work_.registry.add({.name = "script.run",
                      .help = "Runs the commands of a file.",
                      .parameters = {{.name = "file", .type = Type::file, .choices = {".lucerna"}}},
                      .run = [this](const Arguments& a) { run_script(a.text("file")); },
                      .recorded = false});
}

void ScriptRunner::add_quit() {
  work_.registry.add(
      {.name = "quit",
       .help = "Ends the program. In a script: after all commands are done; without a status with 1 after a "
               "failed expectation or an error that none expected, otherwise with 0.",
       .parameters = {{.name = "status", .type = Type::integer, .lo = 0, .hi = 255, .optional = true}},
       .run =
           [this](const Arguments& a) {
             settled_ = 0;
             if (!in_script_ && host_.quit)
               host_.quit(a.has("status") ? static_cast<int>(a.integer("status")) : 0);
           },
       .done =
           [this](const Arguments& a) {
             if (host_.wake) host_.wake(2);
             // Errors of the last command are read one frame after it is done.
             const bool settled =
                 work_.open.snapshot ? work_.open.up_to_date() : work_.session.commands() == 0;
             settled_ = settled ? settled_ + 1 : 0;
             if (settled_ < 2) return false;
             const bool failed = !result_.passed();
             std::vector<std::string> errors;
             if (!a.has("status") && !failed) errors = unexpected_errors(root(*steps_.front().call).errors);
             for (const std::string& error : errors)
               note(steps_.front(), Outcome::error, "an error that no 'expect log' states: " + error);
             if (host_.quit)
               host_.quit(a.has("status") ? static_cast<int>(a.integer("status"))
                                          : failed || !errors.empty());
             return true;
           },
       .recorded = false});
}

const char* const k_wait_help =
    "In a script: waits until a condition holds, and fails after 300 s, or after 'within SECONDS' behind it. "
    "SECONDS or seconds N: for that time; scene: until it is loaded; samples N: per pixel, or finished; "
    "error E: "
    "until the estimated error as seen is at most E; cache, photons or another solver: until its data is "
    "complete; idle: until there is nothing left to do; until X: until 'expect X' passes.";

void ScriptRunner::add_wait() {
  const auto wait = std::make_shared<Wait>();
  work_.registry.add({.name = "wait",
                      .help = k_wait_help,
                      .parameters = {{.name = "condition", .type = Type::rest, .names = wait_suggestions}},
                      .check =
                          [this](const Arguments& a) {
                            read_wait(work_, expectations, a.text("condition"), context(false));
                          },
                      .run =
                          [this, wait](const Arguments& a) {
                            *wait = read_wait(work_, expectations, a.text("condition"), context(false));
                            if (in_script_) limit_ = wait->limit.value_or(0);
                          },
                      .done = [wait](const Arguments&) { return wait->done(); },
                      .recorded = false});
}

void ScriptRunner::add_expect() {
  work_.registry.add(
      {.name = "expect",
       .help =
           "Checks something; in a script a failure is noted, and the script continues and ends with status "
           "1. Files are relative to the script's folder." +
           expectations.manual(),
       .parameters = {{.name = "what",
                       .type = Type::rest,
                       .names =
                           [this](const std::vector<std::string>& before) {
                             return expectations.suggestions(before);
                           }}},
       .check = [this](const Arguments& a) { expectations.read(a.text("what"), context(false)); },
       .run =
           [this](const Arguments& a) {
             if (in_script_) {
               check_ = expectations.read(a.text("what"), context(true));
               return;
             }
             const std::optional<Verdict> verdict = expectations.read(a.text("what"), context(false))();
             if (!verdict) throw Error("", "takes a moment: only a script can wait for it");
             if (!verdict->passed) throw Error("", verdict->message);
             log::info("{}", verdict->message);
           },
       .done =
           [this](const Arguments&) {
             if (host_.wake) host_.wake(2);
             try {
               verdict_ = check_();
             } catch (const Error& error) {
               verdict_ = Verdict{false, error.what(), {}};
             }
             return verdict_.has_value();
           },
       .recorded = false,
       .needs_outcome = true,
       .needs_window = [this](const Arguments& a) { return expectations.needs_window(a.text("what")); }});
}

void ScriptRunner::add_fails() {
  work_.registry.add(
      {.name = "fails",
       .help = "In a script: runs a line that must be refused with a message that contains the text.",
       .parameters = {{.name = "text", .help = "part of the message"},
                      {.name = "line", .type = Type::rest, .help = "the line to run"}},
       .run =
           [this](const Arguments& a) {
             std::string message;
             try {
               work_.run(a.text("line"));
             } catch (const std::exception& error) {
               message = error.what();
             }
             if (message.empty()) throw Error("", fmt::format("'{}' was not refused", a.text("line")));
             if (message.find(a.text("text")) == std::string::npos)
               throw Error("", fmt::format("expected a message that contains '{}', found: {}", a.text("text"),
                                           message));
           },
       .recorded = false});
}

}  // namespace lucerna::commands
