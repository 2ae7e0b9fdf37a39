// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <optional>

#include "trace/vulkan/check.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage::vulkan {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr std::array ray_query_extensions{VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                          VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

// volk keeps one process-wide table of functions; it must be filled once.
bool loader_present() {
  static const bool present = volkInitialize() == VK_SUCCESS;
  return present;
}

// The features that the engines use, chained for query and creation alike.
struct Features {
  VkPhysicalDeviceRayQueryFeaturesKHR ray_query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, nullptr,
                                                VK_FALSE};
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceFeatures2 core{};

  explicit Features(bool with_ray_query) {
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    acceleration.pNext = &ray_query;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = with_ray_query ? &acceleration : nullptr;
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &v12;
  }
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;
};

std::vector<std::string> extensions_of(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> properties(count);
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, properties.data()),
        "vkEnumerateDeviceExtensionProperties");
  std::vector<std::string> names;
  for (const auto& p : properties) names.emplace_back(p.extensionName);
  return names;
}

}  // namespace

std::shared_ptr<Instance> Instance::get(bool validation) {
  static std::mutex mutex;
  static std::weak_ptr<Instance> watched;
  // Kept for good: some drivers cannot be loaded and unloaded any number of times. Never destroyed, since at exit they
  // may be gone first.
  static auto& kept = *new std::shared_ptr<Instance>;
  const std::lock_guard lock(mutex);
  if (validation) {
    // Not kept, so that what was left undestroyed is told.
    auto instance = watched.lock();
    if (!instance) watched = instance = std::shared_ptr<Instance>(new Instance(true));
    return instance;
  }
  if (!kept) kept.reset(new Instance(false));
  return kept;
}

Instance::Instance(bool validation) {
  if (!loader_present())
    throw Error(Errc::no_suitable_device,
                "no Vulkan loader (libvulkan.so.1) on this machine; install it (Debian: libvulkan1, "
                "mesa-vulkan-drivers >= 24.1) "
                "or use --engine embree");
  if (vkEnumerateInstanceVersion == nullptr || volkGetInstanceVersion() < VK_API_VERSION_1_2)
    throw Error(Errc::no_suitable_device, "the Vulkan loader is older than 1.2; update it or use --engine embree");

  VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "vantage", 0, version(), 0, VK_API_VERSION_1_2};
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const char* layer = validation_layer;
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
                "the Vulkan validation layer is not installed (Debian: vulkan-validationlayers); install it or go "
                "without --validation");
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Error(
        Errc::no_suitable_device,
        "no Vulkan driver on this machine; install one (Debian: mesa-vulkan-drivers >= 24.1) or use --engine embree");
  check(result, "vkCreateInstance");
  volkLoadInstance(instance_);
  if (validation)
    check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
          "vkCreateDebugUtilsMessengerEXT");
}

