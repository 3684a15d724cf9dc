#include "lamp_handles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/light_edit.h"
#include "commands/light_words.h"
#include "commands/workspace.h"
#include "emitters.h"
#include "lamp_outline.h"
#include "mark_layout.h"
#include "scene/projection.h"
#include "surface_snap.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::Kind;
using commands::named;
using commands::Selection;

constexpr float k_reach = 9;   // design pixels from its middle in which a handle is meant
constexpr float k_apart = 19;  // ... between the middles of two marks, so that none covers another

/// Drawn length of a spot's axis that hits nothing, relative to the scene's radius.
constexpr float k_aim_of_extent = 0.25f;
/// Way of a lamp from the surface that it snaps to, likewise.
constexpr float k_gap_of_extent = 0.005f;

LampHandle aim_of(const MarkedScene& marked, uint32_t index, const scene::Light& light) {
  LampHandle aim{.light = index, .part = LampHandle::Part::aim, .point = light.position, .at = {}};
  float far = k_aim_of_extent * marked.camera.view->extent;
  if (const session::Probe* rays = marked.camera.probe())
    if (const auto hit = rays->nearest(light.position, light.direction)) far = hit->distance;
  aim.point += far * light.direction;
  return aim;
}

/// Length of drawn cones and distributions.
float reach_of(const MarkedScene& marked) { return 0.6f * k_aim_of_extent * marked.camera.view->extent; }

/// The outline of a selected lamp.
void draw_outline(ImDrawList* list, const MarkedScene& marked, const Area& shown) {
  const Selection& selection = marked.camera.selection;
  if (selection.kind != Kind::light || selection.index >= marked.open.lights().size() ||
      !marked.camera.view || !marked.open.snapshot)
    return;
  for (const std::vector<vec3>& line : lamp_outline(marked.open.light(selection.index), reach_of(marked)))
    for (size_t i = 0; i + 1 < line.size(); ++i) {
      ImVec2 from, to;
      if (!project(marked.open.snapshot->camera, shown, line[i], from) ||
          !project(marked.open.snapshot->camera, shown, line[i + 1], to))
        continue;
      list->AddLine(from, to, IM_COL32(0, 0, 0, 110), px(3));
      list->AddLine(from, to, colour::accent, std::max(1.0f, px(1)));
    }
}

/// Marks of what is selected stay where they belong; the others make room, or are left out. Surfaces of one
/// material that lie on one another have one mark.
std::vector<LampHandle> without_overlap(const MarkedScene& marked, const Area& shown,
                                        std::vector<LampHandle> list) {
  const auto is_selected = [&](const LampHandle& h) {
    return marked.camera.selection ==
           Selection{h.part == LampHandle::Part::surface ? Kind::material : Kind::light, h.light};
  };
  // The nearest to the eye come first.
  const vec3 eye = commands::eye_of(marked.open.snapshot->camera);
  std::stable_sort(list.begin(), list.end(), [&](const LampHandle& a, const LampHandle& b) {
    return glm::distance(a.point, eye) < glm::distance(b.point, eye);
  });
  std::stable_partition(list.begin(), list.end(), is_selected);
  std::vector<Mark> marks;
  for (const LampHandle& h : list)
    marks.push_back({h.at, h.part == LampHandle::Part::surface ? int64_t{h.light} : -1});
  std::vector<LampHandle> placed;
  for (const PlacedMark& p : place_marks(marks, px(k_apart), shown)) {
    placed.push_back(list[p.mark]);
    placed.back().mark = p.at;
  }
  return placed;
}

}  // namespace

bool project(const scene::Camera& camera, const Area& shown, const vec3& point, ImVec2& at) {
  const std::optional<vec2> place = scene::place_in_picture(camera, point, shown.width() / shown.height());
  if (place) at = {shown.lo.x + place->x * shown.width(), shown.lo.y + place->y * shown.height()};
  return place.has_value();
}

session::PickRay ray_through(const commands::Navigation& camera, const Area& shown, const ImVec2& at) {
  const vec2 place = shown.place_of(at);
  return session::pick_ray(camera.view->camera, place.x, place.y, camera.aspect);
}

