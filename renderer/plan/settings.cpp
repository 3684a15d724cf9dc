#include "plan/settings.h"

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "paths/automaton.h"
#include "solvers/registry.h"

namespace lucerna::plan {
namespace {

/// What each component is, for help.
constexpr std::array<const char*, paths::k_component_count> k_component_help{
    "emitters and direct light, also seen in mirrors and through glass", "one diffuse interreflection",
    "deeper interreflection, and caustics seen in it",
    "light focused on diffuse surfaces by mirrors and glass"};

/// The choice of a component's solver: those that can compute it, the default first.
OptionInfo component_option(int c) {
  std::vector<std::string> choices;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->serves[size_t(c)]) choices.push_back(solver->name);
  const std::string fallback = choices.front();
  // Who brings but what the camera sees straight leaves the rest to paths, or to somebody who looks it up.
  for (const solvers::SolverInfo* visible : solvers::registered())
    for (const solvers::SolverInfo* rest : solvers::registered())
      if (visible->directly_visible_only && visible->serves[size_t(c)] && rest->looked_up &&
          rest->serves[size_t(c)])
        choices.push_back(visible->name + "+" + rest->name);
  choices.push_back("off");
  const std::string key = std::string("components.") + paths::k_component_names[size_t(c)];
  const std::string help = fmt::format("Solver of the {} component: {}.", paths::k_component_names[size_t(c)],
                                       k_component_help[size_t(c)]);
  return choice_option(key.c_str(), fallback.c_str(), std::move(choices), "", help.c_str());
}

/// How many samples, where, and how they are traced.
void add_sampling_options(std::vector<OptionInfo>& list) {
  const size_t first = list.size();
  list.push_back(integer_option(
      "samples", 256, 1, 1 << 20, "samples",
      "Samples a pixel at which the image is finished, where sampling.mode is uniform.", "Samples"));
  list.push_back(without_restart(choice_option("sampling.mode", "uniform", {"uniform", "adaptive"}, "",
                                               "Samples for all pixels alike, or for the tiles whose noise "
                                               "is not yet under the target. A change keeps "
                                               "the samples there are.",
                                               "Sampling")));
  list.push_back(without_restart(real_option(
      "sampling.target_error", "0.05", 0.0001, 10, "",
      "Adaptive: error as seen under which a tile is done, relative to the light around each pixel. What "
      "film.ev and film.tone_curve show as white or black has no visible error.",
      "Target error")));
  list.push_back(without_restart(integer_option(
      "sampling.min_samples", 64, 2, 1 << 20, "samples",
      "Adaptive: samples that every pixel gets before its tile may be done.", "Least samples")));
  list.push_back(without_restart(integer_option(
      "sampling.max_samples", 1024, 2, 1 << 20, "samples",
      "Adaptive: samples a pixel after which a tile is given up, and reported.", "Most samples")));
  list.push_back(
      choice_option("sampling.tile", "16", {"8", "16"}, "pixels",
                    "Side of the tiles that adaptive sampling decides on, and that coherent sampling shares.",
                    "Tile of sampling"));
  list.push_back(boolean_option(
      "sampling.coherent", "false",
      "The pixels of a tile share their random sequence: neighbouring paths stay together, which some "
      "devices trace faster; noise then has a pattern, and a tile's error is not vouched for.",
      "Coherent tiles"));
  list.push_back(integer_option("seed", 0, 0, 4294967295.0, "",
                                "Seed of every random decision; the same seed gives the same image.",
                                "Seed"));
  list.push_back(choice_option("lights.sampling", "learned", {"power", "learned"}, "",
                               "How lights are chosen at a vertex. power: by what they emit. learned: by "
                               "what has arrived at places nearby, as short pilots find between the first "
                               "samples: less noise where walls or blinds hide most lights, or most of the "
                               "sky. The light is the same.",
                               "Choice of lights"));
  list.push_back(integer_option("path.roulette_depth", 4, 1, 1024, "vertices",
                                "Vertex from which Russian roulette may end a path.", "Roulette from"));
  list.push_back(
      integer_option("path.batch", 131072, 1024, 4194304, "paths",
                     "Paths in flight at once; sets the memory of the path state. Never fewer than "
                     "4096 where light is cached.",
                     "Paths in flight"));
  list.push_back(choice_option(
      "path.classes", "auto", {"auto", "always", "off"}, "",
      "Hits are shaded by kernels of their own for the kinds of materials that most of them are on, instead "
      "of "
      "by one for all. The picture is the same. auto: once enough have been shaded to make up for compiling "
      "them; always: from the second batch of paths on.",
      "Shading by material"));
  for (size_t i = first; i < list.size(); ++i) list[i] = of_same_light(std::move(list[i]));
  list.push_back(integer_option("path.max_depth", 64, 1, 1024, "vertices",
                                "Scattering events between the eye and a light that a path has at most, "
                                "whichever solver computes it. Under 16, irradiance caches are read only by "
                                "vertices that the camera sees directly, because records hold light of paths "
                                "of that many events from there; paths compute the rest.",
                                "Longest path"));
}

void add_relight_options(std::vector<OptionInfo>& list) {
  list.push_back(
      choice_option("relight.enabled", "auto", {"off", "on", "compact", "auto"}, "",
                    "Whether light is kept apart by groups of lights, so that a mix of them costs no ray. "
                    "compact: 16 bytes a pixel for each group; the picture of a mix and its noise are right, "
                    "but it is shared out to the components as if each group had its light in all of them "
                    "alike. on: by component, 200 bytes a pixel for each group, and more time. auto: compact "
                    "in the window, where every solver at work can and an eighth of the device's memory "
                    "is enough; off in batch renders. Where light is not kept apart, a mix lights the scene "
                    "anew.",
                    "Light by groups"));
  list.push_back(text_option(
      "relight.groups",
      "Which lights go together, beside what the scene says: PATTERN=GROUP; PATTERN=GROUP. Patterns (* and "
      "?) "
      "are of names of lamps, materials and nodes, and of sky and sun; the last that fits counts."));
  list.push_back(without_restart(text_option("relight.mix",
                                             "How strong and of which tint each group of lights is: GROUP: "
                                             "ev=NUMBER color=R,G,B mute solo; GROUP: ...")));
  list.push_back(without_restart(text_option(
      "relight.presets", "Mixes with names: NAME = MIX | NAME = MIX, each as relight.mix has it.")));
  list.push_back(
      without_restart(boolean_option("relight.layers", "false",
                                     "EXR files hold a layer for every group of lights and component, "
                                     "light.GROUP.COMPONENT, as they are mixed: together they are the "
                                     "picture. Where relight.enabled is compact: for every group, "
                                     "light.GROUP.",
                                     "Layers by group")));
}

void add_display_options(std::vector<OptionInfo>& list) {
  list.push_back(of_same_light(choice_option(
      "tracer", "auto", {"auto", "compute-bvh", "host"}, "",
      "Who traces rays: auto takes host (Embree) on CPU devices and compute-bvh elsewhere.", "Tracer")));
  list.push_back(text_option("camera", "Name of the scene camera to start with, or its number from 1."));
  list.push_back(without_restart(
      real_option("film.ev", "0", -20, 20, "EV", "Exposure: the picture is multiplied by 2 to this power.")));
  list.push_back(without_restart(choice_option(
      "film.exposure_at_load", "window", {"window", "always", "never"}, "",
      "Where a scene that names no exposure has it found from its first image: in the window when no script "
      "runs, in batch renders too, or nowhere.",
      "Exposure at load")));
  list.push_back(choice_option("film.background", "shown", {"shown", "hidden"}, "",
                               "Whether the eye sees the environment behind the scene. It goes on lighting, "
                               "and mirrors and glass show it.",
                               "Background"));
  list.push_back(without_restart(choice_option("film.tone_curve", "neutral", {"neutral", "agx", "linear"}, "",
                                               "Tone curve of what is shown and of PNG files.")));
  list.push_back(without_restart(choice_option("film.layer", "beauty",
                                               {"beauty", "primary", "secondary", "tertiary", "caustic",
                                                "albedo", "normal", "depth", "samples", "error", "cost"},
                                               "", "Layer shown and written to PNG files.")));
  list.push_back(without_restart(boolean_option(
      "overlay.tiles", "false",
      "Shows over the picture which tiles are at work and how far their error is from the target.")));
  list.push_back(without_restart(
      boolean_option("overlay.lights", "false",
                     "Shows what lights are chosen by at the point under the pointer: arrows to the lights, "
                     "or parts of the sky, that are chosen there most often, with their shares of the light "
                     "samples.",
                     "Lights of a point")));
  list.push_back(without_restart(
      boolean_option("overlay.light_arrival", "false",
                     "Shows over the picture how many of the shadow rays towards lights arrive, of those "
                     "that lights were last learned from.",
                     "Shadow rays that arrive")));
  list.push_back(without_restart(choice_option(
      "preview.filter", "auto", {"auto", "off"}, "",
      "What the window shows: auto filters the noise out of the picture, and keeps what was shown before an "
      "edit until the new light is better; off shows the samples as they are. Figures are always those of "
      "the "
      "samples, and EXR files hold these.",
      "Preview")));
  list.push_back(without_restart(text_option("about", "What the scene is for.")));
  for (const char* name : paths::k_component_names) {
    const std::string key = std::string("show.") + name;
    const std::string help = fmt::format("Whether the shown sum holds the {} layer.", name);
    list.push_back(without_restart(boolean_option(key.c_str(), "true", help.c_str())));
  }
}

std::vector<OptionInfo> make_options() {
  std::vector<OptionInfo> list;
  for (int c = 0; c < paths::k_component_count; ++c) list.push_back(component_option(c));
  add_sampling_options(list);
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const OptionInfo& option : solver->options) list.push_back(of_same_light(option));
  add_relight_options(list);
  add_display_options(list);
  return list;
}

}  // namespace

const std::vector<OptionInfo>& options() {
  static const std::vector<OptionInfo> list = make_options();
  return list;
}

const OptionInfo* find_option(const std::string& key) { return lucerna::find_option(options(), key); }

Settings::Settings() : OptionValues(options()) {}

std::string Settings::changed_json() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const OptionInfo& option : options())
    if (text(option.key) != option.fallback) json[option.key] = text(option.key);
  return json_text(json);
}

}  // namespace lucerna::plan
