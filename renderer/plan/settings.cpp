#include "plan/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "plan/solvers.h"

namespace lucerna::plan {
namespace {

OptionInfo component(const char* name, const char* what) {
  const int c = int(std::find(std::begin(paths::k_component_names), std::end(paths::k_component_names),
                              std::string_view(name)) -
                    std::begin(paths::k_component_names));
  std::vector<std::string> choices;
  for (const SolverInfo& solver : solvers())
    if (solver.serves[c]) choices.push_back(solver.name);
  const std::string fallback = choices.front();
  choices.push_back("off");
  return {.key = std::string("components.") + name,
          .type = OptionType::choice,
          .fallback = fallback,
          .choices = std::move(choices),
          .help = fmt::format("Solver of the {} component: {}.", name, what)};
}

OptionInfo integer(const char* key, int64_t fallback, double lo, double hi, const char* unit,
                   const char* help) {
  return {.key = key,
          .type = OptionType::integer,
          .fallback = std::to_string(fallback),
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .choices = {},
          .help = help};
}

OptionInfo real(const char* key, const char* fallback, double lo, double hi, const char* unit,
                const char* help) {
  return {.key = key,
          .type = OptionType::real,
          .fallback = fallback,
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .choices = {},
          .help = help};
}

OptionInfo boolean(const char* key, const char* help, const char* fallback = "false") {
  return {.key = key, .type = OptionType::boolean, .fallback = fallback, .choices = {}, .help = help};
}

/// A change lets the image go on.
OptionInfo going_on(OptionInfo option) {
  option.restarts = false;
  return option;
}

std::vector<OptionInfo> make_options() {
  std::vector<OptionInfo> list{
      component("primary", "emitters and direct light, also seen in mirrors and through glass"),
      component("secondary", "one diffuse interreflection"),
      component("tertiary", "deeper interreflection, and caustics seen in it"),
      component("caustic", "light focused on diffuse surfaces by mirrors and glass"),
      integer("samples", 256, 1, 1 << 20, "samples",
              "Samples a pixel at which the image is finished, where sampling.mode is uniform."),
      going_on({.key = "sampling.mode",
                .type = OptionType::choice,
                .fallback = "uniform",
                .choices = {"uniform", "adaptive"},
                .help = "Samples for all pixels alike, or for the tiles whose noise is not yet under the "
                        "target. A change keeps the samples there are."}),
      going_on(real("sampling.target_error", "0.05", 0.0001, 10, "",
                    "Adaptive: relative standard error of its pixels under which a tile is done.")),
      going_on(integer("sampling.min_samples", 64, 2, 1 << 20, "samples",
                       "Adaptive: samples that every pixel gets before its tile may be done.")),
      going_on(integer("sampling.max_samples", 1024, 2, 1 << 20, "samples",
                       "Adaptive: samples a pixel after which a tile is given up, and reported.")),
      {.key = "sampling.tile",
       .type = OptionType::choice,
       .fallback = "16",
       .unit = "pixels",
       .choices = {"8", "16"},
       .help = "Side of the tiles that adaptive sampling decides on, and that coherent sampling shares."},
      boolean(
          "sampling.coherent",
          "The pixels of a tile share their random sequence: neighbouring paths stay together, which some "
          "devices trace faster; noise then has a pattern, and a tile's error is not vouched for."),
      integer("seed", 0, 0, 4294967295.0, "",
              "Seed of every random decision; the same seed gives the same image."),
      integer("path.max_depth", 64, 1, 1024, "vertices", "Scattering events after which a path ends."),
      integer("path.roulette_depth", 4, 1, 1024, "vertices",
              "Vertex from which Russian roulette may end a path."),
      integer(
          "path.batch", 131072, 1024, 4194304, "paths",
          "Paths in flight at once; sets the memory of the path state. Never fewer than 4096 where light is "
          "cached."),
      {.key = "cache.metric",
       .type = OptionType::choice,
       .fallback = "hessian",
       .choices = {"split-sphere", "hessian"},
       .help = "Irradiance cache: what decides how far a record serves. hessian: how its light bends from "
               "place to place, with ellipses that are longer where it bends less; split-sphere: how far "
               "things are that it sees, in whatever light."},
      real("cache.error", "0.3", 0.01, 1, "",
           "Irradiance cache: how far records serve: radii are in proportion to it, by either metric. "
           "Smaller: more records, less error. split-sphere: radius over the harmonic mean distance of what "
           "a record sees."),
      real("cache.nearest", "1", 0.1, 1, "of the distance",
           "Irradiance cache: greatest radius of a record over the distance of the nearest thing that it or "
           "a record that it reaches sees. Less: more records, and less error, where narrow things stand "
           "before a surface."),
      real("cache.min_radius", "3", 0, 100, "pixels",
           "Irradiance cache: least radius of a record, as the camera sees it."),
      real("cache.max_radius", "0.1", 0.001, 1, "of the scene's radius",
           "Irradiance cache: greatest radius of a record."),
      boolean("cache.gather",
              "Irradiance cache: where something is nearer than twice the least radius, along edges, records "
              "only "
              "tell where light comes from. Paths gather it from there and end in records one vertex later: "
              "grain that more samples take away, instead of specks that stay.",
              "true"),
      boolean("cache.neighbours",
              "Irradiance cache: records reach no farther than the nearest others in different directions: "
              "fewer serve a point, which is faster and closer to the light there."),
      real("cache.thinning", "0.6", 0, 1, "of the radius",
           "Irradiance cache: within that a record makes others superfluous that are tried with it. Less: "
           "more "
           "records, and more of them serve a point; 0: all that are tried are kept."),
      {.key = "cache.rays",
       .type = OptionType::choice,
       .fallback = "256",
       .unit = "rays",
       .choices = {"64", "256", "1024", "4096"},
       .help = "Irradiance cache: rays from a record over its hemisphere, at first."},
      {.key = "cache.max_rays",
       .type = OptionType::choice,
       .fallback = "65536",
       .unit = "rays",
       .choices = {"64", "256", "1024", "4096", "16384", "65536"},
       .help = "Irradiance cache: rays of the last level that a noisy record gets, each four times the one "
               "before."},
      real("cache.noise", "0.03", 0, 10, "",
           "Irradiance cache: relative standard error above which a record with a radius of 3 % of the "
           "picture's height gets more rays than the first level. Those that more of the picture reads get "
           "more of them, others fewer, for what they are worth to it."),
      boolean("cache.environment",
              "Irradiance cache: records also hold the light straight from the sky, so that surfaces that it "
              "lights need no noisy shadow rays to it. Where secondary light is cached, only while primary "
              "light is on."),
      real("cache.environment_threshold", "16", 2, 1000000, "x mean",
           "Irradiance cache: texels of the environment brighter than so many times its mean radiance are no "
           "sky but a sun, and are sampled directly everywhere."),
      integer(
          "cache.max_records", 300000, 16, 400000, "records",
          "Irradiance cache: room for records, of 592 bytes each and 1.9 kB with the tree that finds them; "
          "building ends when it is used up."),
      integer("cache.passes", 12, 1, 64, "passes", "Irradiance cache: passes of building at most."),
      real("cache.stop", "0.002", 0, 1, "",
           "Irradiance cache: building ends when no greater share of the paths still asks for records; "
           "these are "
           "path traced."),
      real("cache.candidates", "1", 0, 16, "a cell",
           "Irradiance cache: candidates for records, on every scale, in a cell of the picture in which "
           "geometry or irradiance changes fully; few fall on smooth walls. 0: every pixel that no record "
           "serves asks."),
      real("cache.candidates_falloff", "0.25", 0, 1, "a level",
           "Irradiance cache: of a pixel's probability to be a candidate, from each scale to the next, twice "
           "as wide. 0.25: as many candidates a cell on all; less: denser about edges, sparser elsewhere."),
      real("cache.depth_weight", "3", 0, 1000, "",
           "Irradiance cache: how much a step between neighbouring surfaces counts as detail, for its height "
           "in cells; 3: a third of a cell counts fully."),
      real("cache.normal_weight", "3", 0, 1000, "",
           "Irradiance cache: how much a turn of the surface counts as detail, a radian; 3: 20 degrees count "
           "fully."),
      real("cache.irradiance_weight", "1", 0, 1000, "",
           "Irradiance cache: how much a relative difference of irradiance between neighbouring cells counts "
           "as detail in later passes; 0: not at all."),
      {.key = "cache.pause",
       .type = OptionType::choice,
       .fallback = "off",
       .choices = {"off", "pass", "stage"},
       .help = "Irradiance cache: building waits after every pass, or every stage of it, for cache.step or "
               "cache.run. In the window and its scripts alone: batch rendering goes on.",
       .restarts = false},
      {.key = "tracer",
       .type = OptionType::choice,
       .fallback = "auto",
       .choices = {"auto", "compute-bvh", "host"},
       .help = "Who traces rays: auto takes host (Embree) on CPU devices and compute-bvh elsewhere."},
      {.key = "camera",
       .type = OptionType::text,
       .fallback = "",
       .choices = {},
       .help = "Name of the scene camera to start with."},
      going_on(
          real("film.ev", "0", -20, 20, "EV", "Exposure: the picture is multiplied by 2 to this power.")),
      {.key = "film.tone_curve",
       .type = OptionType::choice,
       .fallback = "neutral",
       .choices = {"neutral", "agx", "linear"},
       .help = "Tone curve of what is shown and of PNG files.",
       .restarts = false},
      {.key = "film.layer",
       .type = OptionType::choice,
       .fallback = "beauty",
       .choices = {"beauty", "primary", "secondary", "tertiary", "caustic", "albedo", "normal", "depth",
                   "samples", "error", "cost"},
       .help = "Layer shown and written to PNG files.",
       .restarts = false},
      going_on(boolean(
          "overlay.tiles",
          "Shows over the picture which tiles are at work and how far their error is from the target.")),
      going_on(boolean("overlay.records",
                       "Shows over the picture the irradiance cache's records as discs of their validity.")),
      {.key = "overlay.records_by",
       .type = OptionType::choice,
       .fallback = "pass",
       .choices = {"pass", "origin", "rays", "distance", "error"},
       .help = "What records are coloured by: the pass that placed them, what asked for them, their rays, "
               "the harmonic "
               "mean of the distances that they see, their error.",
       .restarts = false},
      going_on(boolean("overlay.normals",
                       "Shows over the picture the normals of the irradiance cache's "
                       "records, as short lines from their centres.")),
      {.key = "overlay.placement",
       .type = OptionType::choice,
       .fallback = "off",
       .choices = {"off", "stage", "candidates", "clusters", "chosen"},
       .help = "Shows over the picture how the last pass of building chose the places of the irradiance "
               "cache's records: the candidates that asked, their clusters with what is tried, or what of "
               "that is chosen; stage: as far as building has come.",
       .restarts = false},
      going_on(boolean("overlay.overlap", "Shows over the picture how many records serve each pixel.")),
      {.key = "overlay.discontinuity",
       .type = OptionType::choice,
       .fallback = "off",
       .choices = {"off", "geometry", "irradiance"},
       .help = "Shows over the picture how much geometry, or the irradiance that the present records give, "
               "changes there: by this the irradiance cache picks candidates in the picture.",
       .restarts = false},
      going_on(integer("overlay.discontinuity_level", 0, 0, 12, "",
                       "Level of the discontinuity's pyramid that is shown: its cells are 2 to that power "
                       "pixels wide.")),
      {.key = "about",
       .type = OptionType::text,
       .fallback = "",
       .choices = {},
       .help = "What the scene is for.",
       .restarts = false},
  };
  for (const char* name : {"primary", "secondary", "tertiary", "caustic"}) {
    list.push_back({.key = std::string("show.") + name,
                    .type = OptionType::boolean,
                    .fallback = "true",
                    .choices = {},
                    .help = fmt::format("Whether the shown sum holds the {} layer.", name),
                    .restarts = false});
  }
  return list;
}

bool parse_number(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value);
}

std::string list_choices(const std::vector<std::string>& choices) {
  return fmt::format("{}", fmt::join(choices, ", "));
}

}  // namespace