std::optional<session::Picked> surface_at(commands::Navigation& camera, const Area& shown, const ImVec2& at,
                                          const std::function<bool(const session::Picked&)>& wanted) {
  const session::Probe* rays = camera.probe();
  const session::PickRay ray = ray_through(camera, shown, at);
  if (!rays || ray.direction == vec3(0)) return std::nullopt;
  return rays->nearest(ray.origin, ray.direction, k_infinity, wanted);
}

DragSnap drag_snap() {
  const ImGuiIO& io = ImGui::GetIO();
  return !io.KeyCtrl ? DragSnap::none : io.KeyShift ? DragSnap::surface : DragSnap::steps;
}

std::vector<LampHandle> lamp_handles(const MarkedScene& marked, const Area& shown) {
  std::vector<LampHandle> list;
  if (!marked.open.scene || !marked.open.snapshot || !marked.camera.view) return list;
  const auto add = [&](LampHandle handle) {
    if (project(marked.open.snapshot->camera, shown, handle.point, handle.at)) list.push_back(handle);
  };
  for (uint32_t i = 0; i < marked.open.lights().size(); ++i) {
    const bool selected = marked.camera.selection == Selection{Kind::light, i};
    const scene::Light light = marked.open.light(i);
    if ((!marked.all && !selected) || light.kind == scene::LightKind::directional) continue;
    if (const auto at = size_handle(light, reach_of(marked), commands::eye_of(marked.open.snapshot->camera));
        selected && at)
      add({.light = i, .part = LampHandle::Part::size, .point = *at, .at = {}});
    if (selected && commands::can_be_aimed(light)) add(aim_of(marked, i, light));
    add({.light = i, .part = LampHandle::Part::place, .point = light.position, .at = {}});
  }
  if (marked.all)
    for (const EmittingSurface& surface : emitting_surfaces(marked.open, marked.camera))
      add({.light = surface.material, .part = LampHandle::Part::surface, .point = surface.middle, .at = {}});
  return without_overlap(marked, shown, std::move(list));
}

std::optional<LampHandle> lamp_handle_at(const MarkedScene& marked, const Area& shown, const ImVec2& at) {
  std::optional<LampHandle> nearest;
  float least = px(k_reach);
  for (const LampHandle& handle : lamp_handles(marked, shown)) {
    const float away = std::hypot(handle.mark.x - at.x, handle.mark.y - at.y);
    if (away <= least) least = away, nearest = handle;
  }
  return nearest;
}

void draw_lamp_handles(const MarkedScene& marked, const Area& shown, const std::optional<LampHandle>& hot) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(shown.lo, shown.hi, true);
  const auto is_hot = [&](const LampHandle& h) {
    return hot && hot->light == h.light && hot->part == h.part;
  };
  const std::vector<LampHandle> handles = lamp_handles(marked, shown);
  draw_outline(list, marked, shown);
  const auto line_to_lamp = [&](const LampHandle& aim) {
    const auto lamp = std::find_if(handles.begin(), handles.end(), [&](const LampHandle& h) {
      return h.light == aim.light && h.part == LampHandle::Part::place;
    });
    ImVec2 end;
    if (lamp != handles.end())
      end = lamp->mark;
    else if (!project(marked.open.snapshot->camera, shown, marked.open.light(aim.light).position, end))
      return;
    list->AddLine(end, aim.mark, IM_COL32(0, 0, 0, 120), px(3));
    list->AddLine(end, aim.mark, colour::accent, std::max(1.0f, px(1)));
  };
  // From a mark that had to make room to where it belongs; below all marks.
  for (const LampHandle& handle : handles) {
    if (handle.mark.x == handle.at.x && handle.mark.y == handle.at.y) continue;
    list->AddLine(handle.mark, handle.at, IM_COL32(0, 0, 0, 120), px(3));
    list->AddLine(handle.mark, handle.at, colour::text_dim, std::max(1.0f, px(1)));
    list->AddCircleFilled(handle.at, px(2), colour::text, 12);
  }
  for (const LampHandle& handle : handles) {
    const bool surface = handle.part == LampHandle::Part::surface;
    const bool chosen =
        marked.camera.selection == Selection{surface ? Kind::material : Kind::light, handle.light};
    const ImU32 ink = chosen || is_hot(handle) ? colour::accent : colour::text;
    const float r = px(is_hot(handle) ? 6.5f : 5);
    if (surface) {
      const auto square = [&](float half, auto&& draw) {
        draw(ImVec2(handle.mark.x - half, handle.mark.y - half),
             ImVec2(handle.mark.x + half, handle.mark.y + half));
      };
      square(r + px(1.5f), [&](auto lo, auto hi) { list->AddRectFilled(lo, hi, IM_COL32(0, 0, 0, 110)); });
      square(r, [&](auto lo, auto hi) { list->AddRect(lo, hi, ink, 0, 0, px(1.5f)); });
      if (marked.open.emits(handle.light))
        square(px(2), [&](auto lo, auto hi) { list->AddRectFilled(lo, hi, ink); });
      continue;
    }
    if (handle.part == LampHandle::Part::size) {
      const float half = 0.8f * r;
      const ImVec2 lo(handle.mark.x - half, handle.mark.y - half),
          hi(handle.mark.x + half, handle.mark.y + half);
      list->AddRectFilled(lo, hi, IM_COL32(0, 0, 0, 160));
      list->AddRect(lo, hi, ink, 0, 0, px(1.5f));
      continue;
    }
    if (handle.part == LampHandle::Part::aim) {
      line_to_lamp(handle);
      list->AddCircleFilled(handle.mark, r, IM_COL32(0, 0, 0, 110), 20);
      list->AddCircle(handle.mark, 0.7f * r, ink, 20, px(1.5f));
      for (const float way : {-1.0f, 1.0f}) {
        list->AddLine({handle.mark.x + way * r, handle.mark.y},
                      {handle.mark.x + 1.8f * way * r, handle.mark.y}, ink, px(1.5f));
        list->AddLine({handle.mark.x, handle.mark.y + way * r},
                      {handle.mark.x, handle.mark.y + 1.8f * way * r}, ink, px(1.5f));
      }
      continue;
    }
    list->AddCircleFilled(handle.mark, r + px(1.5f), IM_COL32(0, 0, 0, 110), 20);
    list->AddCircle(handle.mark, r, ink, 20, px(1.5f));
    if (marked.open.light(handle.light).enabled) list->AddCircleFilled(handle.mark, px(2), ink, 12);
  }
  list->PopClipRect();
}

