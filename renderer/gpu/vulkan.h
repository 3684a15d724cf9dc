#pragma once
// Internal to gpu/: the Vulkan handles behind a Device, and the implementations of Buffer, TextureArray and
// Kernel.
#include <volk.h>

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/kernel.h"
#include "gpu/memory.h"
#include "gpu/pipeline.h"
#include "gpu/resources.h"

namespace lucerna::gpu {

/// Throws Error("device", ...) unless `result` is VK_SUCCESS; `doing` completes "Vulkan failed while ...".
void check(VkResult result, const char* doing);

/// A VkInstance with the required instance functions, loaded for this instance: volk's global pointers are
/// shared by all threads and would be overwritten by a second instance.
class Instance {
 public:
  /// Throws Error if there is no loader or driver. `validation` is requested only; see validation_active().
  explicit Instance(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  std::vector<VkPhysicalDevice> physical_devices() const;
  void load_device_table(VkDevice device, VolkDeviceTable& table) const;
  bool validation_active() const { return messenger_ != VK_NULL_HANDLE; }
  uint64_t messages() const { return messages_; }

  VkInstance handle = VK_NULL_HANDLE;
  PFN_vkEnumerateDeviceExtensionProperties enumerate_device_extensions = nullptr;
  PFN_vkGetPhysicalDeviceProperties properties = nullptr;
  PFN_vkGetPhysicalDeviceProperties2 properties2 = nullptr;
  PFN_vkGetPhysicalDeviceFeatures2 features2 = nullptr;
  PFN_vkGetPhysicalDeviceMemoryProperties memory_properties = nullptr;
  PFN_vkGetPhysicalDeviceQueueFamilyProperties queue_families = nullptr;
  PFN_vkGetPhysicalDeviceFormatProperties format_properties = nullptr;
  PFN_vkGetPhysicalDeviceImageFormatProperties image_format_properties = nullptr;
  PFN_vkCreateDevice create_device = nullptr;

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                   VkDebugUtilsMessageTypeFlagsEXT types,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                   void* user);
  PFN_vkEnumeratePhysicalDevices enumerate_physical_devices_ = nullptr;
  PFN_vkDestroyInstance destroy_ = nullptr;
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger_ = nullptr;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<uint64_t> messages_{0};
};

/// Result of enumerate() for one device; `family`: the queue family to use.
DeviceInfo describe(const Instance& instance, VkPhysicalDevice physical, uint32_t index,
                    uint32_t* family = nullptr);

/// Everything behind a Device. `vk` holds the device's own function pointers.
struct Handles {
  explicit Handles(bool validation) : instance(validation) {}
  ~Handles();

  Instance instance;
  DeviceInfo info;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VolkDeviceTable vk{};
  uint32_t queue_family = 0;
  bool timestamps = false;
  uint64_t timestamp_mask = 0;  ///< the bits of a timestamp that count
  uint32_t max_push_constants = 0;
  VkQueue queue = VK_NULL_HANDLE;
  std::mutex queue_mutex;              ///< around submits
  VkSampler sampler = VK_NULL_HANDLE;  ///< bilinear, repeat, one mip level
  std::unique_ptr<Allocator> allocator;
  Pipelines pipelines;

  /// Submits `commands` and waits for its fence.
  void submit_and_wait(VkCommandBuffer commands, VkFence fence);
  /// Records with `record`, submits and waits. Thread-safe.
  void run_now(const std::function<void(VkCommandBuffer)>& record);
  /// Calls `use(buffer, mapped)` with the staging buffer (of staging_bytes) while holding it.
  void with_staging(const std::function<void(VkBuffer, void*)>& use);
  static constexpr uint64_t staging_bytes = 16ull << 20;
  /// Unique, so that a cached descriptor set is never used for a newer resource at the same address.
  uint64_t next_id() { return ++last_id_; }

 private:
  std::mutex now_mutex_, staging_mutex_;
  VkCommandPool now_pool_ = VK_NULL_HANDLE;
  VkCommandBuffer now_commands_ = VK_NULL_HANDLE;
  VkFence now_fence_ = VK_NULL_HANDLE;
  VkBuffer staging_ = VK_NULL_HANDLE;
  Allocation staging_memory_;
  std::atomic<uint64_t> last_id_{0};
};

/// One memory barrier between everything that came before and everything that follows on the device.
void full_barrier(const Handles& handles, VkCommandBuffer commands);

struct Buffer::Impl {
  Handles* handles = nullptr;
  BufferDesc desc;
  uint64_t id = 0;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkBufferView view = VK_NULL_HANDLE;       ///< when desc.texel: as floats
  VkBufferView word_view = VK_NULL_HANDLE;  ///< and as unsigned integers
  uint64_t allocated = 0;                   ///< desc.bytes rounded up to 16, at least 16
  Allocation memory;
  ~Impl();
};

struct TextureArray::Impl {
  Handles* handles = nullptr;
  TextureArrayDesc desc;
  uint64_t id = 0;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  Allocation memory;
  ~Impl();
};

struct Kernel::Impl {
  enum class Kind { storage_buffer, texel_buffer, texel_buffer_words, texel_image, sampled_image };
  struct Slot {
    std::string name;
    Kind kind;
  };
  Handles* handles = nullptr;
  uint64_t id = 0;
  std::string file;
  uint32_t workgroup[3] = {1, 1, 1};
  uint32_t push_bytes = 0;
  std::vector<Slot> slots;  ///< by binding number
  std::shared_ptr<const Pipeline> pipeline;
};

}  // namespace lucerna::gpu
