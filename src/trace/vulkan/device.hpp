// SPDX-License-Identifier: Apache-2.0
// Logical device of an engine.
#pragma once

#include <cstdint>
#include <memory>

#include "trace/vulkan/abilities.hpp"

namespace vantage::vulkan {

// A logical device with one compute queue.
class Device {
 public:
  // REQUIRES: the abilities lack nothing of the needs.
  Device(std::shared_ptr<Instance> instance, VkPhysicalDevice physical, const DeviceAbilities& abilities,
         DeviceNeeds needs);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  const VolkDeviceTable& vk() const { return vk_; }  // functions of the device itself
  VkQueue queue() const { return queue_; }
  const DeviceAbilities& abilities() const { return abilities_; }
  Instance& instance() const { return *instance_; }
  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;  // throws Error out_of_memory
  bool has_memory_type(VkMemoryPropertyFlags wanted) const;
  VkDeviceSize scratch_alignment() const { return scratch_alignment_; }
  double timestamp_period_ns() const { return timestamp_period_ns_; }
  // Marks a hanging device: from then on none of its objects is destroyed, since none can be.
  void give_up() { given_up_ = true; }
  bool given_up() const { return given_up_; }
  void name(VkObjectType type, std::uint64_t handle, const char* name) const;  // for debuggers and validation messages

 private:
  std::shared_ptr<Instance> instance_;
  DeviceAbilities abilities_;
  VkPhysicalDeviceMemoryProperties memory_{};
  VkDeviceSize scratch_alignment_ = 1;
  double timestamp_period_ns_ = 1;
  VkDevice device_ = VK_NULL_HANDLE;
  VolkDeviceTable vk_{};
  VkQueue queue_ = VK_NULL_HANDLE;
  bool given_up_ = false;
};

}  // namespace vantage::vulkan
