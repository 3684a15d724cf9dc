#pragma once
// Waits for a property of the picture.
#include <functional>

#include "commands/workspace.h"

namespace lucerna::commands {

class PictureWait {
 public:
  explicit PictureWait(const Workspace& work)
      : since_(work.now),
        errors_(work.error_count),
        picture_(work.open.snapshot ? work.open.snapshot->id : 0) {}

  /// True if the newest picture, which includes all commands, fulfils the condition. Throws Error if it never
  /// will: it stands still after an error, a solver waits for a command, or rendering is paused.
  bool poll(const Workspace& work, const std::function<bool(const session::Snapshot&)>& fulfils) {
    constexpr double k_standstill = 10;  // seconds without a new picture
    const session::Snapshot* snapshot = work.open.snapshot.get();
    if (snapshot && snapshot->id != picture_) picture_ = snapshot->id, since_ = work.now;
    if (work.error_count > errors_ && work.now - since_ > k_standstill)
      throw Error("", "the picture stands still after an error");
    // A picture from before the last edits, cameras and sizes does not count.
    if (!work.open.up_to_date() || work.camera.resizing) return false;
    if (const solvers::Report* waiting = work.open.waiting()) throw Error("", waiting->to_go_on);
    if (fulfils(*snapshot)) return true;
    if (snapshot->paused) throw Error("", "rendering is paused; render.resume takes more samples");
    return false;
  }

 private:
  double since_;      ///< time of its start, or of the last new picture during it
  uint64_t errors_;   ///< at its start
  uint64_t picture_;  ///< last seen
};

}  // namespace lucerna::commands
