#include <cstring>

#include "base/log.h"
#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

constexpr const char* k_validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr const char* k_install_hint =
    "install a Vulkan driver, or a software one (Debian packages libvulkan1 and mesa-vulkan-drivers)";

/// Around everything that reads or writes volk's global pointers.
std::mutex& volk_mutex() {
  static std::mutex mutex;
  return mutex;
}

bool has_layer(const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  for (const auto& layer : layers)
    if (std::strcmp(layer.layerName, name) == 0) return true;
  return false;
}

template <class Function>
void load(VkInstance instance, Function& function, const char* name) {
  function = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

void check(VkResult result, const char* doing) {
  if (result == VK_SUCCESS) return;
  switch (result) {
    case VK_ERROR_DEVICE_LOST:
      throw_error("device",
                  "the device was lost while {}: a kernel ran too long for the driver's watchdog or read "
                  "outside its memory; try a smaller batch or another --device",
                  doing);
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw_error("device", "out of device memory while {}", doing);
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw_error("device", "out of host memory while {}", doing);
    default:
      throw_error("device", "Vulkan failed while {} (VkResult {})", doing, static_cast<int>(result));
  }
}

VkBool32 Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                              VkDebugUtilsMessageTypeFlagsEXT types,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  // The loader's own remarks (a driver that it could not load, for one) are of the general type and not about
  // us.
  if (types == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT) return VK_FALSE;
  ++static_cast<Instance*>(user)->messages_;
  const auto level =
      severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? log::Level::error : log::Level::warning;
  log::write(level, fmt::format("Vulkan validation: {}", data->pMessage ? data->pMessage : "(no text)"));
  return VK_FALSE;
}

Instance::Instance(bool validation) {
  std::lock_guard lock(volk_mutex());
  static const VkResult loaded = volkInitialize();
  if (loaded != VK_SUCCESS) throw_error("device", "there is no Vulkan loader here; {}", k_install_hint);

  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "Lucerna";
  application.apiVersion = VK_API_VERSION_1_2;

  VkDebugUtilsMessengerCreateInfoEXT messenger{};
  messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                          VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                          VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  messenger.pfnUserCallback = on_message;
  messenger.pUserData = this;

  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  const VkValidationFeatureEnableEXT checks[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{};
  features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features.pNext = &messenger;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = checks;
  const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                    VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const bool layer = validation && has_layer(k_validation_layer);
  if (layer) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &k_validation_layer;
    info.enabledExtensionCount = 2;
    info.ppEnabledExtensionNames = extensions;
  } else if (validation) {
    log::warning("the Vulkan validation layer is not installed (Debian package vulkan-validationlayers)");
  }
  const VkResult result = vkCreateInstance(&info, nullptr, &handle);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw_error("device", "there is no Vulkan driver here; {}", k_install_hint);
  check(result, "starting Vulkan");

  volkLoadInstanceOnly(handle);
  load(handle, destroy_, "vkDestroyInstance");
  load(handle, enumerate_physical_devices_, "vkEnumeratePhysicalDevices");
  load(handle, enumerate_device_extensions, "vkEnumerateDeviceExtensionProperties");
  load(handle, properties, "vkGetPhysicalDeviceProperties");
  load(handle, properties2, "vkGetPhysicalDeviceProperties2");
  load(handle, features2, "vkGetPhysicalDeviceFeatures2");
  load(handle, memory_properties, "vkGetPhysicalDeviceMemoryProperties");
  load(handle, queue_families, "vkGetPhysicalDeviceQueueFamilyProperties");
  load(handle, format_properties, "vkGetPhysicalDeviceFormatProperties");
  load(handle, image_format_properties, "vkGetPhysicalDeviceImageFormatProperties");
  load(handle, create_device, "vkCreateDevice");
  if (layer) {
    PFN_vkCreateDebugUtilsMessengerEXT create_messenger = nullptr;
    load(handle, create_messenger, "vkCreateDebugUtilsMessengerEXT");
    load(handle, destroy_messenger_, "vkDestroyDebugUtilsMessengerEXT");
    if (create_messenger) create_messenger(handle, &messenger, nullptr, &messenger_);
  }
}

Instance::~Instance() {
  if (messenger_) destroy_messenger_(handle, messenger_, nullptr);
  if (handle) destroy_(handle, nullptr);
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
  uint32_t count = 0;
  const VkResult result = enumerate_physical_devices_(handle, &count, nullptr);
  if (result == VK_ERROR_INITIALIZATION_FAILED || (result == VK_SUCCESS && count == 0))
    throw_error("device", "Vulkan lists no device; {}", k_install_hint);
  check(result, "listing devices");
  std::vector<VkPhysicalDevice> devices(count);
  check(enumerate_physical_devices_(handle, &count, devices.data()), "listing devices");
  return devices;
}

void Instance::load_device_table(VkDevice device, VolkDeviceTable& table) const {
  std::lock_guard lock(volk_mutex());
  volkLoadInstanceOnly(handle);  // vkGetDeviceProcAddr must be that of the instance that made the device
  volkLoadDeviceTable(&table, device);
}

}  // namespace lucerna::gpu
