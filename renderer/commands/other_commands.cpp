// Commands for the scene file, rendering and scripts, and commands that wait.
#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

constexpr double k_standstill = 10;  // seconds without a new picture

std::string settings_manual() {
  std::string text = "Settings, for 'set KEY VALUE':";
  for (const OptionInfo& o : plan::options()) {
    const std::string range = describe_values(o);
    text += fmt::format("\n  {} {}: {}", o.key, range, o.help);
  }
  return text;
}

}  // namespace

void Workspace::add_plain(const char* name, const char* help, std::function<void()> run) {
  registry.add(
      {.name = name, .help = help, .parameters = {}, .run = [run = std::move(run)](const Arguments&) {
         run();
       }});
}

void Workspace::add_scene_commands() {
  registry.add(
      {.name = "scene.open",
       .help = "Opens a glTF scene. The shown scene stays until the new one is ready, or if loading fails.",
       .parameters = {file_named({".gltf", ".glb"})},
       .run = [this](const Arguments& a) {
         open_failed_ = exposure_given_ = false;
         session.load(a.text("file"));
         opened_by_ = session.commands();
       }});
  registry.add({.name = "scene.cancel",
                .help = "Cancels the load in progress; the shown scene stays.",
                .parameters = {},
                .run = [this](const Arguments&) { session.cancel(); },
                .done = [this](const Arguments&) { return !loading(); },
                .recorded = false});
}

void Workspace::add_render_commands() {
  add_plain("render.pause", "Pauses sampling.", [this] {
    record_wait();
    session.set_paused(true);
  });
  add_plain("render.resume", "Resumes sampling.", [this] { session.set_paused(false); });
  add_plain("render.restart", "Discards all samples and restarts the picture.",
            [this] { session.restart(); });
  add_plain("shaders.reload", "Compiles the shaders again; on errors the old ones stay.",
            [this] { session.reload_shaders(); });
  registry.add(
      {.name = "image.save",
       .help = "Writes the picture, once every pixel has a sample: all layers as EXR, untouched, or "
               "through exposure and tone curve as PNG. A script waits for it, and fails if it "
               "fails.",
       .parameters = {file_to_write({".exr", ".png"}),
                      time_limit(),
                      {.name = "as",
                       .type = Type::choice,
                       .help = "of a PNG; shown: with the preview's filter, as in the window; unfiltered "
                               "(default): the samples",
                       .choices = {"unfiltered", "shown"},
                       .optional = true}},
       .run =
           [this](const Arguments& a) {
             const std::string& file = a.text("file");
             const bool png = std::filesystem::path(file).extension() == ".png";
             const bool as_shown = a.has("as") && a.text("as") == "shown";
             if (as_shown && !png) throw Error("", "as: only a PNG is saved as shown");
             record_wait();
             saved_ = session.save(file, as_shown);
             writing_.push_back({file + (png ? as_shown ? ", as shown" : ", unfiltered" : ""), saved_});
           },
       .done = [this](const Arguments&) { return saved(); }});
  registry.add({.name = "reference.load",
                .help =
                    "Compares this picture with a reference: an EXR with all layers, of the same scene, view "
                    "and size.",
                .parameters = {file_named({".exr"})},
                .run = [this](const Arguments& a) {
                  needs_scene();
                  session.set_reference(a.text("file"), scene_id_);
                }});
  add_plain("reference.clear", "Removes the reference.", [this] { session.clear_reference(); });
}

void Workspace::add_script_commands() {
  registry.add(
      {.name = "script.save",
       .help =
           "Saves this session as a script that repeats it; it waits for the same number of samples where "
           "a picture was saved or rendering was paused. An existing file is replaced only if it is a "
           "saved session.",
       .parameters = {file_to_write({".lucerna"})},
       .run =
           [this](const Arguments& a) {
             save_script(a.text("file"));
             log::info("session saved as {}", a.text("file"));
           },
       .recorded = false,
       .needs_outcome = true});
  registry.add(
      {.name = "help",
       .help = "Lists the commands, or describes one.",
       .parameters = {{.name = "command",
                       .help = "a command, a setting, or 'settings'",
                       .optional = true,
                       .names =
                           [this](const std::vector<std::string>&) {
                             std::vector<std::string> names{"settings"};
                             for (const auto& [name, command] : registry.all()) names.push_back(name);
                             return names;
                           }}},
       .run =
           [this](const Arguments& a) { log::info("{}", manual(a.has("command") ? a.text("command") : "")); },
       .recorded = false});
}

void Workspace::add_wait_commands() {
  const Parameter limit = time_limit();
  registry.add({.name = "wait",
                .help = "In a script: lets the window run. Saved sessions leave it out.",
                .parameters = {{.name = "time", .type = Type::real, .lo = 0, .hi = 86400, .unit = "seconds"}},
                .run = [this](const Arguments&) { waited_since_ = now; },
                .done = [this](const Arguments& a) { return now - waited_since_ >= a.real("time"); },
                .recorded = false});
  registry.add({.name = "wait_scene",
                .help = "In a script: waits until the scene is loaded; fails if loading fails.",
                .parameters = {limit},
                .run = [](const Arguments&) {},
                .done =
                    [this](const Arguments&) {
                      if (loading()) return false;
                      if (open_failed_ || !view) throw Error("", "no scene was loaded");
                      return true;
                    },
                .recorded = false});
  registry.add({.name = "wait_load",
                .help = "In a script: waits until no scene is being loaded, even after a failure.",
                .parameters = {limit},
                .run = [](const Arguments&) {},
                .done = [this](const Arguments&) { return !loading(); }});
  registry.add(
      {.name = "wait_samples",
       .help = "In a script: waits until the picture has that many samples per pixel, or is finished.",
       .parameters = {{.name = "samples", .type = Type::integer, .lo = 0, .hi = 1 << 20}, limit},
       .run =
           [this](const Arguments&) {
             waited_since_ = now, waited_errors_ = error_count, waited_id_ = snapshot ? snapshot->id : 0;
           },
       .done = [this](const Arguments& a) { return has_samples(a.integer("samples")); }});
}

bool Workspace::has_samples(int64_t samples) {
  if (snapshot && snapshot->id != waited_id_) waited_id_ = snapshot->id, waited_since_ = now;
  if (error_count > waited_errors_ && now - waited_since_ > k_standstill)
    throw Error("", "the picture stands still after an error");
  // A picture from before the last edits, cameras and sizes does not count.
  if (!up_to_date() || resizing) return false;
  if (const solvers::Report* waiting_report = waiting()) throw Error("", waiting_report->to_go_on);
  if (snapshot->finished || (!snapshot->coarse && snapshot->samples >= samples)) return true;
  if (snapshot->paused) throw Error("", "rendering is paused; render.resume takes more samples");
  return false;
}

std::string Workspace::manual(const std::string& topic) const {
  if (topic == "settings") return settings_manual();
  if (const Command* command = registry.find(topic)) return registry.manual(*command);
  if (const OptionInfo* option = plan::find_option(topic))
    return fmt::format("set {} VALUE\n  {}", topic, option->help);
  std::vector<std::string> names;
  std::string list = "Commands; 'help COMMAND' explains one, 'help settings' lists the settings:";
  for (const auto& [name, command] : registry.all()) {
    names.push_back(name);
    list += "\n  " + registry.usage(command);
  }
  if (topic.empty()) return list;
  throw Error("", fmt::format("there is no command '{}'{}", topic, suggestion(topic, names)));
}

}  // namespace lucerna::commands
