#include "object_handles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "commands/camera_control.h"
#include "commands/workspace.h"
#include "surface_snap.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::Kind;
using commands::named;

constexpr float k_arm = 92, k_ring = 84;  // design pixels
constexpr float k_square = 0.3f;          // middle of a square between two axes, in arms
constexpr float k_half_square = 0.075f;   // its half side
constexpr float k_grip = 8;               // design pixels around a handle that belong to it
constexpr int k_pieces = 16;              // of an edge, each visible or not
constexpr int k_ring_points = 64;
constexpr ImU32 k_axis_inks[] = {IM_COL32(226, 98, 92, 255), IM_COL32(132, 190, 96, 255),
                                 IM_COL32(96, 150, 232, 255)};
constexpr ImU32 k_shade = IM_COL32(0, 0, 0, 130);

std::optional<uint32_t> selected_object(const MarkedScene& marked) {
  const commands::Selection& s = marked.camera.selection;
  const bool there = s.kind == Kind::instance && marked.open.scene && marked.open.loaded &&
                     marked.open.snapshot && marked.camera.view &&
                     s.index < marked.open.loaded->instances.size();
  return there ? std::optional(s.index) : std::nullopt;
}

/// Metres at that point that have the size of so many design pixels.
float metres_of(const scene::Camera& camera, const Area& shown, const vec3& point, float pixels) {
  const vec3 away = point - commands::eye_of(camera);
  const float depth = camera.perspective() ? glm::dot(away, commands::forward_of(camera)) : glm::length(away);
  const float half = commands::half_height_at(camera, std::max(depth, 1e-4f));
  return 2 * half * px(pixels) / std::max(1.0f, shown.height());
}

Gizmo gizmo_of(const MarkedScene& marked, GizmoMode mode, const Area& shown, uint32_t object,
               const mat4& to_world) {
  const scene::Camera& camera = marked.open.snapshot->camera;
  const Box& box = marked.open.object_box(object);
  const vec3 middle = scene::middle_of(box, to_world);
  return make_gizmo(mode, box, to_world, camera,
                    metres_of(camera, shown, middle, mode == GizmoMode::turn ? k_ring : k_arm));
}

vec3 ring_point(const Gizmo& g, int axis, int i) {
  const float angle = 2 * k_pi * float(i) / k_ring_points;
  return g.middle +
         g.reach * (std::cos(angle) * g.axes[(axis + 1) % 3] + std::sin(angle) * g.axes[(axis + 2) % 3]);
}

/// Corners of the square between the two other axes.
std::array<vec3, 4> square_corners(const Gizmo& g, int axis) {
  const vec3 u = g.reach * g.axes[(axis + 1) % 3], v = g.reach * g.axes[(axis + 2) % 3];
  const vec3 at = g.middle + k_square * (u + v);
  const float h = k_half_square;
  return {at - h * u - h * v, at + h * u - h * v, at + h * u + h * v, at - h * u + h * v};
}

float distance_to_line(const ImVec2& p, const ImVec2& a, const ImVec2& b) {
  const float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const float t = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0f, 1.0f) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// How visible an axis is that points along the view: 0 to 1.
float openness(const Gizmo& g, int axis, const scene::Camera& camera) {
  const vec3 away = camera.orthographic ? commands::forward_of(camera) : g.middle - commands::eye_of(camera);
  if (!(glm::length(away) > 0)) return 1;
  const float cosine = std::abs(glm::dot(glm::normalize(away), g.axes[axis]));
  return std::clamp((1 - cosine) / 0.03f, 0.0f, 1.0f);
}

/// Visible parts of an axis's handle begin at this share of its arm.
constexpr float k_begin = 0.14f;

class Pen {
 public:
  Pen(ImDrawList* list, const scene::Camera& camera, const Area& shown)
      : list_(list), camera_(camera), shown_(shown) {}

