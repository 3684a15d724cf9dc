#pragma once
// What the window keeps between runs: recent files, bookmarks of scenes' views, whether the first steps were
// shown, and the sizes of its panels, in the user's state folder
// ($XDG_STATE_HOME or ~/.local/state, lucerna/window.json). Several windows share the file: each writes only
// what changed in itself, under a lock, as soon as it has changed. A file that cannot be read counts as none.
#include <memory>

#include "state.h"

namespace lucerna::ui {

class Memory {
 public:
  /// Puts what is kept into `ui`, which must outlive this.
  explicit Memory(Ui& ui);
  /// Saves what has changed since.
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// Saves a change of bookmarks, recent files or the first steps at once, and one of the panels when it has
  /// lasted half a second. Call once a frame; `now` in seconds.
  void follow(double now);
  /// Merges what changed in `ui` since the last call with what other windows have written since, writes it,
  /// and takes over their bookmarks and recent files. False if another window holds the lock. A failure to
  /// write is logged as a warning, once.
  bool save();

 private:
  struct Kept;
  Ui& ui_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace lucerna::ui
