#pragma once
// The comparison with a held result over the picture: a wipe with a line to drag, the held result in its
// place, or the difference in colours; with labels in words.
#include "actions.h"
#include "compare_pictures.h"
#include "layout.h"

namespace lucerna::ui {

/// What the comparison remembers from frame to frame.
struct CompareState {
  explicit CompareState(const commands::OpenScene& open) : pictures(open) {}

  ComparePictures pictures;
  bool dragging = false;     ///< the line of the wipe
  bool flipped = false;      ///< its key is held: the other picture is shown
  std::string named, typed;  ///< name that is being typed for the result `named`
};

/// Draws the comparison over the picture; nothing if none is shown.
void draw_comparison(const commands::Workspace& work, const CompareState& state, const Area& picture);

/// Lets the line of the wipe be dragged; `active`: the picture is pressed. Returns true if the press belongs
/// to it.
bool drag_wipe(Actions& actions, const commands::Workspace& work, CompareState& state, const Area& picture,
               bool active);

}  // namespace lucerna::ui
