#pragma once
// Owning handles of Embree's reference-counted objects.
#include <embree3/rtcore.h>

#include <memory>
#include <string>

namespace lucerna::bvh {

template <class T, void (*release)(T*)>
struct EmbreeRelease {
  void operator()(T* p) const { release(p); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease<RTCDeviceTy, rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease<RTCSceneTy, rtcReleaseScene>>;
using EmbreeBvh = std::unique_ptr<RTCBVHTy, EmbreeRelease<RTCBVHTy, rtcReleaseBVH>>;

/// `threads` for building; 0: all cores. Throws Error when Embree cannot start.
EmbreeDevice new_embree_device(int threads);
/// The device's last error as words; "" for none.
std::string embree_error(RTCDevice device);

}  // namespace lucerna::bvh