Instance::~Instance() {
  if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
  if (instance_) vkDestroyInstance(instance_, nullptr);
  // Too late for an exception, and what was left undestroyed is reported here.
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
  check(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  if (count > 0) check(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

DeviceAbilities abilities_of(VkPhysicalDevice device) {
  DeviceAbilities a;
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceSubgroupProperties subgroup{};
  subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  subgroup.pNext = &driver;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  vkGetPhysicalDeviceProperties(device, &properties.properties);
  a.name = properties.properties.deviceName;
  a.type = properties.properties.deviceType;
  if (properties.properties.apiVersion < VK_API_VERSION_1_2) {
    a.compute_lacks.push_back("Vulkan 1.2 (the driver offers " +
                              std::to_string(VK_API_VERSION_MAJOR(properties.properties.apiVersion)) + "." +
                              std::to_string(VK_API_VERSION_MINOR(properties.properties.apiVersion)) + ")");
    return a;
  }
  properties.pNext = &subgroup;
  vkGetPhysicalDeviceProperties2(device, &properties);
  a.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  a.subgroup_size = subgroup.subgroupSize;

  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  for (std::uint32_t h = 0; h < memory.memoryHeapCount; ++h)
    if (memory.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      a.memory_bytes = std::max<std::uint64_t>(a.memory_bytes, memory.memoryHeaps[h].size);

  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  std::optional<std::uint32_t> family;
  for (std::uint32_t f = 0; f < count; ++f)
    if ((families[f].queueFlags & VK_QUEUE_COMPUTE_BIT) && families[f].timestampValidBits > 0 && !family) family = f;
  if (!family) a.compute_lacks.emplace_back("a compute queue with timestamps");
  a.queue_family = family.value_or(0);

  const auto extensions = extensions_of(device);
  const auto has = [&](const char* name) {
    return std::find(extensions.begin(), extensions.end(), name) != extensions.end();
  };
  bool all_ray_query = true;
  for (const char* name : ray_query_extensions)
    if (!has(name)) {
      a.ray_query_lacks.emplace_back(name);
      all_ray_query = false;
    }
  Features features(all_ray_query);
  vkGetPhysicalDeviceFeatures2(device, &features.core);
  const auto need = [](bool present, const char* name, std::vector<std::string>& lacks) {
    if (!present) lacks.emplace_back(name);
  };
  need(features.v12.bufferDeviceAddress, "bufferDeviceAddress", a.compute_lacks);
  need(features.v12.scalarBlockLayout, "scalarBlockLayout", a.compute_lacks);
  need(features.core.features.shaderInt64, "shaderInt64", a.compute_lacks);
  const VkSubgroupFeatureFlags subgroup_needs =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  need((subgroup.supportedOperations & subgroup_needs) == subgroup_needs &&
           (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT),
       "subgroup arithmetic and ballot in compute shaders", a.compute_lacks);
  if (all_ray_query) {
    need(features.acceleration.accelerationStructure, "accelerationStructure", a.ray_query_lacks);
    need(features.ray_query.rayQuery, "rayQuery", a.ray_query_lacks);
  }
  return a;
}

Device::Device(std::shared_ptr<Instance> instance, VkPhysicalDevice physical, const DeviceAbilities& abilities,
               bool ray_query)
    : instance_(std::move(instance)), abilities_(abilities), ray_query_(ray_query) {
  vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
  VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{};
  acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = ray_query ? &acceleration : nullptr;
  vkGetPhysicalDeviceProperties2(physical, &properties);
  timestamp_period_ns_ = static_cast<double>(properties.properties.limits.timestampPeriod);
  if (ray_query)
    scratch_alignment_ = std::max<VkDeviceSize>(1, acceleration.minAccelerationStructureScratchOffsetAlignment);

  Features features(ray_query);
  features.core.features.shaderInt64 = VK_TRUE;
  features.v12.bufferDeviceAddress = VK_TRUE;
  features.v12.scalarBlockLayout = VK_TRUE;
  features.acceleration.accelerationStructure = VK_TRUE;
  features.ray_query.rayQuery = VK_TRUE;

  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = abilities.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features.core;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  if (ray_query) {
    info.enabledExtensionCount = static_cast<std::uint32_t>(ray_query_extensions.size());
    info.ppEnabledExtensionNames = ray_query_extensions.data();
  }
  check(vkCreateDevice(physical, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, abilities.queue_family, 0, &queue_);
}

Device::~Device() {
  vkDeviceWaitIdle(device_);
  vkDestroyDevice(device_, nullptr);
}

bool Device::has_memory_type(VkMemoryPropertyFlags wanted) const {
  for (std::uint32_t t = 0; t < memory_.memoryTypeCount; ++t)
    if ((memory_.memoryTypes[t].propertyFlags & wanted) == wanted) return true;
  return false;
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  for (std::uint32_t t = 0; t < memory_.memoryTypeCount; ++t)
    if ((allowed & (1u << t)) && (memory_.memoryTypes[t].propertyFlags & wanted) == wanted) return t;
  throw Error(Errc::out_of_memory,
              "the Vulkan device " + abilities_.name + " has no memory of the kind that a buffer needs");
}

void Device::name(VkObjectType type, std::uint64_t handle, const char* name) const {
  if (!vkSetDebugUtilsObjectNameEXT) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, handle, name};
  vkSetDebugUtilsObjectNameEXT(device_, &info);
}

}  // namespace vantage::vulkan
