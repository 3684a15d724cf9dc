// Undoable commands of the light mix: strength and tint of light groups. They trace no rays if groups are
// separate.
#include <algorithm>
#include <cmath>

#include "base/blackbody.h"
#include "base/color.h"
#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/open_scene.h"

namespace lucerna::commands {
namespace {

Parameter one_of(const char* name, const char* help, std::function<std::vector<std::string>()> names) {
  return {.name = name,
          .type = Type::text,
          .help = help,
          .which = true,
          .names = [names = std::move(names)](const std::vector<std::string>&) { return names(); }};
}

/// Applies the given values; others stay.
void take(const Arguments& a, scene::GroupMix& group) {
  if (a.has("ev") && a.has("factor")) throw Error("", "ev and factor exclude each other: give one");
  if (a.has("color") && a.has("kelvin")) throw Error("", "color and kelvin exclude each other: give one");
  if (a.has("ev")) group.ev = a.number("ev");
  if (a.has("factor")) {
    const double factor = a.real("factor");
    if (factor > 0)
      group.ev = std::clamp(static_cast<float>(std::log2(factor)), -scene::k_most_ev, scene::k_most_ev);
    group.mute = !(factor > 0);
  }
  if (a.has("color")) group.color = a.vector("color");
  if (a.has("kelvin")) group.color = blackbody_color(a.number("kelvin"));
  if (a.has("mute")) group.mute = a.boolean("mute");
  if (a.has("solo")) group.solo = a.boolean("solo");
}

/// Why a weight cannot be written into the lights of a group; "": it can.
std::string refusal(const scene::Scene& scene, const scene::LightGroups& groups, size_t g,
                    const std::vector<vec3>& weights) {
  const vec3& w = weights[g];
  if (groups.groups[g].sky || groups.groups[g].sun) {
    if (w.x != w.y || w.y != w.z) return "an environment takes one strength, and no colour";
    if (weights[groups.sky] != weights[groups.sun])
      return "an environment's sky and sun take one strength together";
  }
  for (size_t i = 0; i < scene.instances.size(); ++i)
    for (size_t p = 0; p < groups.surfaces[i].size(); ++p) {
      const scene::Id id = scene.meshes[scene.instances[i].mesh].primitives[p].material;
      const scene::Material& m = scene.materials[id];
      if (!scene::is_light(m) || groups.surfaces[i][p] != g) continue;
      if (m.unlit) return fmt::format("material '{}' is unlit and emits nothing", m.name);
      for (size_t k = 0; k < scene.instances.size(); ++k)
        for (size_t q = 0; q < groups.surfaces[k].size(); ++q)
          if (scene.meshes[scene.instances[k].mesh].primitives[q].material == id &&
              weights[groups.surfaces[k][q]] != w)
            return fmt::format("material '{}' shines in '{}', too, which is mixed otherwise", m.name,
                               groups.groups[groups.surfaces[k][q]].name);
    }
  return "";
}

/// Throws Error with the list of names if there is no such group.
std::string group_named(OpenScene& open, const std::string& which) {
  open.needs_scene();
  std::vector<std::string> names;
  for (const scene::LightGroup& group : open.light_groups().groups) names.push_back(group.name);
  if (std::find(names.begin(), names.end(), which) != names.end()) return which;
  throw Error("", fmt::format("the scene has no light group '{}'{}; there are: {}", which,
                              suggestion(which, names), fmt::join(names, ", ")));
}

/// Likewise of a preset.
const scene::LightMix& preset_named(const scene::MixPresets& presets, const std::string& name) {
  if (const auto found = presets.find(name); found != presets.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, mix] : presets) names.push_back(known);
  throw Error("", names.empty() ? fmt::format("there is no preset '{}': mix.preset.save makes one", name)
                                : fmt::format("there is no preset '{}'{}; there are: {}", name,
                                              suggestion(name, names), fmt::join(names, ", ")));
}

/// Reports groups of the preset that the scene does not have.
void warn_of_groups(OpenScene& open, const std::string& name, const scene::LightMix& mix) {
  const std::vector<std::string> gone = scene::unknown_groups(mix, open.light_groups());
  if (!gone.empty())
    log::warning("preset '{}': the scene has no light group {}; the others are set", name,
                 fmt::join(gone, ", "));
}

/// Writes the mix into the lights.
void apply_mix(OpenScene& open) {
  open.needs_scene();
  const scene::LightGroups groups = open.light_groups();
  const scene::LightMix mix = open.light_mix();
  const std::vector<vec3> weights = scene::mix_weights(mix, groups);
  Document& d = open.edit();
  if (groups.lamps.size() != d.lights.size())
    throw Error("", "lights are being added or removed; repeat this when that is done");
  scene::LightMix left;
  std::vector<bool> written(groups.groups.size());
  for (size_t g = 0; g < groups.groups.size(); ++g) {
    if (weights[g] == vec3(1)) continue;
    const std::string& name = groups.groups[g].name;
    const std::string why = refusal(*open.scene, groups, g, weights);
    written[g] = why.empty();
    if (written[g]) continue;
    log::warning("group '{}' keeps its mix: {}", name, why);
    scene::GroupMix& kept = left[name];
    const float strength = strength_of(weights[g]);
    kept.mute = !(strength > 0);
    if (strength > 0) kept.ev = std::log2(strength), kept.color = tint_of(weights[g]);
  }
  for (size_t i = 0; i < d.lights.size(); ++i) {
    const size_t g = groups.lamps[i];
    if (!written[g]) continue;
    if (weights[g] == vec3(0))
      d.lights[i].enabled = false;
    else
      d.lights[i].intensity *= weights[g];
  }
  std::vector<bool> done(d.materials.size());
  for (size_t i = 0; i < groups.surfaces.size(); ++i)
    for (size_t p = 0; p < groups.surfaces[i].size(); ++p) {
      const scene::Id m = open.scene->meshes[open.scene->instances[i].mesh].primitives[p].material;
      const size_t g = groups.surfaces[i][p];
      if (!scene::is_light(open.scene->materials[m]) || done[m] || !written[g]) continue;
      done[m] = true;
      if (weights[g] == vec3(0))
        d.materials[m].emits = false;
      else
        d.materials[m].emission *= weights[g];
    }
  if (!groups.groups.empty() && written[groups.sky] && groups.groups[groups.sky].sky)
    d.environment_scale *= weights[groups.sky].x;
  d.settings["relight.mix"] = scene::mix_text(left);
}

}  // namespace

