// links: gpu
// The allocator with a simulated driver, which has the memory layouts of real GPUs.
#include "gpu/memory.h"

#include <random>
#include <set>

#include "kernels/gpu_support.h"

namespace gpu_allocator_tests {

using namespace lucerna;
using namespace lucerna::gpu;
using Catch::Matchers::Contains;
using test::error_of;

namespace {

/// Allocations of the simulated driver. Its functions are plain, so its state is global.
struct Driver {
  std::set<VkDeviceMemory> live;
  std::map<VkDeviceMemory, uint32_t> types;
  uint64_t last = 0;
  std::vector<std::byte> mapping = std::vector<std::byte>(16 << 20);
} driver;

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks*, VkDeviceMemory* memory) {
  *memory = reinterpret_cast<VkDeviceMemory>(++driver.last);
  driver.live.insert(*memory);
  driver.types[*memory] = info->memoryTypeIndex;
  return VK_SUCCESS;
}
VKAPI_ATTR void VKAPI_CALL free_memory(VkDevice, VkDeviceMemory memory, const VkAllocationCallbacks*) {
  CHECK(driver.live.erase(memory) == 1);
}
VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice, VkDeviceMemory, VkDeviceSize, VkDeviceSize,
                                          VkMemoryMapFlags, void** data) {
  *data = driver.mapping.data();
  return VK_SUCCESS;
}

constexpr VkMemoryPropertyFlags k_local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags k_visible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags k_cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

/// A discrete GPU: heap 0 is device memory, heap 1 host memory. Types: 0 other, 1 local, 2 host, 3 host
/// cached, 4 the mapped window into device memory.
VkPhysicalDeviceMemoryProperties discrete() {
  VkPhysicalDeviceMemoryProperties p{};
  p.memoryHeapCount = 2;
  p.memoryHeaps[0] = {64 << 20, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
  p.memoryHeaps[1] = {128 << 20, 0};
  p.memoryTypeCount = 5;
  p.memoryTypes[0] = {0, 1};
  p.memoryTypes[1] = {k_local, 0};
  p.memoryTypes[2] = {k_visible, 1};
  p.memoryTypes[3] = {k_visible | k_cached, 1};
  p.memoryTypes[4] = {k_local | k_visible, 0};
  return p;
}

VolkDeviceTable table() {
  driver = {};
  VolkDeviceTable vk{};
  vk.vkAllocateMemory = allocate_memory;
  vk.vkFreeMemory = free_memory;
  vk.vkMapMemory = map_memory;
  return vk;
}

VkMemoryRequirements needs(VkDeviceSize bytes, VkDeviceSize alignment = 256) {
  return {bytes, alignment, 0x1f};
}

}  // namespace

TEST_CASE("on a discrete GPU device memory is local and unmapped, host memory cached and mapped") {
  const VolkDeviceTable vk = table();
  Allocator allocator(VK_NULL_HANDLE, vk, discrete(), 1ull << 30, false);
  for (const VkDeviceSize bytes : {1024, 4 << 20}) {
    Allocation device = allocator.allocate(needs(bytes), Memory::device, false, "a", bytes);
    CHECK(device.type == 1);
    CHECK(device.mapped == nullptr);
    Allocation host = allocator.allocate(needs(bytes), Memory::host, false, "b", bytes);
    CHECK(host.type == 3);
    CHECK(host.mapped != nullptr);
    CHECK(driver.types[host.memory] == 3);
    allocator.free(device);
    allocator.free(host);
  }
  CHECK(allocator.allocated_bytes() == 0);
}

TEST_CASE("a resource's own restriction of memory types is respected") {
  const VolkDeviceTable vk = table();
  Allocator allocator(VK_NULL_HANDLE, vk, discrete(), 1ull << 30, false);
  Allocation only = allocator.allocate({1024, 16, 1u << 2}, Memory::host, false, "a", 1024);
  CHECK(only.type == 2);
  allocator.free(only);
  CHECK_THAT(error_of([&] {
               allocator.allocate({1024, 16, 1u << 1}, Memory::host, false, "a", 1024);
             }),
             Contains("no suitable kind of memory"));
}

TEST_CASE("allocations never overlap and keep their alignment in any order; free ranges merge") {
  const VolkDeviceTable vk = table();
  {
    Allocator allocator(VK_NULL_HANDLE, vk, discrete(), 1ull << 30, false);
    std::mt19937 random(11);
    std::vector<Allocation> pieces;
    const VkDeviceSize alignments[] = {1, 16, 64, 256, 4096};
    int misplaced = 0, overlaps = 0;
    for (int round = 0; round < 3000; ++round) {
      if (pieces.size() < 60 && random() % 5 < 3) {
        const VkDeviceSize alignment = alignments[random() % 5], bytes = 1 + random() % 200000;
        const Allocation piece =
            allocator.allocate(needs(bytes, alignment), Memory::device, false, "p", bytes);
        misplaced += piece.offset % alignment != 0 || piece.offset + bytes > 8u << 20;
        for (const Allocation& other : pieces)
          overlaps += other.memory == piece.memory && piece.offset < other.offset + other.bytes &&
                      other.offset < piece.offset + piece.bytes;
        pieces.push_back(piece);
      } else if (!pieces.empty()) {
        std::swap(pieces[random() % pieces.size()], pieces.back());
        allocator.free(pieces.back());
        pieces.pop_back();
      }
    }
    CHECK(misplaced == 0);
    CHECK(overlaps == 0);
    for (Allocation& piece : pieces) allocator.free(piece);
    CHECK(allocator.allocated_bytes() == 0);
    CHECK(driver.live.size() == 1);  // one block is kept
    // All free ranges have merged: seven allocations of almost 1 MiB fit into the remaining block.
    for (int i = 0; i < 7; ++i) {
      pieces[i] = allocator.allocate(needs(1000000), Memory::device, false, "p", 1000000);
    }
    CHECK(driver.live.size() == 1);
    for (int i = 0; i < 7; ++i) allocator.free(pieces[i]);
  }
  CHECK(driver.live.empty());
}

TEST_CASE("a full heap is refused with name and size, and is usable again after memory was freed") {
  const VolkDeviceTable vk = table();
  Allocator allocator(VK_NULL_HANDLE, vk, discrete(), 48 << 20, false);
  Allocation first = allocator.allocate(needs(40 << 20), Memory::device, false, "first", 40 << 20);
  CHECK_THAT(
      error_of([&] { allocator.allocate(needs(30 << 20), Memory::device, false, "film sums", 30 << 20); }),
      Contains("out of device memory for 'film sums' (30 MiB; 40 MiB are in use"));
  CHECK_THAT(error_of([&] { allocator.allocate(needs(60 << 20), Memory::device, true, "sky", 60 << 20); }),
             Contains("'sky' needs 60 MiB") && Contains("48 MiB"));
  CHECK(allocator.allocated_bytes() == 40 << 20);
  CHECK(allocator.peak_bytes() == 40 << 20);
  allocator.free(first);
  Allocation second = allocator.allocate(needs(30 << 20), Memory::device, false, "film sums", 30 << 20);
  CHECK(allocator.peak_bytes() == 40 << 20);
  allocator.free(second);
  CHECK(driver.live.empty());
}

}  // namespace gpu_allocator_tests
