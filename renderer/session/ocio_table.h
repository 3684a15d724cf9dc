#pragma once
// The display and view of film.ocio as a table on the device.
#include <memory>
#include <string>

#include "gpu/resources.h"
#include "plan/settings.h"

namespace lucerna::session {

struct OcioTable {
  std::string of;  ///< file, display and view
  gpu::Buffer nodes;
  float white;  ///< film::OcioConfig::white()
};

/// Null without film.ocio; `present` if it fits. Throws Error located at the setting: $OCIO names no
/// configuration, or there is no such display or view.
std::shared_ptr<const OcioTable> ocio_table(gpu::Device& device, const plan::Settings& settings,
                                            std::shared_ptr<const OcioTable> present);

}  // namespace lucerna::session
