#include "commands/script_results.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/markup.h"

namespace lucerna::commands {
namespace {

using Outcome = ScriptCase::Outcome;

/// Text as XML, without characters that XML 1.0 cannot hold.
std::string xml(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t'; });
  return escape_markup(text);
}

std::string counted(size_t n, const char* what) { return n > 0 ? fmt::format(", {} {}", n, what) : ""; }

}  // namespace

size_t ScriptResult::count(Outcome outcome) const {
  return static_cast<size_t>(
      std::count_if(cases.begin(), cases.end(), [&](const ScriptCase& c) { return c.outcome == outcome; }));
}

bool ScriptResult::passed() const { return count(Outcome::passed) == cases.size(); }

std::string summary(const ScriptResult& result) {
  std::string text =
      fmt::format("{}: {} passed{}{}{} ({:.1f} s)\n", result.script, result.count(Outcome::passed),
                  counted(result.count(Outcome::failed), "failed"),
                  counted(result.count(Outcome::error), "could not be run"),
                  counted(result.not_run, "lines left out"), result.seconds);
  for (const ScriptCase& c : result.cases) {
    if (c.outcome == Outcome::passed) continue;
    text += fmt::format("  {}: {}\n", c.where, c.message);
    for (const DifferentPicture& p : c.pictures)
      if (!p.accept.empty()) text += fmt::format("    to accept the new picture: {}\n", p.accept);
  }
  return text;
}

std::string summary(const std::vector<ScriptResult>& results) {
  size_t scripts = 0, cases = 0, bad = 0;
  double seconds = 0;
  for (const ScriptResult& r : results) {
    scripts += r.passed() ? 0 : 1;
    cases += r.cases.size(), bad += r.cases.size() - r.count(Outcome::passed);
    seconds += r.seconds;
  }
  return scripts == 0
             ? fmt::format("{} scripts passed, {} checks ({:.1f} s)\n", results.size(), cases, seconds)
             : fmt::format("{} of {} scripts failed, {} of {} checks ({:.1f} s)\n", scripts, results.size(),
                           bad, cases, seconds);
}

std::string junit(const std::vector<ScriptResult>& results) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"lucerna script\">\n";
  for (const ScriptResult& r : results) {
    text += fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n",
        xml(r.script), r.cases.size(), r.count(Outcome::failed), r.count(Outcome::error), r.seconds);
    for (const ScriptCase& c : r.cases) {
      text += fmt::format("    <testcase classname=\"{}\" name=\"{}: {}\" time=\"{:.3f}\"", xml(r.script),
                          xml(c.where), xml(c.line), c.seconds);
      if (c.outcome == Outcome::passed) {
        text += "/>\n";
        continue;
      }
      const char* kind = c.outcome == Outcome::failed ? "failure" : "error";
      std::string more;
      for (const DifferentPicture& p : c.pictures)
        more += fmt::format("{}\n{}\n{}\naccept: {}\n", p.now, p.reference, p.difference, p.accept);
      text += fmt::format(">\n      <{} message=\"{}\">{}</{}>\n    </testcase>\n", kind, xml(c.message),
                          xml(more), kind);
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace lucerna::commands
