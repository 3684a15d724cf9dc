#pragma once

#include "base/future.h"
#include "session/session.h"

namespace lucerna::commands {

/// True if the file has failed and will not be written.
inline bool failed(const session::Saved& saved) {
  if (!is_ready(saved)) return false;
  try {
    saved.get();
    return false;
  } catch (const std::exception&) {
    return true;
  }
}

}  // namespace lucerna::commands
