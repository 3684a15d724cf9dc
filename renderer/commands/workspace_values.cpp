// The values of a workspace (values.h).
#include <algorithm>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/light_words.h"
#include "commands/text.h"
#include "commands/values.h"
#include "commands/workspace.h"
#include "plan/settings.h"

namespace lucerna::commands {
namespace {

using Words = std::vector<std::string>;

/// A part of an object by name, for values such as 'light LIGHT PART'.
template <class T>
using Part = std::pair<const char*, std::string (*)(const T&)>;

template <class T, size_t N>
std::string part_of(const T& object, const std::string& name, const Part<T> (&parts)[N],
                    const Words& also = {}) {
  Words known;
  for (const auto& [part, read] : parts) {
    if (name == part) return read(object);
    known.emplace_back(part);
  }
  known.insert(known.end(), also.begin(), also.end());
  throw Error("", fmt::format("there is no part '{}'{}; expected one of {}", name, suggestion(name, known),
                              fmt::join(known, ", ")));
}

template <class T, size_t N>
Words names_in(const Part<T> (&parts)[N]) {
  Words names;
  for (const auto& part : parts) names.emplace_back(part.first);
  return names;
}

Words unit_words() {
  Words words;
  for (const scene::LightUnitInfo& info : scene::k_unit_table) words.emplace_back(info.word);
  return words;
}

float largest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

/// The strength of a light in a unit. Throws Error if lights of its kind have none.
std::string strength_text(const scene::Light& light, scene::LightUnit unit, float distance) {
  const auto strength = scene::strength_in(light, unit, double{distance});
  if (strength) return word(float(*strength));
  throw Error("", fmt::format("a {} has no {}", kind_of(light), info_of(unit).word));
}

const Part<scene::Light> k_light_parts[] = {
    {"on", [](const scene::Light& l) { return word(l.enabled); }},
    {"intensity", [](const scene::Light& l) { return word(largest(l.intensity)); }},
    {"light", [](const scene::Light& l) { return word(l.intensity); }},
    {"position", [](const scene::Light& l) { return word(l.position); }},
    {"direction", [](const scene::Light& l) { return word(l.direction); }},
};

const Part<Document::Material> k_material_parts[] = {
    {"color", [](const Document::Material& m) { return word(vec3(m.base_color)); }},
    {"roughness", [](const Document::Material& m) { return word(m.roughness); }},
    {"metallic", [](const Document::Material& m) { return word(m.metallic); }},
    {"emission", [](const Document::Material& m) { return word(m.emission); }},
    {"on", [](const Document::Material& m) { return word(m.emits); }},
};

/// Of an error that is known after two samples.
std::string known_error(const std::optional<double>& error) {
  if (!error) throw Error("", "the error is not known yet; it needs two samples per pixel");
  return word(*error);
}

const Part<session::ComponentStatus> k_component_parts[] = {
    {"solver", [](const session::ComponentStatus& c) { return c.solver; }},
    {"reason", [](const session::ComponentStatus& c) { return c.reason; }},
    {"luminance", [](const session::ComponentStatus& c) { return word(c.mean_luminance); }},
    {"share", [](const session::ComponentStatus& c) { return word(c.share); }},
    {"error", [](const session::ComponentStatus& c) { return known_error(c.error); }},
};

const Part<session::LayerStatus> k_layer_parts[] = {
    {"expression", [](const session::LayerStatus& l) { return l.expression; }},
    {"luminance", [](const session::LayerStatus& l) { return word(luminance(l.mean)); }},
    {"share", [](const session::LayerStatus& l) { return word(l.share); }},
    {"error",
     [](const session::LayerStatus& l) {
       if (!l.lacks.empty())
         throw Error("", fmt::format("its error is not known: it lacks {} light, which is stored for several "
                                     "words together",
                                     l.lacks));
       return known_error(l.error);
     }},
    {"lacks", [](const session::LayerStatus& l) { return l.lacks; }},
};

Words light_parts() {
  Words names = names_in(k_light_parts);
  for (std::string& unit : unit_words()) names.push_back(std::move(unit));
  return names;
}

/// An object with where it is.
struct PlacedObject {
  scene::ObjectPlace place;
  vec3 middle;
};
const Part<PlacedObject> k_object_parts[] = {
    {"position", [](const PlacedObject& o) { return word(o.middle); }},
    {"rotation", [](const PlacedObject& o) { return word(o.place.turned); }},
    {"scale", [](const PlacedObject& o) { return word(o.place.scaled); }},
    {"visible", [](const PlacedObject& o) { return word(!o.place.hidden); }},
};

/// The newest picture. Throws Error if there is none.
const session::Snapshot& picture_of(const Workspace& work) {
  if (!work.open.snapshot || work.open.snapshot->rgba.empty()) throw Error("", "there is no picture yet");
  return *work.open.snapshot;
}

void add_picture_values(Workspace& work) {
  const auto add = [&work](const char* name, const char* help,
                           std::string (*read)(const session::Snapshot&)) {
    work.values.add(
        {.name = name, .help = help, .read = [&work, read](const Words&) { return read(picture_of(work)); }});
  };
  using S = const session::Snapshot&;
  add("picture.samples", "complete samples per pixel", [](S s) { return word(s.samples); });
  add("picture.mean_samples", "mean samples per pixel", [](S s) { return word(s.mean_samples); });
  add("picture.width", "its width in pixels", [](S s) { return word(s.width); });
  add("picture.height", "its height in pixels", [](S s) { return word(s.height); });
  add("picture.finished", "true if it has all its samples", [](S s) { return word(s.finished); });
  add("picture.paused", "true if rendering is paused", [](S s) { return word(s.paused); });
  add("picture.preparing", "what a solver prepares at present; \"\" if nothing",
      [](S s) { return s.preparing; });
  add("picture.stale", "share of its light from before the last edit, 0..1",
      [](S s) { return word(s.stale); });
  add("picture.filtered", "share of its light that is filtered, 0..1", [](S s) { return word(s.filtered); });
  add("picture.dropped", "contributions refused because they were not finite",
      [](S s) { return word(s.dropped); });
  add("picture.error", "estimated error as seen; in a script after a wait for two samples", [](S s) {
    const auto* ledger = s.accuracy ? &s.accuracy->ledger.entries() : nullptr;
    const bool known = ledger && !ledger->empty() && ledger->back().has_error;
    return known_error(known ? std::optional(ledger->back().sum()) : std::nullopt);
  });
  add("picture.luminance", "mean luminance of the picture before exposure", [](S s) {
    double sum = 0;
    for (const session::ComponentStatus& c : s.components) sum += c.mean_luminance;
    return word(sum);
  });
}

void add_object_values(Workspace& work) {
  work.values.add(
      {.name = "light",
       .help = fmt::format("of a lamp: {}; intensity is the strongest channel of light (cd, or lx "
                           "of a directional one); {} are its luminance, lx at the distance of "
                           "light.unit",
                           fmt::join(light_parts(), ", "), fmt::join(unit_words(), ", ")),
       .words = {"LIGHT", "PART"},
       .names =
           [&work](const Words& before) {
             if (!before.empty()) return light_parts();
             return work.open.scene ? given_names(work.open.scene->lights) : Words();
           },
       .read =
           [&work](const Words& w) {
             const scene::Light& light = work.open.light(work.open.light_index(w[0]));
             if (const auto unit = scene::unit_named(w[1]))
               return strength_text(light, *unit, work.open.light_unit.distance);
             return part_of(light, w[1], k_light_parts, unit_words());
           }});
  work.values.add({.name = "material",
                   .help = fmt::format("of a material: {}; of its emission: lm, watts, nits",
                                       fmt::join(names_in(k_material_parts), ", ")),
                   .words = {"MATERIAL", "PART"},
                   .names =
                       [&work](const Words& before) {
                         if (!before.empty()) {
                           Words names = names_in(k_material_parts);
                           names.insert(names.end(), {"lm", "watts", "nits"});
                           return names;
                         }
                         return work.open.scene ? given_names(work.open.scene->materials) : Words();
                       },
                   .read =
                       [&work](const Words& w) {
                         const uint32_t index = work.open.material_index(w[0]);
                         if (const auto unit = scene::unit_named(w[1]))
                           return word(float(work.open.emission_factor(index, *unit) *
                                             scene::exact_luminance(work.open.emission(index))));
                         return part_of(work.open.document().materials.at(index), w[1], k_material_parts,
                                        {"lm", "watts", "nits"});
                       }});
  work.values.add({.name = "object",
                   .help = fmt::format(
                       "of an object: {}; position is the middle of its box, rotation (degrees) and scale "
                       "are relative to its file",
                       fmt::join(names_in(k_object_parts), ", ")),
                   .words = {"OBJECT", "PART"},
                   .names =
                       [&work](const Words& before) {
                         if (!before.empty()) return names_in(k_object_parts);
                         return work.open.scene ? given_names(work.open.scene->instances) : Words();
                       },
                   .read =
                       [&work](const Words& w) {
                         const uint32_t index = work.open.object_index(w[0]);
                         return part_of(PlacedObject{work.open.object(index),
                                                     scene::middle_of(work.open.object_box(index),
                                                                      work.open.object_matrix(index))},
                                        w[1], k_object_parts);
                       }});
  work.values.add(
      {.name = "component",
       .help = fmt::format("of a component of the light: {}", fmt::join(names_in(k_component_parts), ", ")),
       .words = {"COMPONENT", "PART"},
       .names =
           [](const Words& before) {
             return before.empty()
                        ? Words(session::k_component_names.begin(), session::k_component_names.end())
                        : names_in(k_component_parts);
           },
       .read =
           [&work](const Words& w) {
             const auto& names = session::k_component_names;
             const auto found = std::find(names.begin(), names.end(), w[0]);
             if (found == names.end())
               throw Error("", fmt::format("there is no component '{}'; expected one of {}", w[0],
                                           fmt::join(names, ", ")));
             return part_of(picture_of(work).components[static_cast<size_t>(found - names.begin())], w[1],
                            k_component_parts);
           }});
  work.values.add({.name = "layer",
                   .help = fmt::format("of a layer by path expression: {}; its error is noise as seen",
                                       fmt::join(names_in(k_layer_parts), ", ")),
                   .words = {"LAYER", "PART"},
                   .names =
                       [&work](const Words& before) {
                         if (!before.empty()) return names_in(k_layer_parts);
                         Words names;
                         for (const paths::Layer& layer :
                              session::layers_in(work.open.setting("film.layers")))
                           names.push_back(layer.name);
                         return names;
                       },
                   .read =
                       [&work](const Words& w) {
                         Words known;
                         for (const session::LayerStatus& layer : picture_of(work).layers) {
                           if (layer.name == w[0]) return part_of(layer, w[1], k_layer_parts);
                           known.push_back(layer.name);
                         }
                         throw Error("", fmt::format("the picture has no layer '{}'; it has {}", w[0],
                                                     known.empty() ? "none (layer.add)"
                                                                   : fmt::to_string(fmt::join(known, ", "))));
                       }});
  work.values.add({.name = "solver",
                   .help = "a figure of a solver's report, such as 'solver cache records', or its state",
                   .words = {"SOLVER", "FIGURE"},
                   .names =
                       [&work](const Words& before) {
                         Words names;
                         if (!work.open.snapshot) return names;
                         for (const auto& report : work.open.snapshot->reports) {
                           if (before.empty()) names.push_back(report->solver);
                           if (before.empty() || report->solver != before[0]) continue;
                           names = {"state", "ready"};
                           for (const auto& [name, value] : report->figures) names.push_back(name);
                         }
                         return names;
                       },
                   .read =
                       [&work](const Words& w) {
                         for (const auto& report : picture_of(work).reports) {
                           if (report->solver != w[0]) continue;
                           if (w[1] == "state") return report->state;
                           if (w[1] == "ready") return word(report->ready);
                           Words known{"state", "ready"};
                           for (const auto& [name, value] : report->figures) {
                             if (name == w[1]) return word(value);
                             known.push_back(name);
                           }
                           throw Error("", fmt::format("{} reports no '{}'; expected one of {}", w[0], w[1],
                                                       fmt::join(known, ", ")));
                         }
                         throw Error("", fmt::format("the solver '{}' is not in use", w[0]));
                       }});
}

void add_state_values(Workspace& work) {
  const auto add = [&work](const char* name, const char* help,
                           std::function<std::string(const Workspace&)> read) {
    work.values.add({.name = name, .help = help, .read = [&work, read = std::move(read)](const Words&) {
                       return read(work);
                     }});
  };
  using W = const Workspace&;
  const auto scene = [](W w) -> const scene::Scene& {
    if (!w.open.scene) throw Error("", "no scene is open");
    return *w.open.scene;
  };
  add("scene.name", "name of the scene", [scene](W w) { return scene(w).name; });
  add("scene.lights", "its number of lamps", [scene](W w) { return word(scene(w).lights.size()); });
  add("scene.materials", "its number of materials", [scene](W w) { return word(scene(w).materials.size()); });
  add("scene.instances", "its number of objects", [scene](W w) { return word(scene(w).instances.size()); });
  add("environment.scale", "factor on the environment's light",
      [](W w) { return word(w.open.environment_scale()); });
  add("environment.rotation", "its rotation in degrees",
      [](W w) { return word(w.open.environment_rotation()); });
  add("environment.file", "the image that replaces the scene's environment; \"\" if none",
      [](W w) { return w.open.environment_file(); });
  add("camera.position", "the camera's position in metres", [](W w) {
    w.camera.needs_view();
    return word(vec3(w.camera.view->camera.to_world[3]));
  });
  add("camera.direction", "unit vector along the view axis", [](W w) {
    w.camera.needs_view();
    return word(-glm::normalize(vec3(w.camera.view->camera.to_world[2])));
  });
  add("history.undo", "number of steps that can be undone", [](W w) { return word(w.history.undo_steps()); });
  add("history.redo", "number of steps that can be done again",
      [](W w) { return word(w.history.redo_steps()); });
  add("history.last", "the line that undo would revert; \"\" if none",
      [](W w) { return w.history.undo_text(); });
  add("light.unit", "the unit in which strengths of lights are shown",
      [](W w) { return std::string(info_of(w.open.light_unit.unit).word); });
  add("light.distance", "at which lx are shown, in metres",
      [](W w) { return word(w.open.light_unit.distance); });
  add("selection", "name of what is selected; \"\" if nothing", [](W w) { return w.selection_name(); });
  add("log.errors", "errors logged since the program started", [](W w) { return word(w.error_count); });
}

}  // namespace

std::string Values::read(const Workspace& work, const ValueWords& value) const {
  const auto known = values_.find(value.name);
  return known == values_.end() ? work.open.setting(value.name) : known->second.read(value.words);
}

void add_values(Workspace& work) {
  add_picture_values(work);
  add_object_values(work);
  add_state_values(work);
  const auto of = [](const Arguments& a) {
    Words words;
    for (const Word& w : split(a.text("value"))) words.push_back(w.text);
    return words;
  };
  work.registry.add(
      {.name = "get",
       .help = "Prints a setting or a value of the session; 'help values' lists them.",
       .parameters = {{.name = "value",
                       .type = Type::rest,
                       .help = "a setting's key, or a value with its words",
                       .names = [&work](const Words& before) { return work.values.suggestions(before); }}},
       .check =
           [&work, of](const Arguments& a) {
             Words words = of(a);
             work.values.take(words);
             if (!words.empty()) throw Error("", fmt::format("'{}' is one word too many", words[0]));
           },
       .answer =
           [&work, of](const Arguments& a) {
             Words words = of(a);
             return a.text("value") + " = " + work.values.read(work, work.values.take(words));
           },
       .recorded = false,
       .needs_outcome = true});
}

}  // namespace lucerna::commands
