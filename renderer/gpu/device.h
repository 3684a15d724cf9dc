#pragma once
// The Vulkan device: compute only, no surface. Vulkan types stay behind this folder; `handles()` is for gpu/
// alone.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace lucerna::gpu {

/// Optional features of a device; used where they help, never required.
struct OptionalFeatures {
  bool float_atomics = false;    ///< shaderBufferFloat32AtomicAdd
  bool subgroups = false;        ///< basic + vote + ballot + arithmetic in compute
  bool external_memory = false;  ///< opaque fd export, for sharing an image with OpenGL
  bool int64 = false;
  bool int64_atomics = false;  ///< on storage buffers: order-free fixed-point sums
  bool float64 = false;
};

struct Limits {
  uint64_t max_storage_buffer = 0;  ///< bytes one binding can see
  uint64_t max_texel_elements = 0;
  uint32_t max_image_layers = 0, max_image_size = 0;
  uint32_t max_workgroups_x = 0;
  uint32_t subgroup_size = 0;
  float timestamp_ns = 1;  ///< nanoseconds a tick; 0 where the queue has no timestamps
};

struct DeviceInfo {
  uint32_t index = 0;  ///< in enumerate()'s order
  std::string name, driver;
  uint32_t api_version = 0;  ///< as VK_API_VERSION
  bool is_cpu = false, is_discrete = false;
  std::array<uint8_t, 16> device_uuid{}, driver_uuid{};
  uint64_t memory_bytes = 0;  ///< of the largest device-local heap
  OptionalFeatures optional;
  Limits limits;
  std::string missing;  ///< the first required feature that is absent; empty when usable
};

/// All Vulkan devices in the loader's order, usable or not. Throws Error if there is no Vulkan loader or
/// driver, naming the package that contains a software driver.
std::vector<DeviceInfo> enumerate();

struct DeviceOptions {
  /// "": LUCERNA_DEVICE if set, else a discrete GPU, else any usable device. Otherwise an index, or part of a
  /// name (case-insensitive), or "cpu" / "gpu".
  std::string selector;
  /// Load the Khronos validation layer if present, with its synchronization checks; messages are counted and
  /// logged.
  bool validation = false;
  /// false: device memory is never mapped, even if possible, as on a GPU. For tests of the copies.
  bool map_device_memory = true;
  /// Largest visible size of a storage buffer in bytes; 0: the device's. For tests of the limit.
  uint64_t most_storage_buffer = 0;
};

struct Handles;  // gpu/vulkan.h

class Device {
 public:
  /// Throws Error: no such device, or a required feature is missing (named).
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const;
  /// For tests of memory shortage: that many more allocations succeed; nullopt: no limit.
  void limit_allocations(std::optional<uint64_t> count);
  uint64_t allocated_bytes() const;      ///< of buffers and images, now
  uint64_t peak_bytes() const;           ///< ... at most so far
  uint64_t validation_messages() const;  ///< warnings and errors since creation
  bool validation_active() const;
  void wait_idle();
  Handles& handles();

 private:
  std::unique_ptr<Handles> handles_;
};

}  // namespace lucerna::gpu