  bool place(const vec3& point, ImVec2& at) const { return project(camera_, shown_, point, at); }
  void line(const vec3& from, const vec3& to, ImU32 ink, float width, bool shade = true) const {
    ImVec2 p, q;
    if (!place(from, p) || !place(to, q)) return;
    if (std::abs(p.x - q.x) > 0.5f * shown_.width()) return;  // across the seam of a panorama
    if (shade)
      list_->AddLine(p, q, colour::with_alpha(k_shade, 0.5f * float(ink >> 24) / 255), px(width + 2));
    list_->AddLine(p, q, ink, std::max(1.0f, px(width)));
  }
  ImDrawList* list() const { return list_; }

 private:
  ImDrawList* list_;
  const scene::Camera& camera_;
  const Area& shown_;
};

/// True if a surface lies between the eye and a point.
bool is_covered(const session::Probe* probe, const scene::Camera& camera, const vec3& point, float extent) {
  if (!probe) return false;
  const vec3 forward = commands::forward_of(camera);
  const vec3 origin = camera.orthographic ? point - 4 * extent * forward : commands::eye_of(camera);
  const vec3 way = point - origin;
  const float length = glm::length(way);
  if (!(length > 0)) return false;
  return probe->nearest(origin, way / length, 0.999f * length - 1e-4f * extent).has_value();
}

void draw_box(const Pen& pen, const MarkedScene& marked, const Box& box, const mat4& to_world, bool hidden) {
  if (box.empty()) return;
  const session::Probe* probe = marked.camera.probe();
  const scene::Camera& camera = marked.open.snapshot->camera;
  const auto corner = [&](int bits) {
    return vec3(to_world * vec4(bits & 1 ? box.hi.x : box.lo.x, bits & 2 ? box.hi.y : box.lo.y,
                                bits & 4 ? box.hi.z : box.lo.z, 1));
  };
  for (int from = 0; from < 8; ++from)
    for (int axis = 1; axis < 8; axis *= 2) {
      if (from & axis) continue;
      const vec3 a = corner(from), b = corner(from | axis);
      for (int i = 0; i < k_pieces; ++i) {
        const vec3 p = glm::mix(a, b, float(i) / k_pieces), q = glm::mix(a, b, float(i + 1) / k_pieces);
        const bool covered = is_covered(probe, camera, 0.5f * (p + q), marked.camera.view->extent);
        if (hidden && i % 2) continue;  // dashed: it is not in the picture
        pen.line(p, q, colour::with_alpha(colour::accent, covered ? 0.28f : 0.95f), 1.25f, !covered);
      }
    }
}

ImU32 ink_of(const std::optional<GizmoPart>& hot, GizmoPart part, int axis, float alpha = 1) {
  return hot == part ? IM_COL32(255, 240, 200, 255) : colour::with_alpha(k_axis_inks[axis], alpha);
}

void draw_arms(const Pen& pen, const Gizmo& g, const std::optional<GizmoPart>& hot,
               const scene::Camera& camera) {
  // The farthest first.
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return glm::dot(g.axes[a], g.view[2]) < glm::dot(g.axes[b], g.view[2]); });
  for (const int axis : order) {
    const float open = openness(g, axis, camera);
    if (open <= 0.05f) continue;
    const ImU32 ink = ink_of(hot, GizmoPart(axis), axis, open);
    const vec3 tip = g.middle + g.reach * g.axes[axis];
    pen.line(g.middle + k_begin * g.reach * g.axes[axis], tip, ink, hot == GizmoPart(axis) ? 3.0f : 2.25f);
    ImVec2 at, base;
    if (!pen.place(tip, at) || !pen.place(g.middle + 0.86f * g.reach * g.axes[axis], base)) continue;
    if (g.mode == GizmoMode::size) {
      const float half = px(hot == GizmoPart(axis) ? 6.0f : 5.0f);
      pen.list()->AddRectFilled({at.x - half - px(1), at.y - half - px(1)},
                                {at.x + half + px(1), at.y + half + px(1)}, k_shade, px(1));
      pen.list()->AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half}, ink, px(1));
    } else {
      const float dx = at.x - base.x, dy = at.y - base.y, length = std::max(1.0f, std::hypot(dx, dy));
      const float w = px(5), l = px(12);
      const ImVec2 u(dx / length, dy / length);
      const ImVec2 tip_at(at.x + 0.4f * l * u.x, at.y + 0.4f * l * u.y);
      pen.list()->AddTriangleFilled(tip_at, {tip_at.x - l * u.x - w * u.y, tip_at.y - l * u.y + w * u.x},
                                    {tip_at.x - l * u.x + w * u.y, tip_at.y - l * u.y - w * u.x}, ink);
    }
    const char* names = "xyz";
    const float dx = at.x - base.x, dy = at.y - base.y, length = std::max(1.0f, std::hypot(dx, dy));
    const ImVec2 text(at.x + px(16) * dx / length, at.y + px(16) * dy / length);
    draw_text(pen.list(), {text.x - px(8), text.y - px(8)}, {text.x + px(8), text.y + px(8)},
              std::string(1, names[axis]), ink, Align::centre, theme().fonts.small);
  }
}

