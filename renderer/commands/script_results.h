#pragma once
// What scripts have found: one case per 'expect' and 'wait', and one per other line that failed; as text for
// a person, and as JUnit XML. Where a picture differs, its files lie in the report folder (report_folder.h).
#include <string>
#include <vector>

namespace lucerna::commands {

/// A picture that differs from its reference. Files are names in the report folder; "": none.
struct DifferentPicture {
  std::string now, reference, difference;  ///< PNG files, for the page
  std::string accept;                      ///< the command that makes the new picture the reference
};

/// Result of an expectation.
struct Verdict {
  bool passed = false;
  std::string message;  ///< what was found; if it failed also what was expected
  std::vector<DifferentPicture> pictures = {};
};

struct ScriptCase {
  enum class Outcome { passed, failed, error };  ///< error: a command could not be run, or a wait ended
  std::string where, line;
  Outcome outcome = Outcome::passed;
  std::string message;
  double seconds = 0;
  std::vector<DifferentPicture> pictures = {};
};

struct ScriptResult {
  std::string script;  ///< its file, as given
  std::vector<ScriptCase> cases = {};
  size_t not_run = 0;  ///< lines after one that failed
  double seconds = 0;
  size_t count(ScriptCase::Outcome outcome) const;
  bool passed() const;
};

/// "FILE: 12 passed, 1 failed (3.2 s)" and a line for each case that did not pass, with the command to accept
/// a new picture.
std::string summary(const ScriptResult& result);
/// The summary's last line for several scripts.
std::string summary(const std::vector<ScriptResult>& results);
std::string junit(const std::vector<ScriptResult>& results);

}  // namespace lucerna::commands
