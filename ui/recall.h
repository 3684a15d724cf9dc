#pragma once
// State kept between runs: recent files, bookmarks, swatches, whether the first steps were shown, panel
// sizes. Stored in the user's state folder ($XDG_STATE_HOME or ~/.local/state, lucerna/window.json). Several
// windows share the file: each writes only its changes, under a lock, immediately. An unreadable file counts
// as none.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands/navigation.h"
#include "layout.h"

namespace lucerna::ui {

inline constexpr size_t k_recent_files = 8;  ///< number of recent files kept

/// What is kept, where the window has it.
struct Remembered {
  std::vector<std::string>& recent;
  std::map<std::string, commands::Navigation::Bookmarks>& bookmarks;  ///< by the scene's file
  std::map<std::string, std::string>& swatches;                       ///< words of material.set, by name
  std::map<std::string, std::string>& folders;  ///< from which files were chosen last, by their ending
  Layout& layout;
  std::map<std::string, bool>& sections;  ///< open or not, by title
  bool& welcomed;                         ///< the first steps were shown
};

class Memory {
 public:
  /// Loads the state into `window`, whose values must outlive this.
  explicit Memory(const Remembered& window);
  /// Saves the remaining changes.
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// Saves changes of bookmarks, recent files and the first steps at once, those of panels when they have
  /// lasted half a second. Call once per frame; `now` in seconds.
  void follow(double now);
  /// Merges the changes in the window since the last call with those that other windows have written, writes
  /// the result, and takes over their bookmarks and recent files. False if another window holds the lock. A
  /// failure to write is logged once as a warning.
  bool save();

 private:
  struct Kept;
  Remembered window_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace lucerna::ui
