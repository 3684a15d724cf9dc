// Commands that inspect solver data at a place of the picture.
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/future.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/pixel_report.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void PixelInquiry::follow(const OpenScene& open, const Navigation& camera) {
  if (!lines.empty() || !is_ready(layers)) return;
  try {
    report = report_pixel(layers.get(), at);
    if (open.scene && camera.view)
      surface = surface_lines(*open.scene, camera.view->camera, at, camera.aspect);
    lines = to_lines(report);
    lines.insert(lines.end(), surface.begin(), surface.end());
  } catch (const std::exception& error) {
    lines = {error.what()};
  }
  layers = {};
  log::info("{}", fmt::join(lines, "\n"));
}

void add_inspect_commands(Workspace& work) {
  const auto place = [](const Arguments& a) { return vec2(a.number("right"), a.number("down")); };
  work.registry.add(
      {.name = "inspect.at",
       .help = "Inspects the solvers' data at a point of the picture: the records or photons used there and "
               "their "
               "weights; with overlay.lights the lights that are selected there. A script continues when it "
               "is shown.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [&work, place](const Arguments& a) {
             ++work.inspections;
             work.open.needs_lookup();
             work.session.inspect(place(a), work.open.id());
           },
       .done =
           [&work, place](const Arguments& a) {
             const session::Snapshot* snapshot = work.open.snapshot.get();
             return snapshot &&
                    std::any_of(snapshot->reports.begin(), snapshot->reports.end(),
                                [&](const auto& report) { return report->looked_at == place(a); });
           },
       .recorded = false});
  work.registry.add(
      {.name = "inspect.pixel",
       .help =
           "Reports a pixel of the picture in the log: the value of each layer with its noise, and the "
           "surface: object, material, triangle, texture coordinates, place. A script continues when it is "
           "reported.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [&work, place](const Arguments& a) {
             work.open.needs_scene();
             work.camera.needs_view();
             work.pixel = PixelInquiry{place(a), work.session.layers(work.open.id()), {}};
           },
       .done = [&work](const Arguments&) { return !work.pixel || !work.pixel->lines.empty(); },
       .recorded = false,
       .needs_outcome = true});
  work.registry.add({.name = "inspect.none",
                     .help = "Ends the inspection of places and pixels.",
                     .parameters = {},
                     .run =
                         [&work](const Arguments&) {
                           work.session.inspect(std::nullopt);
                           work.pixel.reset();
                         },
                     .recorded = false});
}

}  // namespace lucerna::commands
