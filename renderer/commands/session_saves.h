#pragma once
#include <chrono>

#include "session/session.h"

namespace lucerna::commands {

/// Whether a file that was to be written will never be.
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
