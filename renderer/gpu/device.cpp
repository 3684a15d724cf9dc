#include "gpu/device.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

/// Chain of feature structs: queried, then trimmed to the used ones and enabled.
struct Features {
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float{};

  explicit Features(bool with_atomic_float) {
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &v11;
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    v11.pNext = &v12;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    if (with_atomic_float) {
      v12.pNext = &atomic_float;
      atomic_float.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT;
    }
  }
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;
};

std::vector<std::string> extensions(const Instance& instance, VkPhysicalDevice physical) {
  uint32_t count = 0;
  instance.enumerate_device_extensions(physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> list(count);
  instance.enumerate_device_extensions(physical, nullptr, &count, list.data());
  std::vector<std::string> names;
  for (const auto& extension : list) names.emplace_back(extension.extensionName);
  return names;
}

bool contains(const std::vector<std::string>& list, const char* name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// The family with compute and the most else (a graphics queue has the best-tested timestamps), or -1.
int choose_family(const Instance& instance, VkPhysicalDevice physical, uint32_t* timestamp_bits) {
  uint32_t count = 0;
  instance.queue_families(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  instance.queue_families(physical, &count, families.data());
  int best = -1, best_score = -1;
  for (uint32_t i = 0; i < count; ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    const int score =
        (families[i].timestampValidBits ? 2 : 0) + (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT ? 1 : 0);
    if (score > best_score)
      best = static_cast<int>(i), best_score = score, *timestamp_bits = families[i].timestampValidBits;
  }
  return best;
}

std::string first_missing(const Instance& instance, VkPhysicalDevice physical, const Features& have,
                          bool compute) {
  if (!compute) return "a compute queue";
  if (!have.v12.scalarBlockLayout) return "scalarBlockLayout";
  const std::pair<VkFormat, const char*> formats[] = {{VK_FORMAT_R8G8B8A8_UNORM, "rgba8_unorm"},
                                                      {VK_FORMAT_R8G8B8A8_SRGB, "rgba8_srgb"},
                                                      {VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f"},
                                                      {VK_FORMAT_R32G32B32A32_SFLOAT, "rgba32f"}};
  VkFormatProperties properties{};
  for (const auto& [format, name] : formats) {
    instance.format_properties(physical, format, &properties);
    if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
      return fmt::format("bilinear filtering of {} textures", name);
  }
  // `properties` is now that of rgba32f, the texel buffers' format.
  if (!(properties.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT))
    return "texel buffers of rgba32f";
  if (!(properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT))
    return "storage texel buffers of rgba32f";
  return {};
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string list_of(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (const auto& d : devices)
    text += fmt::format("{}{}: {}{}", text.empty() ? "" : "; ", d.index, d.name,
                        d.missing.empty() ? "" : " (lacks " + d.missing + ")");
  return text;
}

const DeviceInfo& require_usable(const DeviceInfo& device) {
  if (!device.missing.empty())
    throw_error("device", "{} lacks {}, which is needed", device.name, device.missing);
  return device;
}

const DeviceInfo& select(const std::vector<DeviceInfo>& devices, std::string selector) {
  if (selector.empty())
    if (const char* variable = std::getenv("LUCERNA_DEVICE")) selector = variable;
  const auto first = [&](auto&& accept) -> const DeviceInfo* {
    const DeviceInfo* unusable = nullptr;
    for (const auto& d : devices) {
      if (!accept(d)) continue;
      if (d.missing.empty()) return &d;
      if (!unusable) unusable = &d;
    }
    return unusable;
  };
  if (selector.empty()) {
    const auto* d = first([](const DeviceInfo& i) { return i.is_discrete && i.missing.empty(); });
    if (!d) d = first([](const DeviceInfo&) { return true; });
    return require_usable(*d);
  }
  const std::string wanted = lower(selector);
  const DeviceInfo* found = nullptr;
  if (wanted == "cpu") {
    found = first([](const DeviceInfo& i) { return i.is_cpu; });
  } else if (wanted == "gpu") {
    found = first([](const DeviceInfo& i) { return !i.is_cpu && i.is_discrete && i.missing.empty(); });
    if (!found) found = first([](const DeviceInfo& i) { return !i.is_cpu; });
  } else if (wanted.size() < 6 &&
             std::all_of(wanted.begin(), wanted.end(), [](char c) { return c >= '0' && c <= '9'; })) {
    const auto index = static_cast<uint32_t>(std::stoul(wanted));
    found = first([&](const DeviceInfo& i) { return i.index == index; });
  } else {
    found = first([&](const DeviceInfo& i) { return lower(i.name).find(wanted) != std::string::npos; });
  }
  if (!found)
    throw_error("device", "no Vulkan device matches '{}'; there are: {}", selector, list_of(devices));
  return require_usable(*found);
}

}  // namespace

DeviceInfo describe(const Instance& instance, VkPhysicalDevice physical, uint32_t index, uint32_t* family) {
  DeviceInfo info;
  info.index = index;
  VkPhysicalDeviceProperties basic{};
  instance.properties(physical, &basic);
  info.name = basic.deviceName;
  info.api_version = basic.apiVersion;
  info.is_cpu = basic.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  info.is_discrete = basic.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  info.limits.max_storage_buffer = basic.limits.maxStorageBufferRange;
  info.limits.max_texel_elements = basic.limits.maxTexelBufferElements;
  info.limits.max_image_layers = basic.limits.maxImageArrayLayers;
  info.limits.max_image_size = basic.limits.maxImageDimension2D;
  info.limits.max_workgroups_x = basic.limits.maxComputeWorkGroupCount[0];
  info.limits.timestamp_ns = basic.limits.timestampPeriod;
  VkPhysicalDeviceMemoryProperties memory{};
  instance.memory_properties(physical, &memory);
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info.memory_bytes = std::max<uint64_t>(info.memory_bytes, memory.memoryHeaps[i].size);
  if (basic.apiVersion < VK_API_VERSION_1_2) {
    info.missing = "Vulkan 1.2";
    return info;
  }

  VkPhysicalDeviceSubgroupProperties subgroup{};
  subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceIDProperties ids{};
  ids.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
  ids.pNext = &subgroup;
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  driver.pNext = &ids;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  instance.properties2(physical, &properties);
  info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  std::memcpy(info.device_uuid.data(), ids.deviceUUID, VK_UUID_SIZE);
  std::memcpy(info.driver_uuid.data(), ids.driverUUID, VK_UUID_SIZE);
  info.limits.subgroup_size = subgroup.subgroupSize;

  const auto names = extensions(instance, physical);
  Features have(contains(names, VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME));
  instance.features2(physical, &have.core);
  const VkSubgroupFeatureFlags operations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                                            VK_SUBGROUP_FEATURE_BALLOT_BIT |
                                            VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
  info.optional.subgroups = (subgroup.supportedOperations & operations) == operations &&
                            (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT);
  info.optional.float_atomics = have.atomic_float.shaderBufferFloat32AtomicAdd;
  info.optional.external_memory = contains(names, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
  info.optional.int64 = have.core.features.shaderInt64;
  info.optional.int64_atomics = have.core.features.shaderInt64 && have.v12.shaderBufferInt64Atomics;
  info.optional.float64 = have.core.features.shaderFloat64;

  uint32_t timestamp_bits = 0;
  const int chosen = choose_family(instance, physical, &timestamp_bits);
  if (family && chosen >= 0) *family = static_cast<uint32_t>(chosen);
  if (!timestamp_bits) info.limits.timestamp_ns = 0;
  info.missing = first_missing(instance, physical, have, chosen >= 0);
  return info;
}

std::vector<DeviceInfo> enumerate() {
  const Instance instance(false);
  std::vector<DeviceInfo> devices;
  for (VkPhysicalDevice physical : instance.physical_devices())
    devices.push_back(describe(instance, physical, static_cast<uint32_t>(devices.size())));
  return devices;
}

Device::Device(const DeviceOptions& options) : handles_(std::make_unique<Handles>(options.validation)) {
  Handles& h = *handles_;
  const auto physical = h.instance.physical_devices();
  std::vector<DeviceInfo> devices;
  for (VkPhysicalDevice p : physical)
    devices.push_back(describe(h.instance, p, static_cast<uint32_t>(devices.size())));
  h.info = select(devices, options.selector);
  h.physical = physical[h.info.index];
  describe(h.instance, h.physical, h.info.index, &h.queue_family);
  if (options.most_storage_buffer > 0)
    h.info.limits.max_storage_buffer =
        std::min(h.info.limits.max_storage_buffer, options.most_storage_buffer);

  const bool atomic_float =
      contains(extensions(h.instance, h.physical), VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
  Features have(atomic_float), use(atomic_float);
  h.instance.features2(h.physical, &have.core);
  use.core.features.shaderInt64 = have.core.features.shaderInt64;
  use.core.features.shaderInt16 = have.core.features.shaderInt16;
  use.core.features.shaderFloat64 = have.core.features.shaderFloat64;
  use.v11.storageBuffer16BitAccess = have.v11.storageBuffer16BitAccess;
  use.v12.scalarBlockLayout = VK_TRUE;
  use.v12.storageBuffer8BitAccess = have.v12.storageBuffer8BitAccess;
  use.v12.shaderInt8 = have.v12.shaderInt8;
  use.v12.shaderFloat16 = have.v12.shaderFloat16;
  use.v12.shaderBufferInt64Atomics = have.v12.shaderBufferInt64Atomics;
  use.atomic_float.shaderBufferFloat32Atomics = have.atomic_float.shaderBufferFloat32Atomics;
  use.atomic_float.shaderBufferFloat32AtomicAdd = have.atomic_float.shaderBufferFloat32AtomicAdd;
  std::vector<const char*> enabled;
  if (atomic_float) enabled.push_back(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
  if (h.info.optional.external_memory) enabled.push_back(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);

  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = h.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo create{};
  create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  create.pNext = &use.core;
  create.queueCreateInfoCount = 1;
  create.pQueueCreateInfos = &queue;
  create.enabledExtensionCount = static_cast<uint32_t>(enabled.size());
  create.ppEnabledExtensionNames = enabled.data();
  check(h.instance.create_device(h.physical, &create, nullptr, &h.device), "opening the device");
  h.instance.load_device_table(h.device, h.vk);
  h.vk.vkGetDeviceQueue(h.device, h.queue_family, 0, &h.queue);

  VkPhysicalDeviceMaintenance3Properties maintenance{};
  maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &maintenance;
  h.instance.properties2(h.physical, &properties);
  h.max_push_constants = properties.properties.limits.maxPushConstantsSize;
  uint32_t timestamp_bits = 0;
  choose_family(h.instance, h.physical, &timestamp_bits);
  h.timestamps = timestamp_bits > 0;
  h.timestamp_mask = timestamp_bits >= 64 ? ~0ull : (1ull << timestamp_bits) - 1;

  VkPhysicalDeviceMemoryProperties memory{};
  h.instance.memory_properties(h.physical, &memory);
  h.allocator = std::make_unique<Allocator>(h.device, h.vk, memory, maintenance.maxMemoryAllocationSize,
                                            h.info.is_cpu && options.map_device_memory);

  VkSamplerCreateInfo sampler{};
  sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  check(h.vk.vkCreateSampler(h.device, &sampler, nullptr, &h.sampler), "creating the sampler");
}

Device::~Device() {
  if (handles_->device) handles_->vk.vkDeviceWaitIdle(handles_->device);
}

const DeviceInfo& Device::info() const { return handles_->info; }
void Device::limit_allocations(std::optional<uint64_t> count) { handles_->allocator->limit(count); }
uint64_t Device::allocated_bytes() const { return handles_->allocator->allocated_bytes(); }
uint64_t Device::peak_bytes() const { return handles_->allocator->peak_bytes(); }
uint64_t Device::validation_messages() const { return handles_->instance.messages(); }
bool Device::validation_active() const { return handles_->instance.validation_active(); }
Handles& Device::handles() { return *handles_; }

void Device::wait_idle() {
  std::lock_guard lock(handles_->queue_mutex);
  check(handles_->vk.vkDeviceWaitIdle(handles_->device), "waiting for the device");
}

}  // namespace lucerna::gpu
