#include "plan/settings.h"

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "paths/automaton.h"
#include "plan/choose.h"
#include "solvers/registry.h"

namespace lucerna::plan {
namespace {

/// Description of each component, for help.
constexpr ByComponent<const char*> k_component_help{
    "emitters and direct light, also seen in mirrors and through glass", "one diffuse interreflection",
    "deeper interreflection, and caustics seen in it",
    "light focused on diffuse surfaces by mirrors and glass"};

/// Option of a component's solver: those that can compute it, the default first.
OptionInfo component_option(int c) {
  std::vector<std::string> choices;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->serves[size_t(c)]) choices.push_back(solver->name);
  const std::string fallback = choices.front();
  // A solver of directly visible light delegates the rest to paths, or to a solver with lookups.
  for (const solvers::SolverInfo* visible : solvers::registered())
    for (const solvers::SolverInfo* rest : solvers::registered())
      if (visible->directly_visible_only && visible->serves[size_t(c)] && rest->looked_up &&
          rest->serves[size_t(c)])
        choices.push_back(visible->name + "+" + rest->name);
  choices.emplace_back(k_auto);
  choices.emplace_back("off");
  const std::string key = std::string("components.") + paths::k_component_names[size_t(c)];
  const std::string help = fmt::format(
      "Solver of the {} component: {}. auto: chosen for the scene, "
      "by what it contains and by the first samples of paths.",
      paths::k_component_names[size_t(c)], k_component_help[size_t(c)]);
  return choice_option(key.c_str(), fallback.c_str(), std::move(choices), "", help.c_str());
}

/// Number and distribution of samples, and how they are traced.
void add_sampling_options(std::vector<OptionInfo>& list) {
  const size_t first = list.size();
  list.push_back(
      integer_option("samples", 256, 1, 1 << 20, "samples",
                     "Samples per pixel at which the image is finished, in uniform sampling; in balanced "
                     "sampling the mean.",
                     "Samples"));
  list.push_back(without_restart(
      choice_option("sampling.mode", "uniform", {"uniform", "adaptive", "balanced"}, "",
                    "uniform: equally many samples for all pixels. adaptive: samples for the tiles whose "
                    "error exceeds the target. balanced: as many samples as uniform on average, more of them "
                    "where they lower the picture's error most; where photons are traced in rounds, uniform. "
                    "A change keeps the present samples.",
                    "Sampling")));
  list.push_back(without_restart(real_option(
      "sampling.target_error", "0.05", 0.0001, 10, "",
      "Adaptive: error as seen at which a tile is done, relative to the light around each pixel. "
      "Light shown as white or black by film.ev and the tone curve, or film.ocio, has no visible error.",
      "Target error")));
  list.push_back(
      without_restart(integer_option("sampling.min_samples", 64, 2, 1 << 20, "samples",
                                     "Adaptive: minimum samples of every pixel.", "Minimum samples")));
  list.push_back(without_restart(integer_option(
      "sampling.max_samples", 1024, 2, 1 << 20, "samples",
      "Adaptive: samples per pixel at which a tile stops without reaching the target, and is reported.",
      "Maximum samples")));
  list.push_back(choice_option("sampling.tile", "16", {"8", "16"}, "pixels",
                               "Side of the tiles of adaptive and of coherent sampling.", "Sampling tile"));
  list.push_back(without_restart(text_option(
      "sampling.region",
      "LEFT,TOP,WIDTH,HEIGHT, in fractions of the picture: only this rectangle gets samples, in whole blocks "
      "of 8x8 pixels (adaptive: tiles); the rest keeps those it has. Empty: the whole picture. In the window "
      "every pixel first gets two samples.")));
  list.push_back(boolean_option(
      "sampling.coherent", "false",
      "The pixels of a tile share their random sequence: neighbouring paths stay coherent, which some "
      "devices trace faster; noise then has a pattern, and error estimates of tiles are unreliable.",
      "Coherent tiles"));
  list.push_back(integer_option("seed", 0, 0, 4294967295.0, "",
                                "Seed of all random numbers; the same seed gives the same image.", "Seed"));
  list.push_back(
      choice_option("lights.sampling", "learned", {"power", "learned"}, "",
                    "Light selection at a vertex. power: by emitted power. learned: by the light that "
                    "arrives nearby, learned in short pilots between the first samples: less noise where "
                    "walls or blinds hide most lights, or most of the sky. Unbiased in both cases. "
                    "Both sample the sky through portals too (lights.portals).",
                    "Light selection"));
  list.push_back(
      choice_option("lights.portals", "found", {"marked", "found"}, "",
                    "Rectangles through which the sky is sampled, a hint that changes noise and never the "
                    "mean. marked: the scene's own portals (extras.portal). found: where the scene marks "
                    "none, openings of the rooms around its cameras are searched by rays while a scene "
                    "with a sky loads; the log lists them. No use outdoors.",
                    "Portals"));
  list.push_back(integer_option("path.roulette_depth", 4, 1, 1024, "vertices",
                                "Vertex from which Russian roulette may end a path.", "Roulette from"));
  list.push_back(integer_option(
      "path.batch", 131072, 1024, 4194304, "paths",
      "Paths in flight; sets the memory of the path state. At least 4096 with an irradiance cache.",
      "Paths in flight"));
  list.push_back(
      choice_option("path.classes", "auto", {"auto", "always", "off"}, "",
                    "Shades hits on the most frequent kinds of materials with specialized kernels instead of "
                    "one kernel for all. The picture is identical. auto: after enough hits to make up for "
                    "their compilation; always: from the second batch of paths on.",
                    "Shading by material"));
  for (size_t i = first; i < list.size(); ++i) list[i] = of_same_light(std::move(list[i]));
  list.push_back(
      integer_option("path.max_depth", 64, 1, 1024, "vertices",
                     "Maximum number of scattering events between the eye and a light, for every solver. "
                     "Below 16, irradiance caches are read only at directly visible surfaces, because "
                     "records store light of that many events from there; paths compute the rest.",
                     "Maximum events"));
}

void add_relight_options(std::vector<OptionInfo>& list) {
  list.push_back(choice_option(
      "relight.enabled", "auto", {"off", "on", "compact", "auto"}, "",
      "Stores light groups separately, so that a mix of them traces no rays. compact: 16 bytes per pixel and "
      "group; the picture of a mix and its noise are correct, but its split into components assumes equal "
      "shares in all groups. on: by component, 200 bytes per pixel and group, and slower. auto: compact in "
      "the window, if every active solver supports it and an eighth of the device's memory is enough; off in "
      "batch renders. Without separate groups, a mix relights the scene.",
      "Per-group light"));
  list.push_back(
      text_option("relight.groups",
                  "Groups of lights besides the scene's: PATTERN=GROUP; PATTERN=GROUP. Patterns (* and ?) "
                  "match names of lamps, materials and nodes, and sky and sun; the last match counts."));
  list.push_back(without_restart(
      text_option("relight.mix",
                  "Strength and tint of light groups: GROUP: ev=NUMBER color=R,G,B mute solo; GROUP: ...")));
  list.push_back(without_restart(text_option(
      "relight.presets", "Mixes with names: NAME = MIX | NAME = MIX, each as relight.mix has it.")));
  list.push_back(without_restart(boolean_option(
      "relight.layers", "false",
      "EXR files contain a layer for every light group and component, light.GROUP.COMPONENT, as mixed: "
      "together they are the picture. With relight.enabled=compact: one per group, light.GROUP.",
      "Layers by group")));
}

void add_display_options(std::vector<OptionInfo>& list) {
  list.push_back(of_same_light(
      choice_option("tracer", "auto", {"auto", "compute-bvh", "host"}, "",
                    "Ray tracer. auto: host (Embree) on CPU devices, compute-bvh otherwise.", "Tracer")));
  list.push_back(text_option("camera", "Name of the scene camera to start with, or its number from 1."));
  list.push_back(without_restart(
      real_option("film.ev", "0", -20, 20, "EV", "Exposure: the picture is multiplied by 2^EV.")));
  list.push_back(
      without_restart(choice_option("film.exposure_at_load", "window", {"window", "always", "never"}, "",
                                    "When the exposure of a scene without one is measured from its first "
                                    "image: in the window without a script, in batch renders too, or never. "
                                    "Where it is, a new sky, environment image or sun sets it again if it is "
                                    "more than 2 EV off.",
                                    "Automatic exposure")));
  list.push_back(choice_option("film.background", "shown", {"shown", "hidden"}, "",
                               "Shows or hides the environment behind the scene. Hidden, it still lights the "
                               "scene, and mirrors and glass show it.",
                               "Background"));
  list.push_back(without_restart(choice_option("film.tone_curve", "neutral", {"neutral", "agx", "linear"}, "",
                                               "Tone curve of the display and of PNG files.")));
  list.push_back(without_restart(text_option(
      "film.ocio",
      "DISPLAY: VIEW of the OpenColorIO configuration that the environment variable OCIO names, in place of "
      "the tone curve, in the window and in PNG files; without a view the display's default one. Empty: the "
      "tone curve, as after a choice of one. Errors as seen follow what is shown.")));
  OptionInfo layer = choice_option("film.layer", "beauty",
                                   {"beauty", "primary", "secondary", "tertiary", "caustic", "albedo",
                                    "normal", "depth", "samples", "error", "cost"},
                                   "", "Layer shown and written to PNG files; also one of film.layers.");
  layer.other_names = true;
  list.push_back(without_restart(std::move(layer)));
  list.push_back(text_option(
      "film.layers",
      "Layers of light by path expressions, beside the components: NAME = EXPRESSION, NAME = EXPRESSION. "
      "Words begin with E at the eye, have D, G or S for a diffuse, glossy or specular event, and end with L "
      "at the light: mirrored = ESD.*L, glow = ED[SG]+L."));
  list.push_back(without_restart(boolean_option(
      "overlay.tiles", "false", "Draws active tiles and the ratio of their error to the target.")));
  list.push_back(without_restart(
      boolean_option("overlay.former", "false",
                     "Tints light from before the last edit, where the new light has not replaced it.")));
  list.push_back(without_restart(boolean_option(
      "overlay.lights", "false",
      "Draws light selection at the point under the pointer: arrows to the lights, or parts of the sky, that "
      "are selected most often there, with their shares of the light samples.",
      "Lights of a point")));
  list.push_back(without_restart(
      boolean_option("overlay.light_arrival", "false",
                     "Draws the share of shadow rays towards lights that arrive, from the latest learning.",
                     "Shadow rays that arrive")));
  list.push_back(without_restart(
      boolean_option("overlay.focus", "false",
                     "Tints surfaces that the camera's lens shows sharp, with a line in the plane of focus.",
                     "Depth of field")));
  list.push_back(without_restart(choice_option(
      "overlay.path_color", "event", {"event", "component", "contribution", "word", "time"}, "",
      "Colour of recorded paths (inspect.trace). event: the lobe that scattered each ray, and what it met. "
      "component: that of the light at the end of a ray. contribution: the light that the path adds to its "
      "pixel. word: its way, as EDSL. time: of the path, by the mean time of a ray.",
      "Paths by")));
  list.push_back(without_restart(choice_option(
      "preview.filter", "auto", {"auto", "off"}, "",
      "Preview in the window. auto: filters noise, and keeps the picture from before an edit until the new "
      "light is better. off: shows the unfiltered samples. Statistics and EXR files always use the samples.",
      "Preview")));
  list.push_back(without_restart(text_option("about", "Description of the scene.")));
  for (const char* name : paths::k_component_names) {
    const std::string key = std::string("show.") + name;
    const std::string help = fmt::format("Includes the {} layer in the shown sum.", name);
    list.push_back(without_restart(boolean_option(key.c_str(), "true", help.c_str())));
  }
}

void add_scene_options(std::vector<OptionInfo>& list) {
  list.push_back(text_option(
      "scene.variant",
      "Variant of the materials (KHR_materials_variants); empty: the file's default. lucerna info "
      "lists them."));
  list.push_back(boolean_option("scene.clay", "false",
                                "All surfaces are matt grey, except those that transmit or emit light."));
}

void add_effect_options(std::vector<OptionInfo>& list) {
  list.push_back(text_option(
      "effects.off",
      "Effects that are left out of the scene, separated by commas, such as normal_map, coat: textures give "
      "way to their factors; lobes, lights and absorption are removed. lucerna info --json lists them."));
}

std::vector<OptionInfo> make_options() {
  std::vector<OptionInfo> list;
  for (const int c : k_components) list.push_back(component_option(c));
  add_sampling_options(list);
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const OptionInfo& option : solver->options) list.push_back(of_same_light(option));
  add_scene_options(list);
  add_effect_options(list);
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
