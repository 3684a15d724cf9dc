#include "gpu/memory.h"

#include <algorithm>
#include <fstream>

#include "base/huge_pages.h"
#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

constexpr VkDeviceSize k_block_bytes = 8ull << 20;
constexpr VkDeviceSize k_check_host_above = 64ull
                                            << 20;  ///< for larger sizes, the host's free memory is checked
constexpr VkDeviceSize k_small_bytes = 1ull << 20;  ///< below this, a buffer shares a block

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

/// What the operating system could give now, or "plenty" when it does not say.
VkDeviceSize host_bytes_available() {
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    uint64_t kib = 0;
    if (key == "MemAvailable:" && file >> kib) return kib * 1024;
  }
  return ~0ull;
}

}  // namespace

std::string format_bytes(uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  const char* const units[] = {"KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes) / 1024;
  int unit = 0;
  while (value >= 1024 && unit < 3) value /= 1024, ++unit;
  if (value < 10 && value != static_cast<int>(value)) return fmt::format("{:.1f} {}", value, units[unit]);
  return fmt::format("{:.0f} {}", value, units[unit]);
}

Allocator::Allocator(VkDevice device, const VolkDeviceTable& vk,
                     const VkPhysicalDeviceMemoryProperties& memory, VkDeviceSize largest_allocation,
                     bool map_device_memory)
    : device_(device),
      vk_(vk),
      memory_(memory),
      largest_allocation_(largest_allocation),
      map_device_memory_(map_device_memory),
      heap_used_(memory.memoryHeapCount, 0) {}

Allocator::~Allocator() {
  for (const auto& block : blocks_) vk_.vkFreeMemory(device_, block->memory, nullptr);
}

bool Allocator::maps(uint32_t type, Memory kind) const {
  const VkMemoryPropertyFlags flags = memory_.memoryTypes[type].propertyFlags;
  const VkMemoryPropertyFlags needed =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  return (kind == Memory::host || map_device_memory_) && (flags & needed) == needed;
}

uint32_t Allocator::choose_type(uint32_t type_bits, Memory kind) const {
  const VkMemoryPropertyFlags visible =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  // Flags are wanted in the order of their weight; what must not be there only breaks ties.
  int best_score = -1;
  uint32_t best = 0;
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
    if (!(type_bits & (1u << i))) continue;
    if (flags & (VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT | VK_MEMORY_PROPERTY_PROTECTED_BIT)) continue;
    int score = 0;
    if (kind == Memory::host) {
      if ((flags & visible) != visible) continue;
      score = (flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT ? 2 : 0) +
              (flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT ? 0 : 1);
    } else {
      const bool mappable = (flags & visible) == visible;
      score = (flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT ? 4 : 0) +
              (mappable == map_device_memory_ ? 2 : 0) +
              (mappable && (flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT) ? 1 : 0);
    }
    if (score > best_score) best_score = score, best = i;
  }
  if (best_score < 0)
    throw_error("device", "no suitable kind of memory for a {} buffer or image",
                kind == Memory::host ? "host-visible" : "device");
  return best;
}

VkResult Allocator::allocate_memory(VkDeviceSize bytes, uint32_t type, bool map, VkDeviceMemory& memory,
                                    void*& mapped) {
  const uint32_t heap = memory_.memoryTypes[type].heapIndex;
  // A software device over-commits: the operating system would kill the program later instead of refusing
  // now.
  if (bytes > largest_allocation_ || heap_used_[heap] + bytes > memory_.memoryHeaps[heap].size)
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  if (map_device_memory_ && bytes >= k_check_host_above && bytes > host_bytes_available())
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, bytes, type};
  VkResult result = vk_.vkAllocateMemory(device_, &info, nullptr, &memory);
  if (result != VK_SUCCESS) return result;
  mapped = nullptr;
  // On a device that is the processor, large pages serve what it alone reads just as well.
  const bool advise = map_device_memory_ && maps(type, Memory::device);
  if (map || advise) {
    result = vk_.vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) {
      vk_.vkFreeMemory(device_, memory, nullptr);
      return result;
    }
    if (advise) advise_huge_pages(mapped, bytes);
    if (!map) {
      vk_.vkUnmapMemory(device_, memory);
      mapped = nullptr;
    }
  }
  heap_used_[heap] += bytes;
  return VK_SUCCESS;
}

