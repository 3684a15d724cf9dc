#pragma once
// The picture in the middle of the window, what is drawn over it, and what the pointer does in it.
#include <optional>
#include <string>
#include <vector>

#include "camera_moves.h"
#include "compare_panel.h"
#include "controls.h"
#include "frame_guide.h"
#include "histogram.h"
#include "lamp_handles.h"
#include "layout.h"
#include "object_handles.h"
#include "paths_panel.h"
#include "region_view.h"
#include "scene_view.h"

namespace lucerna::ui {

/// The left button held on the picture, for the pixel inspector.
struct HeldPixel {
  std::optional<double> since;  ///< when it was pressed; none: it is not
  bool reported = false;        ///< its report was requested
};

struct Viewport {
  // What it works with.
  Controls& controls;
  commands::Workspace& work;
  CameraMoves& moves;
  SceneView& scene_view;
  PathsView& paths;
  RegionView& region;
  CompareState& compare;
  CardsView& cards;

  // The picture.
  unsigned texture = 0;  ///< OpenGL name
  uint32_t texture_width = 0, texture_height = 0;
  int divisor = 1;  ///< window pixels per picture pixel
  Area area;        ///< where the picture may be
  bool hovered = false;
  bool has_picture() const { return work.open.snapshot && !work.open.snapshot->rgba.empty(); }

  // What is drawn over it.
  bool light_marks = false;  ///< lights are marked
  bool brackets = true;      ///< the selected object is marked
  HistogramView histogram;
  FrameGuide frame_guide;
  MarkedScene marked() { return {work.open, work.camera, light_marks}; }

  // What the pointer does in it.
  bool dropper = false;  ///< the next click sets the exposure
  /// True if the next click does not select: it sets the exposure or the plane of focus, places a highlight,
  /// traces paths, or begins a rectangle.
  bool click_taken() const {
    return dropper || scene_view.focusing || scene_view.highlighting || paths.pick != PathsView::Pick::none ||
           region.picks;
  }
  /// Makes the next click select again.
  void take_click();
  /// Where a drag started.
  struct {
    std::optional<vec3> point;       ///< of the scene
    float azimuth = 0;               ///< of what is turned by it, degrees
    std::optional<LampHandle> lamp;  ///< as it was then
    std::optional<ObjectDrag> object;
    bool over = false;  ///< Esc has ended it while the button is held
  } drag;
  RebuildTime rebuild;
  /// Esc: ends a drag of an object or a lamp, which goes back to where the drag began. False if there is
  /// none.
  bool cancel_drag();
  /// Esc: makes the next click select again, by a command. False if it does.
  bool give_up_click();

  HeldPixel held_pixel;
  /// The last inspected place of a pointer at rest, as inspect.at takes it.
  std::optional<vec2> inspected_place;
  /// Number of inspections seen here, and whether a script has inspected a point since the pointer moved:
  /// then the pointer inspects nothing.
  uint64_t inspections_known = 0;
  bool script_inspects = false;
};

/// `keys`: pressed in this frame. `recent`: files for an empty window. `paths_marks`: the traced pixel and
/// the explained area are marked.
void draw_picture(Viewport& view, const Keys& keys, const std::vector<std::string>& recent, bool paths_marks,
                  const Area& area);
/// The view toolbar. `dropper`: Viewport::dropper.
void draw_toolbar(Actions& actions, const commands::OpenScene& open, bool dropper, const Area& area);

/// Traces the paths of the pixel at that place, and shows their panel.
void trace_pixel(Actions& actions, const PathsView& paths, const vec2& at);

}  // namespace lucerna::ui