void draw_squares(const Pen& pen, const Gizmo& g, const std::optional<GizmoPart>& hot) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(glm::dot(g.axes[axis], g.view[2])) < 0.12f) continue;  // seen from its side
    std::array<ImVec2, 4> at;
    const std::array<vec3, 4> corners = square_corners(g, axis);
    bool seen = true;
    for (size_t i = 0; i < 4; ++i) seen = seen && pen.place(corners[i], at[i]);
    if (!seen) continue;
    const GizmoPart part = GizmoPart(int(GizmoPart::yz) + axis);
    const ImU32 ink = ink_of(hot, part, axis);
    pen.list()->AddQuadFilled(at[0], at[1], at[2], at[3],
                              colour::with_alpha(ink, hot == part ? 0.75f : 0.4f));
    pen.list()->AddQuad(at[0], at[1], at[2], at[3], ink, std::max(1.0f, px(1)));
  }
}

void draw_middle(const Pen& pen, const Gizmo& g, const std::optional<GizmoPart>& hot) {
  ImVec2 at;
  if (!pen.place(g.middle, at)) return;
  const bool chosen = hot == GizmoPart::middle;
  const ImU32 ink = chosen ? IM_COL32(255, 240, 200, 255) : colour::text;
  const float r = px(chosen ? 7.0f : 6.0f);
  if (g.mode == GizmoMode::size) {
    pen.list()->AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r}, k_shade, px(1));
    pen.list()->AddRect({at.x - r, at.y - r}, {at.x + r, at.y + r}, ink, px(1), 0, px(1.75f));
  } else {
    pen.list()->AddCircleFilled(at, r + px(1), k_shade, 24);
    pen.list()->AddCircle(at, r, ink, 24, px(1.75f));
  }
}

void draw_rings(const Pen& pen, const Gizmo& g, const std::optional<GizmoPart>& hot,
                const scene::Camera& camera) {
  const vec3 to_eye = camera.orthographic ? g.view[2] : commands::eye_of(camera) - g.middle;
  // What is behind the middle first, faintly.
  for (const bool front : {false, true})
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < k_ring_points; ++i) {
        const vec3 p = ring_point(g, axis, i), q = ring_point(g, axis, i + 1);
        if ((glm::dot(0.5f * (p + q) - g.middle, to_eye) >= -1e-3f * g.reach * glm::length(to_eye)) != front)
          continue;
        const ImU32 ink = ink_of(hot, GizmoPart(axis), axis, front ? 1 : 0.3f);
        pen.line(p, q, ink, hot == GizmoPart(axis) ? 3.0f : 2.0f, front);
      }
}

/// The dragged object on the surface behind it at a point of the screen; where it is now if there is none.
scene::ObjectPlace snapped_place(const ObjectDrag& drag, const MarkedScene& marked, const Area& shown,
                                 const ImVec2& at) {
  const auto hit = surface_at(marked.camera, shown, at,
                              [&](const session::Picked& p) { return p.instance != drag.object; });
  if (!hit) return drag.place;
  const scene::Instance& instance = marked.open.loaded->instances[drag.object];
  return put_on_surface(marked.open.loaded->meshes[instance.mesh], marked.open.object_box(drag.object),
                        instance.to_world, drag.start, {hit->position, hit->normal});
}

