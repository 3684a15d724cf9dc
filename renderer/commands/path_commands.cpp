// Commands that record paths: of a pixel, followed one by one, and to explain noise.
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/text.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

constexpr int64_t k_usual_paths = 64, k_most_paths = 4096;

/// The traced paths. Throws Error if there are none.
PathInquiry& traced_paths(Workspace& work) {
  if (!work.traced || !work.traced->paths)
    throw Error("", "no paths are traced; inspect.trace traces those of a pixel");
  return *work.traced;
}

/// The explained noise. Throws Error if there is none.
const recording::NoiseReport& explained_noise(const Workspace& work) {
  if (!work.noise || !work.noise->report)
    throw Error("", "no noise is explained; inspect.noise explains that of the picture");
  return *work.noise->report;
}

void add_trace(Workspace& work) {
  work.registry.add(
      {.name = "inspect.trace",
       .help =
           "Traces the first paths of a pixel again and draws them over the picture: rays, light that "
           "arrives, blocked shadow rays (dark). The picture does not change. inspect.follow follows one of "
           "them. A script continues when they are shown.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"},
                      {.name = "paths",
                       .type = Type::integer,
                       .help = "number of paths, 64 if not given",
                       .lo = 1,
                       .hi = double(k_most_paths),
                       .optional = true}},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const vec2 at(a.number("right"), a.number("down"));
             const auto count = uint32_t(a.has("paths") ? a.integer("paths") : k_usual_paths);
             work.traced =
                 PathInquiry{.at = at, .traced = work.session.trace_paths(at, count, work.open.id())};
           },
       .done = [&work](const Arguments&) { return !work.traced || work.traced->done(); },
       .recorded = false,
       .needs_outcome = true});
  work.registry.add(
      {.name = "inspect.follow",
       .help =
           "Follows one of the traced paths: the others are drawn faintly, and its events are listed in the "
           "log. 1 is the path with the most light; 0 follows none.",
       .parameters = {{.name = "path", .type = Type::integer, .lo = 0, .hi = double(k_most_paths)},
                      {.name = "event",
                       .type = Type::integer,
                       .help = "marked event of the path, from 0, the camera",
                       .lo = 0,
                       .hi = 100000,
                       .optional = true}},
       .run =
           [&work](const Arguments& a) {
             PathInquiry& traced = traced_paths(work);
             const int64_t path = a.integer("path");
             if (path > int64_t(traced.order.size()))
               throw Error("", fmt::format("there is no path {}; {} are traced", path, traced.order.size()));
             const uint32_t index = path > 0 ? traced.order[size_t(path - 1)] : 0;
             const int64_t events = path > 0 ? traced.paths->paths[index].count : 0;
             if (a.has("event") && a.integer("event") >= events)
               throw Error(
                   "", fmt::format("path {} has no event {}; it has {}", path, a.integer("event"), events));
             const bool other = traced.followed != int(path) - 1;
             traced.followed = int(path) - 1;
             traced.vertex = a.has("event") ? int(a.integer("event")) : -1;
             work.session.show_paths(traced.shown(), work.open.id());
             if (path > 0 && other)
               log::info("{}", fmt::join(recording::event_lines(*traced.paths, index), "\n"));
           },
       .recorded = false});
  work.registry.add({.name = "inspect.untrace",
                     .help = "Removes the traced paths from the picture.",
                     .parameters = {},
                     .run =
                         [&work](const Arguments&) {
                           work.traced.reset();
                           work.session.show_paths({});
                         },
                     .recorded = false});
}

void add_noise(Workspace& work) {
  const auto part = [](const char* name, const char* unit) {
    return Parameter{.name = name, .type = Type::real, .lo = 0, .hi = 1, .unit = unit, .optional = true};
  };
  work.registry.add(
      {.name = "inspect.noise",
       .help = "Explains the noise of a rectangle of the picture, by default of all of it: which component, "
               "kind of path, light and material it comes from, and which setting would reduce it. A short "
               "trial of the "
               "picture's paths; the picture does not change. A script continues when it is reported.",
       .parameters = {part("right", "picture widths"), part("down", "picture heights"),
                      part("width", "picture widths"), part("height", "picture heights")},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const auto part = [&](const char* name, float otherwise) {
               return a.has(name) ? a.number(name) : otherwise;
             };
             const vec2 lo(part("right", 0), part("down", 0));
             const vec2 hi = glm::min(lo + vec2(part("width", 1), part("height", 1)), vec2(1));
             work.noise = NoiseInquiry{
                 .lo = lo, .hi = hi, .explained = work.session.explain_noise(lo, hi, work.open.id())};
           },
       .done = [&work](const Arguments&) { return !work.noise || work.noise->done(); },
       .recorded = false,
       .needs_outcome = true});
  work.registry.add({.name = "inspect.cure",
                     .help = "Changes the settings that inspect.noise has found to reduce the noise.",
                     .parameters = {},
                     .run =
                         [&work](const Arguments&) {
                           const recording::NoiseCure& cure = explained_noise(work).cure;
                           if (cure.settings.empty())
                             throw Error("", cure.reason.empty()
                                                 ? "no setting is known that would reduce this noise"
                                                 : cure.reason);
                           for (const auto& [key, value] : cure.settings) work.run(line("set", key, value));
                         },
                     .recorded = false});
}

void add_path_values(Workspace& work) {
  using Words = std::vector<std::string>;
  const auto add = [&work](const char* name, const char* help, std::function<std::string()> read) {
    work.values.add(
        {.name = name, .help = help, .read = [read = std::move(read)](const Words&) { return read(); }});
  };
  add("paths.count", "traced paths (inspect.trace)",
      [&work] { return word(traced_paths(work).order.size()); });
  add("paths.lost", "events of them for which there was no room",
      [&work] { return word(traced_paths(work).paths->lost()); });
  add("paths.light", "their mean luminance", [&work] { return word(traced_paths(work).mean_light); });
  add("paths.followed", "the followed one as text: word, component, light", [&work] {
    const PathInquiry& traced = traced_paths(work);
    if (traced.followed < 0) throw Error("", "no path is followed");
    return recording::path_text(*traced.paths, traced.order[size_t(traced.followed)]);
  });
  const auto report = [&work]() -> const recording::NoiseReport& { return explained_noise(work); };
  add("noise.text", "explanation of the noise (inspect.noise)", [report] { return report().sentence; });
  add("noise.component", "component with the largest share of it",
      [report] { return report().components.empty() ? std::string("none") : report().components[0].name; });
  add("noise.cure", "settings that would reduce it", [report] {
    std::string text;
    for (const auto& [key, value] : report().cure.settings)
      text += (text.empty() ? "" : "; ") + key + " " + value;
    return text.empty() ? std::string("none") : text;
  });
}

}  // namespace

void add_path_commands(Workspace& work) {
  add_trace(work);
  add_noise(work);
  add_path_values(work);
}

}  // namespace lucerna::commands
