#pragma once
// Device memory for buffers and images (internal to gpu/). Large resources have separate allocations; small
// buffers share blocks, because drivers limit the number of allocations.
#include <volk.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gpu/resources.h"

namespace lucerna::gpu {

/// A range of device memory. `mapped` points at its first byte, or is null.
struct Allocation {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0, bytes = 0;
  uint32_t type = 0;
  bool shared = false;  ///< part of a block
  void* mapped = nullptr;
};

/// Thread-safe. All allocations must be freed before the allocator is destroyed.
class Allocator {
 public:
  Allocator(VkDevice device, const VolkDeviceTable& vk, const VkPhysicalDeviceMemoryProperties& memory,
            VkDeviceSize largest_allocation, bool map_device_memory);
  ~Allocator();
  Allocator(const Allocator&) = delete;
  Allocator& operator=(const Allocator&) = delete;

  /// `name` and `wanted` (the bytes requested by the user) are for the message. `counted`: part of
  /// allocated_bytes(). Images never share a block, so bufferImageGranularity does not matter. Throws Error
  /// if memory is short.
  Allocation allocate(const VkMemoryRequirements& needs, Memory kind, bool image, const std::string& name,
                      uint64_t wanted, bool counted = true);
  void free(Allocation& allocation, bool counted = true);
  void limit(std::optional<uint64_t> count);  ///< Device::limit_allocations
  uint64_t allocated_bytes() const;
  uint64_t peak_bytes() const;

 private:
  struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint32_t type = 0;
    std::byte* mapped = nullptr;
    std::map<VkDeviceSize, VkDeviceSize> holes;  ///< offset -> bytes, never adjacent
  };
  uint32_t choose_type(uint32_t type_bits, Memory kind) const;
  bool maps(uint32_t type, Memory kind) const;
  VkResult allocate_memory(VkDeviceSize bytes, uint32_t type, bool map, VkDeviceMemory& memory,
                           void*& mapped);
  bool from_blocks(const VkMemoryRequirements& needs, uint32_t type, bool map, Allocation& out);
  VkResult from_new_block(const VkMemoryRequirements& needs, uint32_t type, bool map, Allocation& out);

  VkDevice device_;
  const VolkDeviceTable& vk_;
  VkPhysicalDeviceMemoryProperties memory_;
  VkDeviceSize largest_allocation_;
  bool map_device_memory_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::vector<VkDeviceSize> heap_used_;
  uint64_t allocated_ = 0, peak_ = 0;
  std::optional<uint64_t> left_;  ///< allocations that may still be made
};

/// "99 MiB", "1.5 GiB", "640 bytes".
std::string format_bytes(uint64_t bytes);

}  // namespace lucerna::gpu
