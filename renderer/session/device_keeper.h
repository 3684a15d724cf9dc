#pragma once
// Keeps the device between sessions, with its pipelines: a driver may take seconds to compile them.

namespace lucerna::session {

/// While an object exists, a session takes the device of the last one if that was made with the same options
/// and no session uses it. The destructor releases it. One object at a time.
class DeviceKeeper {
 public:
  DeviceKeeper();
  ~DeviceKeeper();
  DeviceKeeper(const DeviceKeeper&) = delete;
  DeviceKeeper& operator=(const DeviceKeeper&) = delete;
};

}  // namespace lucerna::session
