// SPDX-License-Identifier: Apache-2.0
// A Vulkan layer that makes one call fail, and counts objects made and destroyed. Khronos' Loader and Layer Interface
// says how a layer is called. It sits above the validation layer, which thus never sees a failed call.
#include "faults/fault_layer.hpp"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>
#include <thread>

#define EXPORTED extern "C" __attribute__((visibility("default")))

namespace {

using vantage::test::Fault;
using vantage::test::FaultControl;

constexpr std::size_t faults = static_cast<std::size_t>(Fault::late) + 1;

struct Layer {
  std::mutex mutex;
  // Fetched when an instance is made: later the loader returns the top of its chain.
  struct Instance {
    PFN_vkGetInstanceProcAddr get;
    PFN_vkDestroyInstance destroy;
    PFN_vkEnumeratePhysicalDevices enumerate;
  };
  std::map<void*, Instance> instances;  // by dispatch key
  struct Device {
    VkDevice handle;
    PFN_vkGetDeviceProcAddr get;
  };
  std::map<void*, Device> devices;  // its queues and command buffers have its key
  Fault fault = Fault::none;
  std::uint64_t call = 0;
  std::array<std::uint64_t, faults> calls{};
  const char* struck = nullptr;
  std::map<void*, bool> lost;  // devices by dispatch key
  bool hangs = false, gone = false;
  std::uint64_t limit = 0, bytes = 0, peak = 0, dispatches = 0;
  std::map<VkDeviceMemory, std::uint64_t> sizes;
  std::int64_t alive = 0;
  double slow = 1;
};

Layer& layer() {
  static Layer& kept = *new Layer;  // drivers call it until the very end
  return kept;
}

template <class Handle>
void* key_of(Handle handle) {
  return *reinterpret_cast<void**>(handle);
}

template <class Function, class Handle>
Function next(Handle handle, const char* name) {
  const std::lock_guard lock(layer().mutex);
  const Layer::Device& device = layer().devices.at(key_of(handle));
  return reinterpret_cast<Function>(device.get(device.handle, name));
}

// Faults that a call can meet.
enum Can : unsigned { memory = 1, lose = 2, wait = 4 };

// Counts a call; returns its fault's result, or VK_SUCCESS to make the call.
VkResult strike(void* device, const char* name, unsigned can) {
  Layer& l = layer();
  std::unique_lock lock(l.mutex);
  const auto meets = [&](Fault fault, bool possible) {
    return possible && l.calls[static_cast<std::size_t>(fault)]++ == l.call && l.fault == fault;
  };
  const bool gone = meets(Fault::gone, true), lost = meets(Fault::lost, true) || gone, late = meets(Fault::late, true);
  const bool device_memory = meets(Fault::device_memory, can & memory),
             host_memory = meets(Fault::host_memory, can & memory);
  const bool timeout = meets(Fault::timeout, can & wait), hang = meets(Fault::hang, can & wait);
  if (lost || late || device_memory || host_memory || timeout || hang) l.struck = name;
  if (lost) l.lost[device] = true;
  l.hangs |= hang, l.gone |= gone;
  if (late) {
    lock.unlock();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return VK_SUCCESS;
  }
  if ((can & lose) && (l.gone || l.lost.contains(device))) return VK_ERROR_DEVICE_LOST;
  if (timeout || (l.hangs && (can & wait))) return VK_TIMEOUT;
  if (device_memory) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  if (host_memory) return VK_ERROR_OUT_OF_HOST_MEMORY;
  return VK_SUCCESS;
}

void made(VkResult result, std::int64_t many = 1) {
  if (result != VK_SUCCESS) return;
  const std::lock_guard lock(layer().mutex);
  layer().alive += many;
}

// Calls on a device that return VkResult.
#define PASS(name, can, parameters, ...)                                            \
  VKAPI_ATTR VkResult VKAPI_CALL name parameters {                                  \
    const VkResult struck = strike(key_of(self), #name, can);                       \
    if (struck != VK_SUCCESS) {                                                     \
      /* a lost device works no more, so that what it worked on may be destroyed */ \
      if (struck == VK_ERROR_DEVICE_LOST) idle(self);                               \
      return struck;                                                                \
    }                                                                               \
    return next<PFN_##name>(self, #name)(__VA_ARGS__);                              \
  }
// Calls that also make objects.
#define MAKE(name, parameters, ...)                                     \
  VKAPI_ATTR VkResult VKAPI_CALL name parameters {                      \
    const VkResult struck = strike(key_of(self), #name, memory);        \
    if (struck != VK_SUCCESS) return struck;                            \
    const VkResult result = next<PFN_##name>(self, #name)(__VA_ARGS__); \
    made(result);                                                       \
    return result;                                                      \
  }
#define DESTROY(name, Handle)                                                                             \
  VKAPI_ATTR void VKAPI_CALL name(VkDevice self, Handle handle, const VkAllocationCallbacks* callbacks) { \
    if (handle) made(VK_SUCCESS, -1);                                                                     \
    next<PFN_##name>(self, #name)(self, handle, callbacks);                                               \
  }
#define MAKE_ONE(name, Info, Handle)                                                                             \
  MAKE(name, (VkDevice self, const Info* info, const VkAllocationCallbacks* callbacks, Handle* out), self, info, \
       callbacks, out)

void idle(VkDevice device) { next<PFN_vkDeviceWaitIdle>(device, "vkDeviceWaitIdle")(device); }
void idle(VkQueue queue) { next<PFN_vkQueueWaitIdle>(queue, "vkQueueWaitIdle")(queue); }
void idle(VkCommandBuffer) {}

MAKE_ONE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
MAKE_ONE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
MAKE_ONE(vkCreateFence, VkFenceCreateInfo, VkFence)
MAKE_ONE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
MAKE_ONE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
MAKE_ONE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
MAKE_ONE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
MAKE_ONE(vkCreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
MAKE_ONE(vkCreateAccelerationStructureKHR, VkAccelerationStructureCreateInfoKHR, VkAccelerationStructureKHR)
MAKE(vkCreateComputePipelines,
     (VkDevice self, VkPipelineCache cache, std::uint32_t count, const VkComputePipelineCreateInfo* infos,
      const VkAllocationCallbacks* callbacks, VkPipeline* out),
     self, cache, count, infos, callbacks, out)

DESTROY(vkDestroyBuffer, VkBuffer)
DESTROY(vkDestroyCommandPool, VkCommandPool)
DESTROY(vkDestroyFence, VkFence)
DESTROY(vkDestroyQueryPool, VkQueryPool)
DESTROY(vkDestroyShaderModule, VkShaderModule)
DESTROY(vkDestroyPipelineLayout, VkPipelineLayout)
DESTROY(vkDestroyDescriptorSetLayout, VkDescriptorSetLayout)
DESTROY(vkDestroyDescriptorPool, VkDescriptorPool)
DESTROY(vkDestroyAccelerationStructureKHR, VkAccelerationStructureKHR)
DESTROY(vkDestroyPipeline, VkPipeline)

// Command buffers and sets are freed with their pools.
PASS(vkAllocateCommandBuffers, memory, (VkDevice self, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* out),
     self, info, out)
PASS(vkAllocateDescriptorSets, memory, (VkDevice self, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* out),
     self, info, out)
PASS(vkBindBufferMemory, memory, (VkDevice self, VkBuffer buffer, VkDeviceMemory bound, VkDeviceSize offset), self,
     buffer, bound, offset)
PASS(vkMapMemory, memory,
     (VkDevice self, VkDeviceMemory mapped, VkDeviceSize offset, VkDeviceSize size, VkMemoryMapFlags flags, void** out),
     self, mapped, offset, size, flags, out)
PASS(vkBeginCommandBuffer, memory, (VkCommandBuffer self, const VkCommandBufferBeginInfo* info), self, info)
PASS(vkEndCommandBuffer, memory, (VkCommandBuffer self), self)
PASS(vkQueueSubmit, memory | lose, (VkQueue self, std::uint32_t count, const VkSubmitInfo* infos, VkFence fence), self,
     count, infos, fence)
PASS(vkWaitForFences, memory | lose | wait,
     (VkDevice self, std::uint32_t count, const VkFence* fences, VkBool32 all, std::uint64_t timeout), self, count,
     fences, all, timeout)
PASS(vkResetFences, memory, (VkDevice self, std::uint32_t count, const VkFence* fences), self, count, fences)
PASS(vkDeviceWaitIdle, memory | lose, (VkDevice self), self)

VKAPI_ATTR VkResult VKAPI_CALL vkGetQueryPoolResults(VkDevice self, VkQueryPool pool, std::uint32_t first,
                                                     std::uint32_t count, std::size_t size, void* data,
                                                     VkDeviceSize stride, VkQueryResultFlags flags) {
  const VkResult struck = strike(key_of(self), "vkGetQueryPoolResults", memory | lose);
  if (struck != VK_SUCCESS) return struck;
  const VkResult result = next<PFN_vkGetQueryPoolResults>(self, "vkGetQueryPoolResults")(self, pool, first, count, size,
                                                                                         data, stride, flags);
  if (result == VK_SUCCESS && count == 2 && (flags & VK_QUERY_RESULT_64_BIT)) {
    auto* const ticks = static_cast<std::uint64_t*>(data);
    const std::lock_guard lock(layer().mutex);
    ticks[1] = ticks[0] + static_cast<std::uint64_t>(static_cast<double>(ticks[1] - ticks[0]) * layer().slow);
  }
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice self, const VkMemoryAllocateInfo* info,
                                                const VkAllocationCallbacks* callbacks, VkDeviceMemory* out) {
  const VkResult struck = strike(key_of(self), "vkAllocateMemory", memory);
  if (struck != VK_SUCCESS) return struck;
  {
    Layer& l = layer();
    const std::lock_guard lock(l.mutex);
    if (l.limit > 0 && l.bytes + info->allocationSize > l.limit) {
      l.struck = "vkAllocateMemory";
      return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
  }
  const VkResult result = next<PFN_vkAllocateMemory>(self, "vkAllocateMemory")(self, info, callbacks, out);
  if (result != VK_SUCCESS) return result;
  Layer& l = layer();
  const std::lock_guard lock(l.mutex);
  ++l.alive;
  l.sizes[*out] = info->allocationSize;
  l.bytes += info->allocationSize;
  l.peak = std::max(l.peak, l.bytes);
  return result;
}

VKAPI_ATTR void VKAPI_CALL vkFreeMemory(VkDevice self, VkDeviceMemory freed, const VkAllocationCallbacks* callbacks) {
  if (freed) {
    Layer& l = layer();
    const std::lock_guard lock(l.mutex);
    --l.alive;
    l.bytes -= l.sizes.at(freed);
    l.sizes.erase(freed);
  }
  next<PFN_vkFreeMemory>(self, "vkFreeMemory")(self, freed, callbacks);
}

void count_dispatch() {
  const std::lock_guard lock(layer().mutex);
  ++layer().dispatches;
}
VKAPI_ATTR void VKAPI_CALL vkCmdDispatch(VkCommandBuffer self, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  count_dispatch();
  next<PFN_vkCmdDispatch>(self, "vkCmdDispatch")(self, x, y, z);
}
VKAPI_ATTR void VKAPI_CALL vkCmdDispatchIndirect(VkCommandBuffer self, VkBuffer buffer, VkDeviceSize offset) {
  count_dispatch();
  next<PFN_vkCmdDispatchIndirect>(self, "vkCmdDispatchIndirect")(self, buffer, offset);
}

VKAPI_ATTR void VKAPI_CALL vkDestroyDevice(VkDevice self, const VkAllocationCallbacks* callbacks) {
  const auto destroy = next<PFN_vkDestroyDevice>(self, "vkDestroyDevice");
  {
    const std::lock_guard lock(layer().mutex);
    --layer().alive;
    layer().lost.erase(key_of(self));
    layer().devices.erase(key_of(self));
  }
  destroy(self, callbacks);
}

// Takes this layer's link out of the loader's chain.
template <class Info>
Info* link(const void* chain, VkStructureType type) {
  for (auto* each = static_cast<const VkBaseInStructure*>(chain); each; each = each->pNext)
    if (each->sType == type) {
      auto* const info = const_cast<Info*>(reinterpret_cast<const Info*>(each));
      if (info->function == VK_LAYER_LINK_INFO) return info;
    }
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice self, const VkDeviceCreateInfo* info,
                                              const VkAllocationCallbacks* callbacks, VkDevice* out) {
  const VkResult struck = strike(nullptr, "vkCreateDevice", memory | lose);
  {
    const std::lock_guard lock(layer().mutex);
    layer().lost.erase(nullptr);
  }
  if (struck != VK_SUCCESS) return struck;
  auto* const chain = link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  const auto get_instance = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  const auto get_device = chain->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(get_instance(VK_NULL_HANDLE, "vkCreateDevice"));
  const VkResult result = create(self, info, callbacks, out);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard lock(layer().mutex);
  layer().devices[key_of(*out)] = {*out, get_device};
  layer().lost.erase(key_of(*out));
  ++layer().alive;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkEnumeratePhysicalDevices(VkInstance self, std::uint32_t* count,
                                                          VkPhysicalDevice* out) {
  const VkResult struck = strike(nullptr, "vkEnumeratePhysicalDevices", memory);
  if (struck != VK_SUCCESS) return struck;
  PFN_vkEnumeratePhysicalDevices enumerate;
  {
    const std::lock_guard lock(layer().mutex);
    enumerate = layer().instances.at(key_of(self)).enumerate;
  }
  return enumerate(self, count, out);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateInstance(const VkInstanceCreateInfo* info,
                                                const VkAllocationCallbacks* callbacks, VkInstance* out) {
  const VkResult struck = strike(nullptr, "vkCreateInstance", memory);
  if (struck != VK_SUCCESS) return struck;
  auto* const chain = link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  const auto get = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, callbacks, out);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard lock(layer().mutex);
  layer().instances[key_of(*out)] = {
      get, reinterpret_cast<PFN_vkDestroyInstance>(get(*out, "vkDestroyInstance")),
      reinterpret_cast<PFN_vkEnumeratePhysicalDevices>(get(*out, "vkEnumeratePhysicalDevices"))};
  ++layer().alive;
  return result;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyInstance(VkInstance self, const VkAllocationCallbacks* callbacks) {
  PFN_vkDestroyInstance destroy;
  {
    const std::lock_guard lock(layer().mutex);
    destroy = layer().instances.at(key_of(self)).destroy;
    layer().instances.erase(key_of(self));
    --layer().alive;
  }
  destroy(self, callbacks);
}

PFN_vkVoidFunction own(std::string_view name) {
#define OWN(function) \
  if (name == #function) return reinterpret_cast<PFN_vkVoidFunction>(&function);
  OWN(vkCreateBuffer)
  OWN(vkCreateCommandPool)
  OWN(vkCreateFence)
  OWN(vkCreateQueryPool)
  OWN(vkCreateShaderModule)
  OWN(vkCreatePipelineLayout)
  OWN(vkCreateDescriptorSetLayout)
  OWN(vkCreateDescriptorPool)
  OWN(vkCreateAccelerationStructureKHR)
  OWN(vkCreateComputePipelines)
  OWN(vkDestroyBuffer)
  OWN(vkDestroyCommandPool)
  OWN(vkDestroyFence)
  OWN(vkDestroyQueryPool)
  OWN(vkDestroyShaderModule)
  OWN(vkDestroyPipelineLayout)
  OWN(vkDestroyDescriptorSetLayout)
  OWN(vkDestroyDescriptorPool)
  OWN(vkDestroyAccelerationStructureKHR)
  OWN(vkDestroyPipeline)
  OWN(vkAllocateCommandBuffers)
  OWN(vkAllocateDescriptorSets)
  OWN(vkBindBufferMemory)
  OWN(vkMapMemory)
  OWN(vkBeginCommandBuffer)
  OWN(vkEndCommandBuffer)
  OWN(vkQueueSubmit)
  OWN(vkWaitForFences)
  OWN(vkResetFences)
  OWN(vkDeviceWaitIdle)
  OWN(vkGetQueryPoolResults)
  OWN(vkAllocateMemory)
  OWN(vkFreeMemory)
  OWN(vkCmdDispatch)
  OWN(vkCmdDispatchIndirect)
  OWN(vkDestroyDevice)
  return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name) {
  if (const auto function = own(name)) return function;
  if (std::string_view(name) == "vkGetDeviceProcAddr")
    return reinterpret_cast<PFN_vkVoidFunction>(&get_device_function);
  return next<PFN_vkVoidFunction>(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* text) {
  const std::string_view name = text;
  OWN(vkCreateInstance)
  OWN(vkDestroyInstance)
  OWN(vkEnumeratePhysicalDevices)
  OWN(vkCreateDevice)
#undef OWN
  if (name == "vkGetInstanceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(&get_instance_function);
  if (name == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(&get_device_function);
  if (const auto function = own(name)) return function;
  if (!instance) return nullptr;
  const std::lock_guard lock(layer().mutex);
  return layer().instances.at(key_of(instance)).get(instance, text);
}

void arm(Fault fault, std::uint64_t call) {
  Layer& l = layer();
  const std::lock_guard lock(l.mutex);
  l.fault = fault, l.call = call;
  l.calls.fill(0);
  l.struck = nullptr, l.hangs = l.gone = false;
  l.peak = l.bytes, l.dispatches = 0;
}

constexpr FaultControl control{
    .arm = arm,
    .calls = [](Fault fault) { return layer().calls[static_cast<std::size_t>(fault)]; },
    .struck = [] { return layer().struck; },
    .limit = [](std::uint64_t bytes) { layer().limit = bytes; },
    .peak_bytes = [] { return layer().peak; },
    .slow_down = [](double factor) { layer().slow = factor; },
    .dispatches = [] { return layer().dispatches; },
    .alive = [] { return layer().alive; },
};

}  // namespace

EXPORTED const FaultControl* vantage_fault_layer() { return &control; }

EXPORTED VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
  interface->loaderLayerInterfaceVersion = std::min(interface->loaderLayerInterfaceVersion, 2u);
  interface->pfnGetInstanceProcAddr = get_instance_function;
  interface->pfnGetDeviceProcAddr = get_device_function;
  interface->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
