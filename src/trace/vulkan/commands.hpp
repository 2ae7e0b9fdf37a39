// SPDX-License-Identifier: Apache-2.0
// Records and submits work: one command buffer, one submission per batch, one fence.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "trace/vulkan/buffer.hpp"
#include "trace/vulkan/device.hpp"
#include "trace/vulkan/recorder.hpp"
#include "trace/vulkan/unique.hpp"

namespace vantage::vulkan {

class Commands {
 public:
  explicit Commands(Device& device);

  // Records by calling `record`, submits and waits. Returns the seconds spent on the device. Throws Error
  // device_failure, also for reports of the validation layer.
  using Record = std::function<void(const Recorder&)>;
  double run(const Record& record);

  // Does the same, and reads buffers back in the same submission, after `record`'s work.
  struct Download {
    const Buffer& from;
    void* to;
    VkDeviceSize bytes;
  };
  double run_and_download(const Record& record, std::span<const Download> wanted);

  // Copies host memory into a device buffer, and back, through mapped buffers of bounded size.
  void upload(const Buffer& to, const void* data, VkDeviceSize bytes, VkDeviceSize offset = 0);
  // Copies `values` to the ascending elements `at` of a buffer, in few submissions whatever their number.
  template <class T>
  void scatter(const Buffer& to, std::span<const T> values, std::span<const std::uint32_t> at) {
    static_assert(std::is_trivially_copyable_v<T>);
    scatter(to, values.data(), sizeof(T), at);
  }
  std::uint64_t uploaded_bytes() const { return uploaded_bytes_; }
  void download(const Buffer& from, void* data, VkDeviceSize bytes, VkDeviceSize offset = 0);

 private:
  void wait();
  void scatter(const Buffer& to, const void* values, VkDeviceSize size, std::span<const std::uint32_t> at);
  void stage(VkDeviceSize bytes);

  Device& device_;
  UniqueCommandPool pool_;
  UniqueFence fence_;
  UniqueQueryPool timestamps_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Buffer staging_up_, staging_down_;
  std::uint64_t uploaded_bytes_ = 0;
};

// Makes a device buffer that holds `values`.
template <class T>
Buffer make_device_buffer(Device& device, Commands& commands, std::span<const T> values, const char* name,
                          VkBufferUsageFlags extra = 0) {
  static_assert(std::is_trivially_copyable_v<T>);
  Buffer buffer(device, values.size_bytes(), Buffer::Where::device, name, extra);
  commands.upload(buffer, values.data(), values.size_bytes());
  return buffer;
}

}  // namespace vantage::vulkan
