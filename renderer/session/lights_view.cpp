#include "session/lights_view.h"

#include <algorithm>
#include <cmath>

#include "base/figures.h"
#include "shaders/shared/ramp.h"

namespace lucerna::session {

using namespace solvers;

namespace {

constexpr size_t k_rows = 8;  // of the card

Legend arrows_legend() {
  Legend legend{.title = "Lights of the point, by its samples"};
  for (const auto& [share, text] : {std::pair(0.01f, "1 %"), {0.1f, "10 %"}, {1.f, "all"}})
    legend.marks.push_back({.ink = overlay::share_ink(share), .text = text});
  legend.note =
      "Arrow: from the point under the pointer to a light, or a group of lights. Colour: share of the light "
      "samples there.";
  return legend;
}

Legend arrival_legend() {
  return {.title = "Shadow rays that arrive at a light",
          .ramp = shared::k_ramp_viridis,
          .ticks = {{0, "none"}, {0.5f, "half"}, {1, "all"}},
          .note = "Colour: share of the shadow rays that nothing blocks. Grey: not known."};
}

Card card_of(const overlay::ServedPoint& served, const transport::LightLearning& learning,
             const upload::FlatScene& flat, const scene::Scene& scene) {
  Card card;
  const auto add = [&](auto what, Card::Room room = Card::Room::any) { card.lines.push_back({what, room}); };
  add(Card::Title{"Lights of this point", "of its samples"});
  float rest = 1;
  size_t shown = 0;
  for (const overlay::ServingCluster& c : served.clusters) {
    if (shown == k_rows || c.share < overlay::k_least_share) break;
    add(Card::Row{cluster_text(learning.clusters().places[c.cluster], flat, scene), share_text(c.share, 1)},
        shown < k_rows / 2 ? Card::Room::any : Card::Room::much);
    rest -= c.share, ++shown;
  }
  if (shown < served.clusters.size())
    add(Card::Row{fmt::format("{} others", count_text(double(served.clusters.size() - shown))),
                  share_text(std::max(0.f, rest), 1)});
  add(Card::Rule{});
  add(Card::Row{"Shadow rays that arrive", served.arrived < 0 ? "not known" : share_text(served.arrived, 1)});
  if (learning.generations() == 0) add(Card::Note{"Nothing is learned yet: lights are chosen by power."});
  return card;
}

}  // namespace

std::string cluster_text(const upload::ClusterPlace& place, const upload::FlatScene& flat,
                         const scene::Scene& scene) {
  if (place.portal != scene::k_none) {
    const std::string& name = flat.portals.of[place.portal].name;
    return name.empty() ? "sky through a portal" : fmt::format("sky through {}", name);
  }
  if (place.is_sky) {
    const double height = std::asin(std::clamp(place.at.y, -1.f, 1.f)) * 180 / double(k_pi);
    return height < 0 ? fmt::format("sky, {:.0f}\u00b0 below the horizon", -height)
                      : fmt::format("sky, {:.0f}\u00b0 high", height);
  }
  const upload::LightEntry& entry = flat.entries[place.light];
  const bool triangle = entry.kind == shared::k_light_triangle;
  if (triangle) {
    const uint32_t material = flat.triangles[entry.index].w & shared::k_triangle_material_mask;
    const std::string& name = scene.materials[material].name;
    if (place.count == 1) return name.empty() ? "emissive surface" : name;
    return fmt::format("{} triangles{}", count_text(place.count), name.empty() ? "" : ", " + name);
  }
  if (place.count > 1) return fmt::format("{} lamps", count_text(place.count));
  return flat.lamp_name(entry.index);
}

bool LightsView::shown(const plan::Settings& settings) {
  return settings.boolean("overlay.lights") || settings.boolean("overlay.light_arrival");
}

void LightsView::draw(const overlay::Canvas& canvas, const transport::LightLearning* learning,
                      const upload::FlatScene& flat, const shared::Frame& frame, const scene::Scene& scene,
                      const plan::Settings& settings, std::optional<vec2> looked_at) {
  Report report{.solver = "lights", .looked_at = looked_at};
  if (!learning) {
    report.legends.push_back({.title = "No lights are learned here",
                              .note = "Shadow rays are counted with the setting lights.sampling = learned."});
    report_ = std::move(report);
    return;
  }
  if (settings.boolean("overlay.light_arrival")) {
    painter_.draw_arrival(canvas, *learning);
    report.legends.push_back(arrival_legend());
  }
  if (settings.boolean("overlay.lights")) {
    report.legends.push_back(arrows_legend());
    if (looked_at) {
      const auto at = [](float place, uint32_t size) {
        return uint32_t(std::clamp(place * float(size), 0.f, float(size) - 1));
      };
      const auto served = painter_.draw_arrows(canvas, *learning, at(looked_at->x, canvas.width()),
                                               at(looked_at->y, canvas.height()), frame, flat.scene_radius);
      if (served) report.card = card_of(*served, *learning, flat, scene);
    }
  }
  report.figures = {{"clusters", double(learning->clusters().count())},
                    {"rows", double(learning->rows())},
                    {"arrived", learning->arrived()},
                    {"bytes", double(learning->bytes())}};
  report_ = std::move(report);
}

}  // namespace lucerna::session
