#include "session/paths_view.h"

#include <fmt/format.h>

#include "overlay/path_lines.h"
#include "shaders/shared/ramp.h"

namespace lucerna::session {
namespace {

solvers::Legend legend_of(const recording::Recording& recording, overlay::PathColor color,
                          const overlay::PathStrokes& strokes) {
  solvers::Legend legend{.title = fmt::format("{} recorded paths", recording.paths.size())};
  switch (color) {
    case overlay::PathColor::event:
      legend.marks = {{overlay::lobe_ink(0), "diffuse"},     {overlay::lobe_ink(1), "glossy"},
                      {overlay::lobe_ink(2), "specular"},    {overlay::k_arrived_ink, "light arrives"},
                      {overlay::k_blocked_ink, "blocked"},   {overlay::k_background_ink, "leaves the scene"},
                      {overlay::k_emission_ink, "emission"}, {overlay::k_read_ink, "stored light"}};
      legend.note = "Lines: rays, coloured by the lobe that scattered them; to lights, by what they met.";
      break;
    case overlay::PathColor::component:
      for (const uint32_t c : k_components)
        legend.marks.push_back({overlay::component_ink(c), paths::k_component_names[c]});
      legend.marks.push_back({overlay::k_blocked_ink, "blocked"});
      legend.note = "Colour: component of the brightest light that a ray leads to.";
      break;
    case overlay::PathColor::contribution:
      legend.ramp = shared::k_ramp_viridis;
      legend.ticks = {{0, "0.1 %"}, {1.f / 3, "1 %"}, {2.f / 3, "10 %"}, {1, "brightest"}};
      legend.note = "Colour: light of the path, over that of the brightest.";
      break;
    case overlay::PathColor::word:
      for (size_t w = 0; w < strokes.words.size(); ++w)
        legend.marks.push_back({overlay::word_ink(w), strokes.words[w]});
      legend.marks.push_back({overlay::word_ink(SIZE_MAX), "others, or no light"});
      legend.note = "Colour: way of the brightest light that a ray leads to, from the eye E to the light L.";
      break;
    case overlay::PathColor::time:
      legend.ramp = shared::k_ramp_viridis;
      legend.ticks = {{0, "0"},
                      {0.5f, fmt::format("{:.3g}", 0.5 * strokes.slowest)},
                      {1, fmt::format("{:.3g} \xC2\xB5s", strokes.slowest)}};
      legend.note = "Colour: time of the path, by the mean time of a ray in this picture.";
      break;
  }
  if (const uint64_t lost = recording.lost())
    legend.note += fmt::format(" {} events had no room: their light is missing.", lost);
  return legend;
}

}  // namespace

void PathsView::draw(const overlay::Canvas& canvas, const ShownPaths& shown, const plan::Settings& settings,
                     float radius) {
  const auto color = overlay::PathColor(settings.choice("overlay.path_color"));
  const overlay::PathStrokes strokes = overlay::path_strokes(
      *shown.of, {.color = color, .path = shown.path, .vertex = shown.vertex, .slack = 1e-3f * radius});
  painter_.draw(canvas, strokes.points, strokes.segments, {}, {.dimmed = true});
  solvers::Report report{.solver = "paths"};
  report.legends.push_back(legend_of(*shown.of, color, strokes));
  report.figures = {{"paths", double(shown.of->paths.size())},
                    {"events", double(shown.of->events.size())},
                    {"lost", double(shown.of->lost())},
                    {"segments", double(strokes.segments.size())}};
  report_ = std::move(report);
}

}  // namespace lucerna::session