/// What the drag has done so far, beside the middle.
std::string text_of(const ObjectDrag& drag) {
  const scene::ObjectPlace &a = drag.start, &b = drag.place;
  if (drag.gizmo.mode == GizmoMode::move) {
    const vec3 way = b.moved - a.moved;
    if (drag.part <= GizmoPart::z) return fmt::format("{:+.3f} m", way[int(drag.part)]);
    return fmt::format("{:+.3f} {:+.3f} {:+.3f} m", way.x, way.y, way.z);
  }
  if (drag.gizmo.mode == GizmoMode::turn) {
    const glm::dmat3 turn = scene::rotation_of(b.turned) * glm::transpose(scene::rotation_of(a.turned));
    const int k = int(drag.part), u = (k + 1) % 3, v = (k + 2) % 3;
    return fmt::format("{:+.1f}\xC2\xB0",
                       glm::degrees(std::atan2(turn[u][v] - turn[v][u], turn[u][u] + turn[v][v])));
  }
  if (drag.part <= GizmoPart::z) return fmt::format("\xC3\x97 {:.3f}", b.scaled[int(drag.part)]);
  return fmt::format("\xC3\x97 {:.3f}", b.scaled.x);
}

}  // namespace

std::optional<GizmoPart> object_handle_at(const MarkedScene& marked, GizmoMode mode, const Area& shown,
                                          const ImVec2& at) {
  const auto object = selected_object(marked);
  if (!object || mode == GizmoMode::off || marked.open.object(*object).hidden) return std::nullopt;
  const scene::Camera& camera = marked.open.snapshot->camera;
  const Gizmo g = gizmo_of(marked, mode, shown, *object, marked.open.object_matrix(*object));
  std::optional<GizmoPart> best;
  float least = px(k_grip);
  const auto consider = [&](GizmoPart part, float away) {
    if (away < least) least = away, best = part;
  };
  const auto line = [&](GizmoPart part, const vec3& from, const vec3& to) {
    ImVec2 p, q;
    if (project(camera, shown, from, p) && project(camera, shown, to, q))
      consider(part, distance_to_line(at, p, q));
  };
  if (mode == GizmoMode::turn) {
    const vec3 to_eye = camera.orthographic ? g.view[2] : commands::eye_of(camera) - g.middle;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < k_ring_points; ++i) {
        const vec3 p = ring_point(g, axis, i), q = ring_point(g, axis, i + 1);
        if (glm::dot(0.5f * (p + q) - g.middle, to_eye) >= -1e-3f * g.reach * glm::length(to_eye))
          line(GizmoPart(axis), p, q);
      }
    return best;
  }
  if (ImVec2 middle; project(camera, shown, g.middle, middle))
    consider(GizmoPart::middle, std::hypot(at.x - middle.x, at.y - middle.y));
  if (best) return best;
  for (int axis = 0; axis < 3; ++axis)
    if (openness(g, axis, camera) > 0.05f)
      line(GizmoPart(axis), g.middle + k_begin * g.reach * g.axes[axis],
           g.middle + 1.1f * g.reach * g.axes[axis]);
  if (best || mode == GizmoMode::size) return best;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(glm::dot(g.axes[axis], g.view[2])) < 0.12f) continue;
    const std::array<vec3, 4> corners = square_corners(g, axis);
    std::array<ImVec2, 4> p;
    bool seen = true;
    for (size_t i = 0; i < 4; ++i) seen = seen && project(camera, shown, corners[i], p[i]);
    if (!seen) continue;
    bool left = true, right = true;
    for (size_t i = 0; i < 4; ++i) {
      const ImVec2 &a = p[i], &b = p[(i + 1) % 4];
      const float side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
      left = left && side >= 0, right = right && side <= 0;
    }
    if (left || right) return GizmoPart(int(GizmoPart::yz) + axis);
  }
  return std::nullopt;
}

