// Commands that hold results and compare them with the live picture.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/text.h"
#include "commands/workspace.h"

namespace lucerna::commands {

namespace {

constexpr double k_most_times = 1000;

Parameter held_name(Workspace& work, bool optional = false) {
  return {
      .name = "name",
      .help = "of a held result",
      .optional = optional,
      .names = [&work](const std::vector<std::string>&) { return given_names(work.compare.results.list()); }};
}

Parameter new_name() {
  return {.name = "name", .help = "by default its methods, or the file's name", .optional = true};
}

/// Name of the scene's camera that shows the present view; "": none does.
std::string camera_name(const Workspace& work) {
  const int camera = work.camera.scene_camera;
  if (!work.open.scene || camera < 0 || camera >= int(work.open.scene->cameras.size())) return "";
  return work.open.scene->cameras[size_t(camera)].name;
}

void needs_no_holding(const Workspace& work) {
  if (work.compare.holding) throw Error("", "another picture is being held; try again in a moment");
}

void add_holding(Workspace& work) {
  HeldResults& results = work.compare.results;
  work.registry.add(
      {.name = "compare.hold",
       .help =
           "Holds the shown picture as light, to compare later pictures with it: other methods, settings "
           "or lights. It follows exposure and tone curve. At most 8 are held. A script continues when it "
           "is held.",
       .parameters = {new_name()},
       .run =
           [&work, &results](const Arguments& a) {
             work.open.needs_scene();
             const std::string name = a.has("name") ? a.text("name") : "";
             results.needs_room(name);
             needs_no_holding(work);
             const std::string& layer = work.open.setting("film.layer");
             const auto& components = session::k_component_names;
             if (layer != "beauty" &&
                 std::find(components.begin(), components.end(), layer) == components.end())
               throw Error("",
                           fmt::format("the layer '{}' shows no light; choose beauty or a component", layer));
             work.history.record_wait();
             work.compare.holding =
                 Comparing::Holding{work.session.held_picture(work.open.id()), name, camera_name(work)};
           },
       .done = [&work](const Arguments&) { return !work.compare.holding; },
       .needs_outcome = true});
  work.registry.add(
      {.name = "compare.load",
       .help = "Holds the picture of a file, such as a reference, to compare the picture with it. It must "
               "have the picture's size. Methods, time and error are those that an EXR of this program "
               "stores. An 8-bit picture (PNG) is compared with the picture as it is shown. A script "
               "continues when it is held.",
       .parameters = {file_named({".exr", ".png", ".hdr"}), new_name()},
       .run =
           [&work, &results](const Arguments& a) {
             const std::string& file = a.text("file");
             const std::string name = a.has("name") ? a.text("name") : "";
             results.needs_room(name);
             needs_no_holding(work);
             std::error_code code;
             if (!std::filesystem::exists(file, code)) throw Error(file, "there is no such file");
             work.compare.read(file, name);
           },
       .done = [&work](const Arguments&) { return !work.compare.holding; },
       .needs_outcome = true});
  work.registry.add({.name = "compare.cancel",
                     .help = "Ends the reading of a file by compare.load.",
                     .parameters = {},
                     .run =
                         [&work](const Arguments&) {
                           if (!work.compare.cancel()) throw Error("", "no file is being read");
                         },
                     .recorded = false});
  work.registry.add({.name = "compare.forget",
                     .help = "Forgets a held result, or all without a name.",
                     .parameters = {held_name(work, true)},
                     .run =
                         [&results](const Arguments& a) {
                           if (a.has("name"))
                             results.forget(a.text("name"));
                           else
                             results.forget_all();
                         },
                     .needs_outcome = true});
  work.registry.add({.name = "compare.rename",
                     .help = "Renames a held result.",
                     .parameters = {held_name(work), {.name = "to"}},
                     .run = [&results](const Arguments& a) { results.rename(a.text("name"), a.text("to")); },
                     .needs_outcome = true});
}

void add_views(Workspace& work) {
  HeldResults& results = work.compare.results;
  Parameter which = held_name(work);
  which.help = "of a held result; \"\": none";
  work.registry.add({.name = "compare.with",
                     .help = "Chooses the held result that the live picture is compared with.",
                     .parameters = {which},
                     .run = [&results](const Arguments& a) { results.compare_with(a.text("name")); },
                     .needs_outcome = true});
  work.registry.add(
      {.name = "compare.view",
       .help =
           "Shows the comparison in place of the picture. wipe: the held result to the left of a line, the "
           "live picture to the right; flip: the held result; difference: the live picture minus the held "
           "result, in luminance.",
       .parameters = {{.name = "view", .type = Type::choice, .choices = k_compare_views}},
       .run =
           [&results](const Arguments& a) {
             const auto at = std::find(k_compare_views.begin(), k_compare_views.end(), a.text("view"));
             results.set_view(static_cast<CompareView>(at - k_compare_views.begin()));
           },
       .needs_outcome = true});
  work.registry.add({.name = "compare.at",
                     .help = "Places the line of the wipe.",
                     .parameters = {{.name = "place",
                                     .type = Type::real,
                                     .help = "from the left",
                                     .lo = 0,
                                     .hi = 1,
                                     .unit = "picture widths"}},
                     .run = [&results](const Arguments& a) { results.wipe_at = a.number("place"); }});
  work.registry.add(
      {.name = "compare.times",
       .help = "Sets the factor of the difference. At 1, the full colours stand for the luminance that the "
               "exposure shows as white.",
       .parameters = {{.name = "factor", .type = Type::real, .lo = 0.01, .hi = k_most_times}},
       .run = [&results](const Arguments& a) { results.difference_times = a.number("factor"); }});
  work.registry.add(
      {.name = "compare.measure",
       .help = "Measures the present picture against the held result: relative squared error, error as "
               "seen, FLIP. They are also measured by themselves at each doubling of the samples. A "
               "script continues when they are known.",
       .parameters = {},
       .run =
           [&work, &results](const Arguments&) {
             const HeldResult* held = results.compared();
             if (!held) throw Error("", "no held result is chosen; compare.with NAME chooses one");
             work.open.needs_scene();
             if (work.open.snapshot)
               if (const std::string why =
                       why_not_comparable(*held, *work.open.snapshot, work.open.scene->name);
                   !why.empty())
                 throw Error("", why);
             work.compare.live.restart();
           },
       .done =
           [&work](const Arguments&) {
             const LiveDifference& live = work.compare.live;
             if (!live.problem().empty()) throw Error("", live.problem());
             return live.figures().has_value() || !work.compare.results.compared();
           },
       .recorded = false,
       .needs_outcome = true});
}

using HeldPart = std::pair<const char*, std::string (*)(const HeldResult&)>;
const HeldPart k_held_parts[] = {
    {"methods", [](const HeldResult& h) { return session::methods_text(h.picture->methods); }},
    {"samples", [](const HeldResult& h) { return word(h.picture->samples); }},
    {"seconds", [](const HeldResult& h) { return word(h.picture->seconds); }},
    {"error", [](const HeldResult& h) { return h.picture->error ? word(*h.picture->error) : "unknown"; }},
    {"filtered", [](const HeldResult& h) { return word(h.picture->filtered); }},
    {"shows", [](const HeldResult& h) { return h.picture->shows.empty() ? "all light" : h.picture->shows; }},
    {"camera", [](const HeldResult& h) { return h.camera; }},
    {"width", [](const HeldResult& h) { return word(h.picture->width); }},
    {"height", [](const HeldResult& h) { return word(h.picture->height); }},
};

std::vector<std::string> held_part_names() {
  std::vector<std::string> names;
  for (const HeldPart& part : k_held_parts) names.emplace_back(part.first);
  return names;
}

void add_compare_values(Workspace& work) {
  using Words = std::vector<std::string>;
  const HeldResults& results = work.compare.results;
  const auto add = [&work](const char* name, const char* help, std::function<std::string()> read) {
    work.values.add(
        {.name = name, .help = help, .read = [read = std::move(read)](const Words&) { return read(); }});
  };
  add("compare.held", "number of held results", [&results] { return word(results.list().size()); });
  add("compare.with", "name of the one that is compared with the picture; \"\" if none",
      [&results] { return results.compared() ? results.compared()->name : std::string(); });
  add("compare.view", "off, wipe, flip or difference",
      [&results] { return k_compare_views[static_cast<size_t>(results.view())]; });
  add("compare.at", "place of the wipe's line, 0..1", [&results] { return word(results.wipe_at); });
  add("compare.times", "factor of the difference", [&results] { return word(results.difference_times); });
  add("compare.problem", "why the picture cannot be compared; \"\" if it can",
      [&work] { return work.compare.live.problem(); });
  const auto figure = [&](const char* name, const char* help, double film::LightDifference::*value) {
    add(name, help, [&work, value] {
      const auto& figures = work.compare.live.figures();
      if (!figures) throw Error("", "not measured yet; compare.measure measures it");
      const double known = (*figures).*value;
      if (std::isnan(known))
        throw Error("", "the held result is a picture in display colours; only compare.flip is known");
      return word(known);
    });
  };
  figure("compare.squared_error", "relative squared error of the picture against the held result",
         &film::LightDifference::relative_squared);
  figure("compare.seen_error", "error as seen of the picture against it; 0.05 is 5 %",
         &film::LightDifference::as_seen);
  figure("compare.flip", "mean FLIP of the picture against it, as both are shown, 0..1",
         &film::LightDifference::flip);
  work.values.add({.name = "held",
                   .help = fmt::format("of a held result: {}", fmt::join(held_part_names(), ", ")),
                   .words = {"NAME", "PART"},
                   .names =
                       [&results](const Words& before) {
                         return before.empty() ? given_names(results.list()) : held_part_names();
                       },
                   .read = [&results](const Words& w) -> std::string {
                     const HeldResult& held = results.named(w[0]);
                     for (const auto& [name, read] : k_held_parts)
                       if (w[1] == name) return read(held);
                     throw Error("", fmt::format("there is no part '{}'{}; expected one of {}", w[1],
                                                 suggestion(w[1], held_part_names()),
                                                 fmt::join(held_part_names(), ", ")));
                   }});
}

}  // namespace

void add_compare_commands(Workspace& work) {
  add_holding(work);
  add_views(work);
  add_compare_values(work);
}

}  // namespace lucerna::commands