void drag_lamp(Actions& actions, const MarkedScene& marked, const LampHandle& handle, const Area& shown) {
  if (!marked.open.scene || !marked.camera.view || handle.light >= marked.open.lights().size()) return;
  const ImGuiIO& io = ImGui::GetIO();
  if (handle.part == LampHandle::Part::size) {
    const session::PickRay ray = ray_through(marked.camera, shown, io.MousePos);
    const auto sizes = size_by_ray(marked.open.light(handle.light),
                                   commands::eye_of(marked.camera.view->camera), ray.origin, ray.direction);
    if (sizes.size() == 1) actions.act("light.set", handle.light + 1, named(sizes[0].first, sizes[0].second));
    if (sizes.size() == 2)
      actions.act("light.set", handle.light + 1, named(sizes[0].first, sizes[0].second),
                  named(sizes[1].first, sizes[1].second));
    return;
  }
  if (handle.part == LampHandle::Part::aim) {
    const session::Probe* rays = marked.camera.probe();
    if (!rays) return;
    const session::PickRay ray = ray_through(marked.camera, shown, io.MousePos);
    if (ray.direction == vec3(0)) return;
    const auto hit = rays->nearest(ray.origin, ray.direction);
    const vec3 from = marked.open.light(handle.light).position;
    // Without a surface there, at the previous distance.
    const vec3 to =
        hit ? hit->position : ray.origin + glm::distance(ray.origin, handle.point) * ray.direction;
    if (glm::distance(from, to) > 1e-4f * marked.camera.view->extent)
      actions.act("light.set", handle.light + 1, named("direction", to - from));
    return;
  }
  if (drag_snap() == DragSnap::surface) {
    if (const auto hit = surface_at(marked.camera, shown, io.MousePos))
      actions.act(
          "light.set", handle.light + 1,
          named("position", lamp_on_surface(marked.open.light(handle.light), {hit->position, hit->normal},
                                            k_gap_of_extent * marked.camera.view->extent)));
    return;
  }
  const vec2 pixels(io.MousePos.x - io.MouseClickedPos[0].x, io.MousePos.y - io.MouseClickedPos[0].y);
  actions.act("light.set", handle.light + 1,
              named("position", commands::dragged(marked.camera.view->camera, handle.point, pixels,
                                                  shown.height(), io.KeyShift)));
}

}  // namespace lucerna::ui