ObjectDrag begin_object_drag(const MarkedScene& marked, GizmoMode mode, GizmoPart part, const Area& shown,
                             const ImVec2& at, double now) {
  ObjectDrag drag;
  drag.object = marked.camera.selection.index;
  drag.part = part;
  drag.gizmo = gizmo_of(marked, mode, shown, drag.object, marked.open.object_matrix(drag.object));
  drag.from = ray_through(marked.camera, shown, at);
  drag.start = drag.place = drag.sent = marked.open.object(drag.object);
  drag.moved_at = now;
  return drag;
}

void follow_pointer(ObjectDrag& drag, const MarkedScene& marked, const Area& shown, const ImVec2& at,
                    DragSnap snap, double now) {
  const bool on_surface = snap == DragSnap::surface && drag.gizmo.mode == GizmoMode::move;
  const scene::ObjectPlace place =
      on_surface ? snapped_place(drag, marked, shown, at)
                 : dragged_place(drag.gizmo, drag.part, drag.start, drag.from,
                                 ray_through(marked.camera, shown, at), snap != DragSnap::none);
  if (place == drag.place) return;
  try {
    marked.open.object_matrix(drag.object, place);
  } catch (const Error&) {
    return;
  }
  drag.place = place, drag.moved_at = now;
}

void send_place(Actions& actions, const commands::OpenScene& open, ObjectDrag& drag, RebuildTime& rebuild,
                double now) {
  if (drag.place == drag.sent) return;
  const uint64_t before = open.session.commands();
  if (drag.gizmo.mode == GizmoMode::move)
    actions.act("object.set", drag.object + 1,
                named("position", scene::middle_of(open.object_box(drag.object),
                                                   open.object_matrix(drag.object, drag.place))));
  else if (drag.gizmo.mode == GizmoMode::turn)
    actions.act("object.set", drag.object + 1, named("rotation", drag.place.turned));
  else
    actions.act("object.set", drag.object + 1, named("scale", drag.place.scaled));
  drag.sent = drag.place;
  if (open.session.commands() > before) rebuild.begin(open.session.commands(), now);
}

void draw_object(const MarkedScene& marked, GizmoMode mode, const Area& shown, std::optional<GizmoPart> hot,
                 const ObjectDrag* drag, const TypedPlace* typed) {
  const auto object = selected_object(marked);
  if (!object || marked.open.loaded->instances[*object].mesh >= marked.open.loaded->meshes.size()) return;
  const bool dragged = drag && drag->object == *object;
  const scene::ObjectPlace place = dragged                             ? drag->place
                                   : typed && typed->object == *object ? typed->place
                                                                       : marked.open.object(*object);
  const mat4 to_world = marked.open.object_matrix(*object, place);
  const scene::Camera& camera = marked.open.snapshot->camera;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(shown.lo, shown.hi, true);
  const Pen pen(list, camera, shown);
  draw_box(pen, marked, marked.open.object_box(*object), to_world, place.hidden);
  if (mode != GizmoMode::off && !place.hidden) {
    Gizmo g = gizmo_of(marked, mode, shown, *object, to_world);
    if (dragged) hot = drag->part;
    if (mode == GizmoMode::turn) {
      draw_rings(pen, g, hot, camera);
    } else {
      if (mode == GizmoMode::move) draw_squares(pen, g, hot);
      draw_arms(pen, g, hot, camera);
      draw_middle(pen, g, hot);
    }
    ImVec2 at;
    if (dragged && !(place == drag->start) && pen.place(g.middle, at)) {
      const std::string text = text_of(*drag);
      const float w = text_width(text) + px(16), h = px(22);
      const ImVec2 lo(std::floor(at.x + px(18)), std::floor(at.y + px(18)));
      list->AddRectFilled(lo, {lo.x + w, lo.y + h}, colour::with_alpha(colour::bar, 0.94f), px(3));
      draw_text(list, lo, {lo.x + w, lo.y + h}, text, colour::text, Align::centre);
    }
  }
  list->PopClipRect();
}

}  // namespace lucerna::ui
