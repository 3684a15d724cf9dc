#pragma once
// A frame over the picture with the aspect ratio of the camera, or another one: what a picture of that ratio
// shows.
#include <optional>

#include "layout.h"
#include "scene/scene.h"

namespace lucerna::ui {

struct FrameGuide {
  bool on = false;
  float aspect = 0;  ///< width / height; 0: the camera's
};

/// The frame's place in a picture, by the height that both show; nullopt: the ratio is wider than the
/// picture, or 0.
std::optional<Area> guide_area(const Area& picture, float aspect);
/// Draws it, or why there is none.
void draw_frame_guide(const FrameGuide& guide, const scene::Camera& camera, const Area& picture);

}  // namespace lucerna::ui
