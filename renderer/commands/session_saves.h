#pragma once
#include <chrono>

#include "session/session.h"

namespace lucerna::commands {

/// True if the file has failed and will not be written.
inline bool failed(const session::Saved& saved) {
  if (!saved.valid() || saved.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  try {
    saved.get();
    return false;
  } catch (const std::exception&) {
    return true;
  }
}

}  // namespace lucerna::commands
