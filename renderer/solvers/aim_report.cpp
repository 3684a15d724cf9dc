#include "solvers/aim_report.h"

#include <algorithm>

#include "base/figures.h"

namespace lucerna::solvers {

namespace {

Table aim_table(const AimedAt& at, std::span<const overlay::AimedPair> pairs) {
  constexpr size_t k_rows = 6;
  Table table{.columns = {"", "aimed from", "at", "share"}, .droppable = std::nullopt, .rows = {}};
  for (size_t i = 0; i < std::min(pairs.size(), k_rows); ++i) {
    const uint32_t box = pairs[i].box;
    const std::string name = box < at.casters ? fmt::format("caster {}", box + 1)
                                              : fmt::format("entrance {}", box - at.casters + 1);
    table.rows.push_back({.cells = {"", pairs[i].light, name, share_text(pairs[i].share, 1)},
                          .bar = float(pairs[i].share / std::max(1e-9, pairs[0].share)),
                          .ink = overlay::aim_ink(pairs[i].share),
                          .help = "Share of all light paths aimed from this light at this cluster of "
                                  "specular surfaces, or at this entrance of distant light."});
  }
  return table;
}

}  // namespace

void add_aim_rows(std::vector<PanelItem>& items, const AimedAt& at, double unaimed,
                  std::span<const overlay::AimedPair> pairs) {
  if (at.casters + at.entrances == 0) return;
  if (at.casters > 0)
    items.push_back(ValueRow{"Casters", count_text(double(at.casters)),
                             "Clusters of specular surfaces at which light paths are aimed."});
  if (at.entrances > 0)
    items.push_back(ValueRow{"Entrances", count_text(double(at.entrances)),
                             "First surfaces that useful light of sun and sky reaches, found by a pilot; "
                             "light paths are aimed there."});
  items.push_back(
      ValueRow{"Aimed", share_text(1 - unaimed, 1),
               "Share of the light paths aimed at these, chosen by the contributions in a pilot."});
  if (!pairs.empty()) items.push_back(aim_table(at, pairs));
}

Legend aim_legend() {
  Legend legend{.title = "Share of the light paths aimed there",
                .ramp = std::nullopt,
                .ticks = {},
                .range = {},
                .marks = {}};
  for (const double share : {0.001, 0.01, 0.1, 1.0})
    legend.marks.push_back({overlay::aim_ink(share), share_text(share, 1)});
  legend.note = "Box: what light paths are aimed at. Line: from lights to their box.";
  return legend;
}

Legend light_paths_legend() {
  return {.title = "Light paths",
          .note = "Line: a path from a light, in the colour of its light; faint up to the first surface."};
}

}  // namespace lucerna::solvers
