#include "bvh/embree/embree_device.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lucerna::bvh {

EmbreeDevice new_embree_device(int threads) {
  // Embree's own threads only build. They are TBB's: pinning them would take cores from the device's.
  EmbreeDevice device(rtcNewDevice(fmt::format("threads={},set_affinity=0,hugepages=1", threads).c_str()));
  if (!device) throw_error("embree", "cannot start: {}", embree_error(nullptr));
  return device;
}

std::string embree_error(RTCDevice device) {
  switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return {};
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "this processor is not supported (SSE2 is needed)";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

}  // namespace lucerna::bvh
