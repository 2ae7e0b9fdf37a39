// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/instance.hpp"

#include <cstdio>

#include "trace/vulkan/check.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool loader_present() {
  static const bool present = volkInitialize() == VK_SUCCESS;
  return present;
}

InstanceFunctions load_functions(VkInstance instance) {
  InstanceFunctions vk;
#define VANTAGE_LOAD(name) vk.name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(instance, #name));
  VANTAGE_INSTANCE_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
  return vk;
}

}  // namespace

std::shared_ptr<Instance> Instance::get(bool validation) {
  static std::mutex mutex;
  static std::weak_ptr<Instance> watched;
  // Kept for the whole process, since some drivers cannot be loaded and unloaded repeatedly. Never destroyed, since
  // drivers may be gone first at exit.
  static auto& kept = *new std::shared_ptr<Instance>;
  const std::lock_guard lock(mutex);
  if (validation) {
    // Not kept, so that the layer reports objects left undestroyed.
    auto instance = watched.lock();
    if (!instance) watched = instance = std::make_shared<Instance>(true);
    return instance;
  }
  if (!kept) kept = std::make_shared<Instance>(false);
  return kept;
}

Instance::Instance(bool validation) {
  if (!loader_present())
    throw Error(Errc::no_suitable_device,
                "no Vulkan loader (libvulkan.so.1) on this machine; install it (Debian: libvulkan1, "
                "mesa-vulkan-drivers >= 24.1) "
                "or use the engine embree");
  if (vkEnumerateInstanceVersion == nullptr || volkGetInstanceVersion() < VK_API_VERSION_1_2)
    throw Error(Errc::no_suitable_device, "the Vulkan loader is older than 1.2; update it or use the engine embree");

  VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "vantage", 0, version(), 0, VK_API_VERSION_1_2};
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const char* layer = kValidationLayer;
  VkDebugUtilsMessengerCreateInfoEXT messenger{};
  messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messenger.pfnUserCallback = &Instance::on_message;
  messenger.pUserData = this;
  if (validation) {
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &layer;
    info.pNext = &messenger;
  }
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_LAYER_NOT_PRESENT)
    throw Error(Errc::no_suitable_device,
                "the Vulkan validation layer is not installed (Debian: vulkan-validationlayers); install it or "
                "switch validation off");
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Error(
        Errc::no_suitable_device,
        "no Vulkan driver on this machine; install one (Debian: mesa-vulkan-drivers >= 24.1) or use the engine embree");
  check(result, "vkCreateInstance");
  vk_ = load_functions(instance_);
  if (!validation) return;
  const VkResult told = vk_.vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_);
  if (told != VK_SUCCESS) vk_.vkDestroyInstance(instance_, nullptr);
  check(told, "vkCreateDebugUtilsMessengerEXT");
}

Instance::~Instance() {
  if (messenger_) vk_.vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
  if (instance_) vk_.vkDestroyInstance(instance_, nullptr);
  // Reports objects left undestroyed; too late for an exception.
  for (const std::string& message : messages_)
    std::fprintf(stderr, "vantage: the Vulkan validation layer reports: %s\n", message.c_str());
}

VkBool32 Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* self = static_cast<Instance*>(user);
  const std::lock_guard lock(self->mutex_);
  self->messages_.emplace_back(data->pMessage);
  return VK_FALSE;
}

void Instance::check_validation() {
  const std::lock_guard lock(mutex_);
  if (messages_.empty()) return;
  std::vector<std::string> messages;
  messages.swap(messages_);
  const std::string first = messages.front();
  throw Error(Errc::device_failure, "the Vulkan validation layer reports: " + first, std::move(messages));
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
  std::uint32_t count = 0;
  check(vk_.vkEnumeratePhysicalDevices(instance_, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  if (count > 0) check(vk_.vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

VolkDeviceTable Instance::functions_of(VkDevice device) const {
  // volk looks up a device's functions with this global, which nothing else here sets or reads.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  vkGetDeviceProcAddr = vk_.vkGetDeviceProcAddr;
  VolkDeviceTable table{};
  volkLoadDeviceTable(&table, device);
  return table;
}

}  // namespace vantage::vulkan