void add_mix_commands(Registry& registry, OpenScene& open) {
  const auto group_names = [&open] {
    std::vector<std::string> names;
    for (const scene::LightGroup& group : open.light_groups().groups) names.push_back(group.name);
    return names;
  };
  const auto preset_names = [&open] {
    std::vector<std::string> names;
    for (const auto& [name, mix] : open.mix_presets()) names.push_back(name);
    return names;
  };
  constexpr double most = scene::k_most_ev;
  registry.add(
      {.name = "mix.set",
       .help = "Mixes a light group: strength, colour, on and off. With separate groups (relight.enabled) it "
               "traces "
               "no rays. Omitted values stay unchanged.",
       .parameters =
           {one_of("group", "name of the group", group_names),
            {.name = "ev",
             .type = Type::real,
             .help = "strength",
             .lo = -most,
             .hi = most,
             .unit = "EV",
             .optional = true},
            {.name = "factor",
             .type = Type::real,
             .help = "strength as a factor; 0 mutes",
             .lo = 0,
             .hi = 1e9,
             .optional = true},
            {.name = "color",
             .type = Type::vector,
             .help = "linear; multiplies that of the lights",
             .lo = 0,
             .hi = scene::k_most_tint,
             .optional = true},
            {.name = "kelvin",
             .type = Type::real,
             .help = "multiplies by the colour of a black body of that temperature",
             .lo = k_coolest_kelvin,
             .hi = k_hottest_kelvin,
             .unit = "K",
             .optional = true},
            {.name = "mute", .type = Type::boolean, .help = "removes its light", .optional = true},
            {.name = "solo", .type = Type::boolean, .help = "shows it without the others", .optional = true}},
       .run =
           [&open](const Arguments& a) {
             const std::string name = group_named(open, a.text("group"));
             scene::LightMix mix = open.light_mix();
             take(a, mix[name]);
             open.edit().settings["relight.mix"] = scene::mix_text(mix);
           },
       .undoable = true});
  registry.add({.name = "mix.reset",
                .help = "Resets the mix of all light groups.",
                .parameters = {},
                .run = [&open](const Arguments&) { open.edit().settings["relight.mix"].clear(); },
                .undoable = true});
  registry.add({.name = "mix.group",
                .help = "Moves lights into a group: lamps, materials or nodes of that name, or sky or sun. "
                        "Restarts the picture.",
                .parameters = {{.name = "light", .help = "a name, or a pattern with * and ?", .which = true},
                               one_of("group", "name of the group, which may be new", group_names)},
                .check =
                    [](const Arguments& a) {
                      if (scene::group_name(a.text("group")).empty())
                        throw Error("", "group: a name is needed");
                    },
                .run =
                    [&open](const Arguments& a) {
                      // Rules are separated by these characters; ? matches any.
                      std::string light = a.text("light");
                      for (char& c : light) c = c == ';' || c == '=' ? '?' : c;
                      std::string& rules = open.edit().settings["relight.groups"];
                      rules += (rules.empty() ? "" : "; ") + light + "=" + scene::group_name(a.text("group"));
                    },
                .undoable = true});
  registry.add({.name = "mix.preset.save",
                .help = "Saves the light mix as a preset; replaces one of that name.",
                .parameters = {one_of("name", "of the preset", preset_names)},
                .check =
                    [](const Arguments& a) {
                      if (scene::group_name(a.text("name")).empty())
                        throw Error("", "name: must not be empty");
                    },
                .run =
                    [&open](const Arguments& a) {
                      scene::MixPresets presets = open.mix_presets();
                      presets[scene::group_name(a.text("name"))] = open.light_mix();
                      open.edit().settings["relight.presets"] = scene::presets_text(presets);
                    },
                .undoable = true});
  registry.add({.name = "mix.preset.load",
                .help = "Applies a preset of the light mix.",
                .parameters = {one_of("name", "of the preset", preset_names)},
                .run =
                    [&open](const Arguments& a) {
                      open.needs_scene();
                      const scene::MixPresets presets = open.mix_presets();
                      const scene::LightMix& mix = preset_named(presets, a.text("name"));
                      warn_of_groups(open, a.text("name"), mix);
                      open.edit().settings["relight.mix"] = scene::mix_text(mix);
                    },
                .undoable = true});
  registry.add({.name = "mix.preset.delete",
                .help = "Deletes a preset of the light mix.",
                .parameters = {one_of("name", "of the preset", preset_names)},
                .run =
                    [&open](const Arguments& a) {
                      scene::MixPresets presets = open.mix_presets();
                      preset_named(presets, a.text("name"));
                      presets.erase(a.text("name"));
                      open.edit().settings["relight.presets"] = scene::presets_text(presets);
                    },
                .undoable = true});
  registry.add(
      {.name = "mix.preset.blend",
       .help = "Applies a mix between two presets, interpolated linearly in light.",
       .parameters = {one_of("from", "preset", preset_names),
                      one_of("to", "preset", preset_names),
                      {.name = "amount", .type = Type::real, .help = "0 is from, 1 is to", .lo = 0, .hi = 1}},
       .run =
           [&open](const Arguments& a) {
             open.needs_scene();
             const scene::MixPresets presets = open.mix_presets();
             const scene::LightMix &from = preset_named(presets, a.text("from")),
                                   &to = preset_named(presets, a.text("to"));
             open.edit().settings["relight.mix"] =
                 scene::mix_text(scene::blend(from, to, a.number("amount"), open.light_groups()));
           },
       .undoable = true});
  registry.add(
      {.name = "mix.apply",
       .help = "Writes the light mix into the scene's lamps, surfaces and environment, and resets it. The "
               "total light is unchanged: with separate groups, the picture keeps its samples. A group whose "
               "lights "
               "cannot represent the mix keeps it, with a warning.",
       .parameters = {},
       .run = [&open](const Arguments&) { apply_mix(open); },
       .undoable = true});
}

}  // namespace lucerna::commands
