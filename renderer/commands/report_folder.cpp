#include "commands/report_folder.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/markup.h"

namespace lucerna::commands {
namespace {

namespace fs = std::filesystem;
using Outcome = ScriptCase::Outcome;

constexpr const char* k_page = "report.html";
constexpr const char* k_junit = "junit.xml";

constexpr const char* k_head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Lucerna: scripts</title>
<style>
body { background: #1e1e1e; color: #e2e1df; font: 14px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1500px; padding: 0 1em }
h1 { font-size: 20px } h2 { font-size: 16px; margin-top: 2em; overflow-wrap: anywhere }
table { border-collapse: collapse; width: 100% } td { border-top: 1px solid #343434; padding: 4px 10px 4px 0; vertical-align: top }
td:first-child { white-space: nowrap } .passed { color: #7fb77f } .failed, .error { color: #e86058 }
code { color: #a0c4ee; overflow-wrap: anywhere } .dim { color: #a09f9d }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 8px; margin: 8px 0 }
figure { margin: 0 } figcaption { color: #a09f9d } img { width: 100%; image-rendering: pixelated; background: #000 }
</style></head><body>
)";

std::string figure(const std::string& file, const char* caption) {
  if (file.empty()) return fmt::format("<figure><figcaption>{}: none</figcaption></figure>", caption);
  return fmt::format(
      "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"></a><figcaption>{1}</figcaption></figure>",
      escape_markup(file), caption);
}

const char* name_of(Outcome outcome) {
  return outcome == Outcome::passed ? "passed" : outcome == Outcome::failed ? "failed" : "error";
}

}  // namespace

std::string report_page(const std::vector<ScriptResult>& results) {
  std::string text = k_head;
  text += "<h1>" + escape_markup(summary(results)) + "</h1>\n";
  for (const ScriptResult& r : results) {
    text += fmt::format("<h2>{} <span class=\"{}\">{}</span></h2>\n<table>\n", escape_markup(r.script),
                        r.passed() ? "passed" : "failed", r.passed() ? "passed" : "failed");
    for (const ScriptCase& c : r.cases) {
      text += fmt::format(
          "<tr><td class=\"{0}\">{0}</td><td><code>{1}</code><br>{2} <span class=\"dim\">{3}, {4:.2f} "
          "s</span>",
          name_of(c.outcome), escape_markup(c.line), escape_markup(c.message), escape_markup(c.where),
          c.seconds);
      for (const DifferentPicture& p : c.pictures) {
        text += "<div class=\"pictures\">" + figure(p.reference, "reference") + figure(p.now, "now") +
                figure(p.difference, "difference") + "</div>";
        if (!p.accept.empty())
          text += "To accept the new picture: <code>" + escape_markup(p.accept) + "</code>";
      }
      text += "</td></tr>\n";
    }
    text += "</table>\n";
    if (r.not_run > 0) text += fmt::format("<p class=\"dim\">{} lines were left out.</p>\n", r.not_run);
  }
  return text + "</body></html>\n";
}

std::string shell_word(const std::string& text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string("_-+=./:@%,").find(c) != std::string::npos;
  };
  bool all = !text.empty();
  for (const char c : text) all = all && plain(c);
  if (all) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

ReportFolder::ReportFolder(const fs::path& folder)
    : folder_(folder.empty() ? fs::path(k_default_report) : folder) {
  if (!folder.empty()) make();
}

void ReportFolder::make() {
  if (made_) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !is_folder(folder_))
    throw_error(folder_.string(), "the report folder cannot be made: {}",
                error ? error.message() : "it is a file");
  const bool empty = fs::is_empty(folder_, error);
  if (!empty && !file_exists(folder_ / k_junit))
    throw Error(folder_.string(), "holds other files and no report: choose another folder");
  made_ = true;
}

fs::path ReportFolder::file(const std::string& name, const std::string& ending) {
  make();
  return folder_ / fmt::format("{}-{}{}", number_, name, ending);
}

void ReportFolder::write(const std::vector<ScriptResult>& results) {
  if (!made_) return;
  write_file(folder_ / k_junit, junit(results));
  write_file(folder_ / k_page, report_page(results));
}

}  // namespace lucerna::commands
