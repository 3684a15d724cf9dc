#pragma once
// Files that the session is writing.
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/future.h"
#include "commands/session_saves.h"
#include "session/session.h"

namespace lucerna::commands {

class SavedFiles {
 public:
  /// A file is being written; `name`: for take_written(), "": none.
  void add(session::Saved saved, const std::string& name = "") {
    latest_ = saved;
    if (!name.empty()) writing_.emplace_back(name, std::move(saved));
  }
  const session::Saved& latest() const { return latest_; }
  /// True if the latest file is written. Throws Error if it never will be.
  bool latest_written() const {
    if (!latest_.valid()) throw Error("", "nothing was written");
    if (!is_ready(latest_)) return false;
    if (failed(latest_)) throw Error("", "nothing was written");
    return true;
  }
  /// Names of files that have been written since the last call.
  std::vector<std::string> take_written() {
    std::vector<std::string> written;
    std::erase_if(writing_, [&](const auto& file) {
      if (!is_ready(file.second)) return false;
      if (!failed(file.second)) written.push_back(file.first);
      return true;
    });
    return written;
  }

 private:
  session::Saved latest_;
  std::vector<std::pair<std::string, session::Saved>> writing_;
};

}  // namespace lucerna::commands