bool Allocator::from_blocks(const VkMemoryRequirements& needs, uint32_t type, bool map, Allocation& out) {
  for (const auto& block : blocks_) {
    // The same type may serve mapped and unmapped resources.
    if (block->type != type || map != (block->mapped != nullptr)) continue;
    for (const auto& [hole_offset, hole_bytes] : block->holes) {
      const VkDeviceSize offset = align_up(hole_offset, needs.alignment);
      const VkDeviceSize end = hole_offset + hole_bytes;
      if (offset + needs.size > end) continue;
      const VkDeviceSize first = hole_offset;
      block->holes.erase(first);
      if (offset > first) block->holes[first] = offset - first;
      if (offset + needs.size < end) block->holes[offset + needs.size] = end - offset - needs.size;
      out = {block->memory, offset, needs.size, type, true, block->mapped ? block->mapped + offset : nullptr};
      return true;
    }
  }
  return false;
}

VkResult Allocator::from_new_block(const VkMemoryRequirements& needs, uint32_t type, bool map,
                                   Allocation& out) {
  auto block = std::make_unique<Block>();
  void* mapped = nullptr;
  const VkResult result = allocate_memory(k_block_bytes, type, map, block->memory, mapped);
  if (result != VK_SUCCESS) return result;
  block->type = type;
  block->mapped = static_cast<std::byte*>(mapped);
  block->holes[0] = k_block_bytes;
  blocks_.push_back(std::move(block));
  return from_blocks(needs, type, map, out) ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

Allocation Allocator::allocate(const VkMemoryRequirements& needs, Memory kind, bool image,
                               const std::string& name, uint64_t wanted, bool counted) {
  std::lock_guard lock(mutex_);
  const uint32_t type = choose_type(needs.memoryTypeBits, kind);
  const bool map = !image && maps(type, kind);
  Allocation out;
  VkResult result = VK_SUCCESS;
  if (left_ && *left_ == 0)
    result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
  else if (!image && needs.size < k_small_bytes) {
    if (!from_blocks(needs, type, map, out)) result = from_new_block(needs, type, map, out);
  } else {
    result = allocate_memory(needs.size, type, map, out.memory, out.mapped);
    out.offset = 0, out.bytes = needs.size, out.type = type, out.shared = false;
  }
  if (result != VK_SUCCESS) {
    if (needs.size > largest_allocation_)
      throw_error("device",
                  "'{}' needs {}, more than the {} that this device gives to one buffer or image; try a "
                  "smaller --size or scene",
                  name, format_bytes(wanted), format_bytes(largest_allocation_));
    throw_error("device",
                "out of device memory for '{}' ({}; {} are in use already); try a smaller --size or fewer "
                "samples in flight",
                name, format_bytes(wanted), format_bytes(allocated_));
  }
  if (left_) --*left_;
  if (counted) {
    allocated_ += out.bytes;
    peak_ = std::max(peak_, allocated_);
  }
  return out;
}

void Allocator::free(Allocation& allocation, bool counted) {
  if (!allocation.memory) return;
  std::lock_guard lock(mutex_);
  if (counted) allocated_ -= allocation.bytes;
  const uint32_t heap = memory_.memoryTypes[allocation.type].heapIndex;
  if (!allocation.shared) {
    vk_.vkFreeMemory(device_, allocation.memory, nullptr);
    heap_used_[heap] -= allocation.bytes;
  } else {
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [&](const auto& b) { return b->memory == allocation.memory; });
    auto& holes = (*found)->holes;
    auto hole = holes.emplace(allocation.offset, allocation.bytes).first;
    if (const auto next = std::next(hole); next != holes.end() && hole->first + hole->second == next->first) {
      hole->second += next->second;
      holes.erase(next);
    }
    if (hole != holes.begin()) {
      if (const auto before = std::prev(hole); before->first + before->second == hole->first) {
        before->second += hole->second;
        holes.erase(hole);
      }
    }
    // One empty block may stay for the next small buffer; more would be a leak in effect.
    const bool empty = holes.size() == 1 && holes.begin()->second == k_block_bytes;
    if (empty && blocks_.size() > 1) {
      vk_.vkFreeMemory(device_, allocation.memory, nullptr);
      heap_used_[heap] -= k_block_bytes;
      blocks_.erase(found);
    }
  }
  allocation = {};
}

void Allocator::limit(std::optional<uint64_t> count) {
  std::lock_guard lock(mutex_);
  left_ = count;
}

uint64_t Allocator::allocated_bytes() const {
  std::lock_guard lock(mutex_);
  return allocated_;
}

uint64_t Allocator::peak_bytes() const {
  std::lock_guard lock(mutex_);
  return peak_;
}

}  // namespace lucerna::gpu
