// SPDX-License-Identifier: Apache-2.0
// Buffers that shaders access by address, and transfers between host and device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "trace/vulkan/device.hpp"
#include "trace/vulkan/unique.hpp"

namespace vantage::vulkan {

// A buffer with its own memory. Every buffer has an address, so that no descriptor's range limits it.
class Buffer {
 public:
  enum class Where {
    device,    // fastest for shaders; filled by copies
    upload,    // mapped, written by the host
    download,  // mapped, read by the host
  };
  Buffer() = default;
  // size 0 becomes 16 bytes, so that every array has an address.
  Buffer(const Device& device, VkDeviceSize size, Where where, const char* name, VkBufferUsageFlags extra = 0);

  VkBuffer handle() const { return buffer_.get(); }
  VkDeviceSize size() const { return size_; }
  VkDeviceAddress address() const { return address_; }
  explicit operator bool() const { return static_cast<bool>(buffer_); }
  template <class T>
  T* mapped() const {
    return static_cast<T*>(mapped_);
  }

 private:
  VkDeviceSize size_ = 0;
  VkDeviceAddress address_ = 0;
  void* mapped_ = nullptr;
  UniqueMemory memory_;
  UniqueBuffer buffer_;
};

}  // namespace vantage::vulkan
