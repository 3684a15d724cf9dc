#pragma once
// What the window keeps between runs: recent files, bookmarks of scenes' views, whether the first steps were
// shown, and the sizes of its panels, in the user's state folder
// ($XDG_STATE_HOME or ~/.local/state, lucerna/window.json). A file that cannot be read or written is passed
// over in silence: nothing depends on it.
#include "state.h"

namespace lucerna::ui {

void recall(Ui& ui);
void remember(const Ui& ui);

}  // namespace lucerna::ui
