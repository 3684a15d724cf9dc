#include "commands/saved_test.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "commands/command_list.h"
#include "commands/workspace.h"
#include "film/io/image_file.h"

namespace lucerna::commands {
namespace {

namespace fs = std::filesystem;

const std::string k_first_line = "# A session of Lucerna as a test; lucerna script FILE runs it.\n";

/// A line with its files relative to the script, or "" for a line that a test does not need.
std::string portable(const Registry& registry, const std::string& text, const fs::path& folder) {
  const Line line = registry.parse(text);
  if (!line.command || line.command->name.starts_with("window.")) return "";
  for (const Parameter& p : line.command->parameters)
    if (p.writes) return "";
  std::string result = line.command->name;
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    std::string value = line.arguments.text(p.name);
    std::string word = p.type == Type::rest ? value : quote(value);
    if (p.names_file(value)) {
      const fs::path relative = absolute_path(value).lexically_relative(folder);
      // "$${" keeps a "${" of the name.
      if (!relative.empty()) {
        std::string escaped = relative.string();
        for (size_t at = 0; (at = escaped.find("${", at)) != std::string::npos; at += 3)
          escaped.insert(at, "$");
        word = "\"${here}/" + escaped + "\"";
      }
    }
    result += " " + (p.optional ? p.name + "=" : "") + word;
  }
  return result;
}

}  // namespace

std::string test_picture(const std::string& script) {
  return fs::path(script).replace_extension(".exr").string();
}

std::string session_test(const Workspace& work, const std::string& file) {
  work.open.needs_scene();
  const session::Snapshot* picture = work.open.snapshot.get();
  if (!picture || picture->coarse || picture->samples < 2)
    throw Error("", "the picture has fewer than two samples, so its noise is not known yet");
  const fs::path folder = absolute_path(file).parent_path();
  std::string text = k_first_line;
  text += line("view.size", picture->width, picture->height) + "\n";
  for (const std::string& recorded : work.history.script()) {
    // The size is above, and the test waits for samples at its end, paused or not.
    const auto begins = [&](const char* head) { return recorded.starts_with(head); };
    if (begins("view.size ") || begins("wait_samples ") || begins("render.")) continue;
    if (const std::string kept = portable(work.registry, recorded, folder); !kept.empty())
      text += kept + "\n";
  }
  text += fmt::format("wait samples {} within 3600\n", picture->samples);
  text += "expect image " + quote(fs::path(test_picture(file)).filename().string()) + "\n";
  return text;
}

void save_test(Workspace& work, const std::string& file) {
  const std::string picture = test_picture(file), text = session_test(work, file);
  const bool ours = is_plain_file(file) && read_file(file).starts_with(k_first_line);
  if (file_exists(file) && !ours) throw Error(file, "exists and is no saved test: choose another name");
  if (file_exists(picture) && !ours) throw Error(picture, "exists: choose another name for the test");
  film::check_writable(picture);
  write_file(file, text);
  work.files.add(work.session.save_reference(picture),
                 file + " with " + fs::path(picture).filename().string());
}

void add_session_test_commands(Workspace& work) {
  work.registry.add({.name = "script.save_test",
                     .help = "Saves this session as a test: a script that repeats it and expects the present "
                             "picture within its "
                             "noise, and the picture as an EXR beside it. 'lucerna script FILE' runs it.",
                     .parameters = {file_to_write({".lucerna"})},
                     .run = [&work](const Arguments& a) { save_test(work, a.text("file")); },
                     .done = [&work](const Arguments&) { return work.files.latest_written(); },
                     .recorded = false,
                     .needs_outcome = true});
}

}  // namespace lucerna::commands
