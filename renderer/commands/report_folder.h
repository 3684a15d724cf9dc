#pragma once
// The folder that a run of scripts leaves if it is asked to, or if a picture differs: junit.xml, report.html
// and the pictures.
#include <filesystem>
#include <string>
#include <vector>

#include "commands/script_results.h"

namespace lucerna::commands {

inline constexpr const char* k_default_report = "lucerna-report";

class ReportFolder {
 public:
  /// `folder`: "" for k_default_report in the working folder, made only when a picture differs. Throws Error
  /// if a folder is given that cannot be made, or that holds files and no report.
  explicit ReportFolder(const std::filesystem::path& folder = "");

  /// The path of a new file "NAME-NUMBER.ENDING" in the folder. Throws Error if the folder cannot be made.
  std::filesystem::path file(const std::string& name, const std::string& ending);
  /// Names for the pictures of one failed check, with a common number: call before file().
  void next() { ++number_; }
  /// Writes junit.xml and report.html if a folder was given or made. Throws Error.
  void write(const std::vector<ScriptResult>& results);
  /// The folder if it exists or was given; "" otherwise.
  std::string path() const { return made_ ? folder_.string() : ""; }

 private:
  void make();

  std::filesystem::path folder_;
  bool made_ = false;
  int number_ = 0;
};

/// The page: a table of the checks, and for each different picture the three pictures.
std::string report_page(const std::vector<ScriptResult>& results);

/// A text as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace lucerna::commands
