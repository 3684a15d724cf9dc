// Undoable commands that change the document: settings, environment, display.
#include <algorithm>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

std::vector<std::string> setting_keys() {
  std::vector<std::string> keys;
  for (const OptionInfo& option : plan::options()) keys.push_back(option.key);
  return keys;
}

std::vector<std::string> setting_values(const std::vector<std::string>& before) {
  const OptionInfo* option = before.empty() ? nullptr : plan::find_option(before[0]);
  if (!option) return {};
  if (option->type == OptionType::boolean) return {"true", "false"};
  if (option->type == OptionType::choice) return option->choices;
  return {option->fallback};
}

const OptionInfo& known_option(const std::string& key) {
  if (const OptionInfo* option = plan::find_option(key)) return *option;
  throw Error("", fmt::format("there is no setting '{}'{}", key, suggestion(key, setting_keys())));
}

}  // namespace

void add_history_commands(Workspace& work) {
  work.registry.add({.name = "undo",
                     .help = "Undoes the last change of a setting, a light, the environment or the display.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.history.undo(); },
                     .needs_outcome = true});
  work.registry.add({.name = "redo",
                     .help = "Redoes the last undone change.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.history.redo(); },
                     .needs_outcome = true});
}

namespace {

/// Sets a setting by the running command, with those that change in the same step, also for a scene that is
/// being loaded. Throws Error.
void give(Workspace& work, const std::string& key, const std::string& value) {
  if (key == "camera" && work.camera.view && !work.open.loading() && work.open.setting(key) != value)
    throw Error("", "the camera to start with; camera.select takes another one now");
  if (key == "film.ev") work.exposure.note_given();
  // The last choice of how light is displayed counts.
  if (key == "film.tone_curve" && !work.open.setting("film.ocio").empty())
    work.open.set_by_name("film.ocio", "");
  if (work.events.set_with)
    for (const auto& [other, to] : work.events.set_with(key, value)) work.open.set_by_name(other, to);
  work.open.set_by_name(key, value);
}

}  // namespace

void add_setting_commands(Workspace& work) {
  work.registry.add(
      {.name = "set",
       .help = "Changes a setting; 'help settings' lists them. A line KEY VALUE or KEY=VALUE does the same.",
       .parameters = {{.name = "key",
                       .help = "the setting",
                       .which = true,
                       .names = [](const std::vector<std::string>&) { return setting_keys(); }},
                      {.name = "value", .help = "its new value", .names = setting_values}},
       .check =
           [](const Arguments& a) {
             known_option(a.text("key"));
             plan::Settings().set(a.text("key"), a.text("value"), "");
           },
       .run = [&work](const Arguments& a) { give(work, a.text("key"), a.text("value")); },
       .undoable = true});
  work.registry.add(
      {.name = "reset",
       .help = "Resets a setting to its default.",
       .parameters = {{.name = "key",
                       .help = "the setting",
                       .which = true,
                       .names = [](const std::vector<std::string>&) { return setting_keys(); }}},
       .check = [](const Arguments& a) { known_option(a.text("key")); },
       .run =
           [&work](const Arguments& a) { give(work, a.text("key"), known_option(a.text("key")).fallback); },
       .undoable = true});
  for (const OptionInfo& option : plan::options())
    work.registry.add_prefix(option.key, "set " + quote(option.key));
}

void add_environment_commands(Registry& registry, OpenScene& open) {
  registry.add({.name = "environment.set",
                .help = "Changes the environment. Omitted values stay unchanged.",
                .parameters = {{.name = "scale",
                                .type = Type::real,
                                .help = "multiplies its radiance",
                                .lo = 0,
                                .hi = 1e6,
                                .optional = true},
                               {.name = "rotation",
                                .type = Type::real,
                                .help = "counter-clockwise seen from above",
                                .lo = -360,
                                .hi = 360,
                                .unit = "degrees",
                                .optional = true}},
                .run =
                    [&open](const Arguments& a) {
                      open.needs_scene();
                      if (a.has("scale")) open.edit().environment_scale = a.number("scale");
                      if (a.has("rotation")) open.edit().environment_rotation = a.number("rotation");
                    },
                .undoable = true});
}

void add_shown_commands(Registry& registry, OpenScene& open) {
  std::vector<std::string> components(session::k_component_names.begin(), session::k_component_names.end());
  const auto show_key = [](size_t c) { return std::string("show.") + session::k_component_names[c]; };
  registry.add(
      {.name = "view.show",
       .help = "Includes a component in the shown sum or leaves it out. Computes nothing.",
       .parameters = {{.name = "component", .type = Type::choice, .choices = components, .which = true},
                      {.name = "on", .type = Type::boolean}},
       .run =
           [&open](const Arguments& a) {
             open.edit().solo = -1;
             open.set_by_name("show." + a.text("component"), a.text("on"));
           },
       .undoable = true});
  components.push_back("none");
  registry.add({.name = "view.solo",
                .help = "Shows one component alone; none: restores the former ones.",
                .parameters = {{.name = "component", .type = Type::choice, .choices = components}},
                .run =
                    [&open, components, show_key](const Arguments& a) {
                      Document& d = open.edit();
                      const auto found = std::find(components.begin(), components.end(), a.text("component"));
                      const int chosen =
                          a.text("component") == "none" ? -1 : static_cast<int>(found - components.begin());
                      if (chosen == d.solo) return;
                      if (d.solo < 0)
                        for (const size_t c : k_components)
                          d.shown_before[c] = d.settings[show_key(c)] == "true";
                      d.solo = chosen;
                      for (const size_t c : k_components)
                        d.settings[show_key(c)] =
                            (chosen < 0 ? d.shown_before[c] : static_cast<int>(c) == chosen) ? "true"
                                                                                             : "false";
                      if (chosen >= 0) d.settings["film.layer"] = "beauty";
                    },
                .undoable = true});
}

}  // namespace lucerna::commands