const std::vector<OptionInfo>& options() {
  static const std::vector<OptionInfo> list = make_options();
  return list;
}

std::string describe_values(const OptionInfo& o) {
  switch (o.type) {
    case OptionType::choice:
      return fmt::format("{}", fmt::join(o.choices, "|"));
    case OptionType::boolean:
      return "true|false";
    case OptionType::text:
      return "";
    default:
      return fmt::format("{} to {}{}{}", o.lo, o.hi, o.unit.empty() ? "" : " ", o.unit);
  }
}

std::pair<std::string, std::string> split_change(const std::string& change, const std::string& where) {
  const size_t at = change.find('=');
  if (at == std::string::npos) throw_error(where, "'{}': expected key=value", change);
  return {change.substr(0, at), change.substr(at + 1)};
}

const OptionInfo* find_option(const std::string& key) {
  for (const OptionInfo& option : options())
    if (option.key == key) return &option;
  return nullptr;
}

Settings::Settings() {
  for (const OptionInfo& option : options()) values_[option.key] = option.fallback;
}

void Settings::set(const std::string& key, const std::string& value, const std::string& where) {
  const OptionInfo* option = find_option(key);
  if (!option) {
    std::vector<std::string> keys;
    for (const OptionInfo& known : options()) keys.push_back(known.key);
    throw_error(where, "unknown setting '{}'; known are {}", key, list_choices(keys));
  }
  double number = 0;
  switch (option->type) {
    case OptionType::choice:
      if (std::find(option->choices.begin(), option->choices.end(), value) == option->choices.end())
        throw_error(where, "{} = '{}': expected one of {}", key, value, list_choices(option->choices));
      break;
    case OptionType::boolean:
      if (value != "true" && value != "false")
        throw_error(where, "{} = '{}': expected true or false", key, value);
      break;
    case OptionType::integer:
    case OptionType::real:
      if (!parse_number(value, number) || number < option->lo || number > option->hi ||
          (option->type == OptionType::integer && number != std::floor(number)))
        throw_error(where, "{} = '{}': expected {} from {} to {}{}{}", key, value,
                    option->type == OptionType::integer ? "a whole number" : "a number", option->lo,
                    option->hi, option->unit.empty() ? "" : " ", option->unit);
      break;
    case OptionType::text:
      break;
  }
  values_[key] = value;
}

const std::string& Settings::text(const std::string& key) const { return values_.at(key); }

double Settings::real(const std::string& key) const {
  double number = 0;
  parse_number(values_.at(key), number);
  return number;
}

int64_t Settings::integer(const std::string& key) const { return static_cast<int64_t>(real(key)); }
bool Settings::boolean(const std::string& key) const { return values_.at(key) == "true"; }

int Settings::choice(const std::string& key) const {
  const auto& choices = find_option(key)->choices;
  return static_cast<int>(std::find(choices.begin(), choices.end(), values_.at(key)) - choices.begin());
}

std::string Settings::changed_json() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const OptionInfo& option : options())
    if (values_.at(option.key) != option.fallback) json[option.key] = values_.at(option.key);
  return json.dump();
}

}  // namespace lucerna::plan
