// Commands for the scene file, rendering and scripts, and commands that wait.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/picture_wait.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

constexpr const char* k_script_manual =
    "Scripts: one command per line; # starts a comment. 'lucerna script FILE' runs one as a test. Besides "
    "commands:\n"
    "  let NAME VALUE: a variable, for ${NAME} in later lines; NAME=VALUE of the command line takes "
    "precedence\n"
    "  include FILE: the lines of another script, relative to this one's folder\n"
    "  for NAME in A B C ... end: repeats the lines up to its 'end'\n"
    "  ${here}: the folder of the script's file; $${ stands for ${\n"
    "The commands wait, expect, fails and quit are for scripts.";

std::string settings_manual() {
  std::string text = "Settings, for 'set KEY VALUE':";
  for (const OptionInfo& o : plan::options()) {
    const std::string range = describe_values(o);
    text += fmt::format("\n  {} {}: {}", o.key, range, o.help);
  }
  return text;
}

/// A command without parameters.
void add_plain(Registry& registry, const char* name, const char* help, std::function<void()> run) {
  registry.add(
      {.name = name, .help = help, .parameters = {}, .run = [run = std::move(run)](const Arguments&) {
         run();
       }});
}

}  // namespace

void add_scene_commands(Workspace& work) {
  work.registry.add(
      {.name = "scene.open",
       .help = "Opens a glTF scene. The shown scene stays until the new one is ready, or if loading fails.",
       .parameters = {file_named({".gltf", ".glb"}),
                      {.name = "outside",
                       .type = Type::boolean,
                       .help = "also reads files that the scene names outside its folder",
                       .optional = true},
                      {.name = "choose",
                       .type = Type::boolean,
                       .help = "the program chooses the solvers, as with auto, unless the scene sets "
                               "components.* or relight.*",
                       .optional = true}},
       .run = [&work](const Arguments& a) {
         work.exposure.begin_load();
         const auto is = [&](const char* name) { return a.has(name) && a.boolean(name); };
         work.open.load(a.text("file"), is("outside"), is("choose"));
       }});
  work.registry.add({.name = "scene.cancel",
                     .help = "Cancels the load in progress, or the edit of objects; the shown scene stays.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.session.cancel(); },
                     .done = [&work](const Arguments&) { return !work.open.loading(); },
                     .recorded = false});
}

void add_render_commands(Workspace& work) {
  add_plain(work.registry, "render.pause", "Pauses sampling.", [&work] {
    work.history.record_wait();
    work.session.set_paused(true);
  });
  add_plain(work.registry, "render.resume", "Resumes sampling.", [&work] { work.session.set_paused(false); });
  add_plain(work.registry, "render.restart", "Discards all samples and restarts the picture.",
            [&work] { work.session.restart(); });
  add_plain(work.registry, "shaders.reload", "Compiles the shaders again; on errors the old ones stay.",
            [&work] { work.session.reload_shaders(); });
  work.registry.add(
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
           [&work](const Arguments& a) {
             const std::string& file = a.text("file");
             const bool png = std::filesystem::path(file).extension() == ".png";
             const bool as_shown = a.has("as") && a.text("as") == "shown";
             if (as_shown && !png) throw Error("", "as: only a PNG is saved as shown");
             work.history.record_wait();
             work.files.add(work.session.save(file, as_shown),
                            file + (png ? as_shown ? ", as shown" : ", unfiltered" : ""));
           },
       .done = [&work](const Arguments&) { return work.files.latest_written(); }});
  work.registry.add(
      {.name = "reference.load",
       .help = "Compares this picture with a reference: an EXR with all layers, of the same scene, view "
               "and size.",
       .parameters = {file_named({".exr"})},
       .run = [&work](const Arguments& a) {
         work.open.needs_scene();
         work.session.set_reference(a.text("file"), work.open.id());
       }});
  add_plain(work.registry, "reference.clear", "Removes the reference.",
            [&work] { work.session.clear_reference(); });
}

void add_script_commands(Workspace& work) {
  work.registry.add(
      {.name = "script.save",
       .help =
           "Saves this session as a script that repeats it; it waits for the same number of samples where "
           "a picture was saved or rendering was paused. An existing file is replaced only if it is a "
           "saved session.",
       .parameters = {file_to_write({".lucerna"})},
       .run =
           [&work](const Arguments& a) {
             work.history.save_script(a.text("file"));
             log::info("session saved as {}", a.text("file"));
           },
       .recorded = false,
       .needs_outcome = true});
  work.registry.add(
      {.name = "help",
       .help = "Lists the commands, or describes one.",
       .parameters = {{.name = "command",
                       .help = "a command, a setting, 'settings', 'values' or 'scripts'",
                       .optional = true,
                       .names =
                           [&work](const std::vector<std::string>&) {
                             std::vector<std::string> names{"settings", "values", "scripts"};
                             for (const auto& [name, command] : work.registry.all()) names.push_back(name);
                             return names;
                           }}},
       .answer =
           [&work](const Arguments& a) { return work.manual(a.has("command") ? a.text("command") : ""); },
       .recorded = false});
}

void add_wait_commands(Workspace& work) {
  const Parameter limit = time_limit();
  work.registry.add({.name = "wait_scene",
                     .help = "In a script: waits until the scene is loaded; fails if loading fails.",
                     .parameters = {limit},
                     .run = [](const Arguments&) {},
                     .done =
                         [&work](const Arguments&) {
                           if (work.open.loading()) return false;
                           if (work.open.load_failed() || !work.camera.view)
                             throw Error("", "no scene was loaded");
                           return true;
                         },
                     .recorded = false});
  work.registry.add({.name = "wait_load",
                     .help = "In a script: waits until no scene is being loaded, even after a failure.",
                     .parameters = {limit},
                     .run = [](const Arguments&) {},
                     .done = [&work](const Arguments&) { return !work.open.loading(); }});
  const auto waiting = std::make_shared<std::optional<PictureWait>>();
  work.registry.add(
      {.name = "wait_samples",
       .help = "In a script: waits until the picture has that many samples per pixel, or is finished.",
       .parameters = {{.name = "samples", .type = Type::integer, .lo = 0, .hi = 1 << 20}, limit},
       .run = [&work, waiting](const Arguments&) { waiting->emplace(work); },
       .done =
           [&work, waiting](const Arguments& a) {
             if (!*waiting) waiting->emplace(work);
             return (*waiting)->poll(work, [samples = a.integer("samples")](const session::Snapshot& s) {
               return s.finished || (!s.coarse && s.samples >= samples);
             });
           }});
}

std::string Workspace::manual(const std::string& topic) const {
  if (topic == "settings") return settings_manual();
  if (topic == "values") return values.manual();
  if (topic == "scripts") return k_script_manual;
  if (const Command* command = registry.find(topic)) return registry.manual(*command);
  if (const OptionInfo* option = plan::find_option(topic))
    return fmt::format("set {} VALUE\n  {}", topic, option->help);
  std::vector<std::string> names;
  std::string list =
      "Commands; 'help COMMAND' explains one, 'help settings', 'help values' and 'help scripts' the rest:";
  for (const auto& [name, command] : registry.all()) {
    names.push_back(name);
    list += "\n  " + registry.usage(command);
  }
  if (topic.empty()) return list;
  throw Error("", fmt::format("there is no command '{}'{}", topic, suggestion(topic, names)));
}

}  // namespace lucerna::commands
