#pragma once
#include <memory>
#include <string>

#include "gpu/device.h"

namespace lucerna::session {

/// The device for a session: kept by a DeviceKeeper if there is one, else null (the session makes its own).
/// Throws Error like gpu::Device.
std::shared_ptr<gpu::Device> kept_device(const std::string& selector);

}  // namespace lucerna::session
