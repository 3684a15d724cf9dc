#include "commands/waits.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "commands/picture_wait.h"
#include "commands/workspace.h"
#include "solvers/registry.h"

namespace lucerna::commands {
namespace {

constexpr double k_longest = 86400;  // seconds

std::vector<std::string> conditions() {
  std::vector<std::string> names{"seconds", "scene", "samples", "error", "idle", "until"};
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->looked_up) names.push_back(solver->name);
  return names;
}

const solvers::SolverInfo* solver_named(const std::string& name) {
  const solvers::SolverInfo* solver = solvers::find(name);
  return solver && solver->looked_up ? solver : nullptr;
}

/// True if the picture's estimated error is at most `error`. Throws Error if it never will be.
std::function<bool()> until_error(Workspace& work, double error) {
  return [&work, error, waiting = PictureWait(work)]() mutable {
    return waiting.poll(work, [error](const session::Snapshot& s) {
      if (!s.accuracy || s.accuracy->ledger.entries().empty()) return false;
      const stats::Entry& last = s.accuracy->ledger.entries().back();
      if (last.has_error && last.sum() <= error) return true;
      if (s.finished)
        throw Error("", fmt::format("the picture is finished with an error of {:.3g}", last.sum()));
      return false;
    });
  };
}

std::function<bool()> until_samples(Workspace& work, double samples) {
  return [&work, samples, waiting = PictureWait(work)]() mutable {
    return waiting.poll(work, [samples](const session::Snapshot& s) {
      return s.finished || (!s.coarse && double(s.samples) >= samples);
    });
  };
}

/// True if the solver's data is complete.
std::function<bool()> until_ready(Workspace& work, const solvers::SolverInfo& solver) {
  return [&work, &solver] {
    if (!work.open.up_to_date() || work.camera.resizing) return false;
    work.open.needs_solver(solver);
    const solvers::Report* report = work.open.report(solver);
    if (report && report->waits) throw Error("", report->to_go_on);
    return report && report->ready;
  };
}

std::function<bool()> until_idle(Workspace& work) {
  return [&work] {
    if (work.open.loading() || !work.open.up_to_date() || work.camera.resizing) return false;
    return work.open.snapshot->resting && work.open.snapshot->activity.empty();
  };
}

std::function<bool()> until_loaded(Workspace& work) {
  return [&work] {
    if (work.open.loading()) return false;
    if (work.open.load_failed() || !work.camera.view) throw Error("", "no scene was loaded");
    return true;
  };
}

std::function<bool()> after(Workspace& work, double seconds) {
  return [&work, until = work.now + seconds] { return work.now >= until; };
}

/// Repeats the check until it passes. A value that does not exist yet may come.
std::function<bool()> until(std::function<Check()> begin) {
  return [begin = std::move(begin), check = Check()]() mutable {
    if (!check) check = begin();
    try {
      const std::optional<Verdict> verdict = check();
      if (verdict) check = {};
      return verdict && verdict->passed;
    } catch (const Error&) {
      check = {};
      return false;
    }
  };
}

}  // namespace

Wait read_wait(Workspace& work, const Expectations& expectations, const std::string& text,
               const ExpectContext& context) {
  WordReader words(text);
  Wait wait{.condition = text, .limit = {}, .done = {}};
  const std::vector<std::string> all = words.remaining();
  double seconds = 0;
  if (!all.empty() && read_number(all[0], seconds)) {
    seconds = words.number("seconds from 0 to 86400", 0, k_longest);
    wait.done = after(work, seconds), wait.limit = seconds + k_longest;
  } else if (words.take("seconds")) {
    seconds = words.number("seconds from 0 to 86400", 0, k_longest);
    wait.done = after(work, seconds), wait.limit = seconds + k_longest;
  } else if (words.take("scene")) {
    wait.done = until_loaded(work);
  } else if (words.take("samples")) {
    wait.done = until_samples(work, words.number("a number of samples from 0 to 1048576", 0, 1 << 20));
  } else if (words.take("error")) {
    wait.done = until_error(work, words.number("an error from 0.0001 to 10", 1e-4, 10));
  } else if (words.take("idle")) {
    wait.done = until_idle(work);
  } else if (words.take("until")) {
    // An expectation may have a 'within' of its own: the last one before the end with a number is the limit.
    std::vector<std::string> rest = words.remaining();
    if (rest.size() >= 2 && rest[rest.size() - 2] == "within") {
      double limit = 0;
      if (!read_number(rest.back(), limit) || limit <= 0 || limit > k_longest)
        words.refuse("within SECONDS at the end, from 0 to 86400");
      wait.limit = limit;
      rest.resize(rest.size() - 2);
    }
    std::string what;
    for (const std::string& word : rest) what += (what.empty() ? "" : " ") + quote(word);
    expectations.read(what, context);
    const auto shared = std::make_shared<std::string>(what);
    wait.done = until([&expectations, shared, context] { return expectations.read(*shared, context); });
    return wait;
  } else {
    const solvers::SolverInfo* solver = all.empty() ? nullptr : solver_named(all[0]);
    if (!solver) {
      const std::vector<std::string> known = conditions();
      words.refuse(fmt::format("a number of seconds, or one of {}{}", fmt::join(known, ", "),
                               all.empty() ? "" : suggestion(all[0], known)));
    }
    words.skip(1);
    wait.done = until_ready(work, *solver);
  }
  if (words.take("within")) wait.limit = words.number("seconds from 0.01 to 86400", 0.01, k_longest);
  words.end("within SECONDS");
  return wait;
}

std::vector<std::string> wait_suggestions(const std::vector<std::string>& before) {
  if (before.empty()) return conditions();
  return before.back() == "within" ? std::vector<std::string>() : std::vector<std::string>{"within"};
}

}  // namespace lucerna::commands
