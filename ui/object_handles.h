#pragma once
// The selected object in the picture: its box, and handles to move, turn and size it.
#include <optional>

#include "actions.h"
#include "gizmo.h"
#include "lamp_handles.h"
#include "layout.h"
#include "scene_view.h"

namespace lucerna::ui {

/// A drag at a handle. The scene is built again when the pointer rests or is let go: until then the box alone
/// follows it.
struct ObjectDrag {
  uint32_t object = 0;
  GizmoPart part = GizmoPart::middle;
  Gizmo gizmo;               ///< when it began
  session::PickRay from;     ///< of the pointer, when it began
  scene::ObjectPlace start;  ///< of the object
  scene::ObjectPlace place;  ///< as shown
  scene::ObjectPlace sent;   ///< as the scene has it, or will
  double moved_at = 0;       ///< when the pointer last moved
};

/// How long the last edit of objects took.
struct RebuildTime {
  uint64_t command = 0;  ///< of the edit in progress; 0: none
  double sent_at = 0;
  double seconds = 0;  ///< 0: not known
  void begin(uint64_t number, double now) { command = number, sent_at = now; }
  /// `done`: commands that the session has carried out.
  void follow(uint64_t done, double now) {
    if (command == 0 || done < command) return;
    seconds = now - sent_at, command = 0;
  }
  /// True if a pointer at rest for that time is to be followed by an edit: sooner in scenes that are built
  /// quickly, and not before it is let go in those that take longer than one and a half seconds.
  bool follows(double rest) const {
    return command == 0 && seconds < 1.5 && rest > 0.12 + std::min(seconds, 1.0) / 2;
  }
};

/// The handle of the selected object under a point of the screen.
std::optional<GizmoPart> object_handle_at(const MarkedScene& marked, GizmoMode mode, const Area& shown,
                                          const ImVec2& at);
/// Starts a drag there.
ObjectDrag begin_object_drag(const MarkedScene& marked, GizmoMode mode, GizmoPart part, const Area& shown,
                             const ImVec2& at, double now);
/// The place for a pointer there; with DragSnap::surface a moved object lies on the surface under the
/// pointer, and stays where there is none. A place that is refused (too far, too large) leaves the one
/// before.
void follow_pointer(ObjectDrag& drag, const MarkedScene& marked, const Area& shown, const ImVec2& at,
                    DragSnap snap, double now);
/// Sends the place to the scene, if it differs.
void send_place(Actions& actions, const commands::OpenScene& open, ObjectDrag& drag, RebuildTime& rebuild,
                double now);
/// Draws the box of the selected object, what is behind surfaces faintly, and its handles. `drag`: in
/// progress, or null. `typed`: the object's place while its numbers are changed, or null.
void draw_object(const MarkedScene& marked, GizmoMode mode, const Area& shown, std::optional<GizmoPart> hot,
                 const ObjectDrag* drag, const TypedPlace* typed);

}  // namespace lucerna::ui
