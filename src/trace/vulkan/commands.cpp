// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/commands.hpp"

#include <algorithm>
#include <array>

#include "trace/vulkan/check.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {
namespace {

constexpr VkDeviceSize kStagingBytes = VkDeviceSize{32} << 20;
// Submissions take about a second; even a large structure takes a software device a minute at most.
constexpr std::uint64_t kWait_ns = 10'000'000'000;
constexpr int kMostWaits = 60;

}  // namespace

Commands::Commands(Device& device) : device_(device) {
  const VolkDeviceTable& vk = device.vk();
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool_info.queueFamilyIndex = device.abilities().queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vk.vkCreateCommandPool(device.handle(), &pool_info, nullptr, &pool), "vkCreateCommandPool");
  pool_ = UniqueCommandPool(device, pool);
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                       VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vk.vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "vkAllocateCommandBuffers");
  VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
  VkFence fence = VK_NULL_HANDLE;
  check(vk.vkCreateFence(device.handle(), &fence_info, nullptr, &fence), "vkCreateFence");
  fence_ = UniqueFence(device, fence);
  VkQueryPoolCreateInfo queries{};
  queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = 2;
  VkQueryPool query_pool = VK_NULL_HANDLE;
  check(vk.vkCreateQueryPool(device.handle(), &queries, nullptr, &query_pool), "vkCreateQueryPool");
  timestamps_ = UniqueQueryPool(device, query_pool);
}

double Commands::run(const Record& record) {
  const VolkDeviceTable& vk = device_.vk();
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vk.vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
  vk.vkCmdResetQueryPool(commands_, timestamps_.get(), 0, 2);
  vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_.get(), 0);
  const Recorder recorder(vk, commands_);
  try {
    record(recorder);
  } catch (...) {
    vk.vkResetCommandBuffer(commands_, 0);
    throw;
  }
  // Makes all writes visible to a host that reads mapped memory, and to the next submission.
  recorder.anyone_after_anyone();
  vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(), 1);
  check(vk.vkEndCommandBuffer(commands_), "vkEndCommandBuffer");

  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  check(vk.vkQueueSubmit(device_.queue(), 1, &submit, fence_.get()), "vkQueueSubmit");
  wait();
  const VkFence fence = fence_.get();
  check(vk.vkResetFences(device_.handle(), 1, &fence), "vkResetFences");
  device_.instance().check_validation();

  std::array<std::uint64_t, 2> ticks{};
  check(vk.vkGetQueryPoolResults(device_.handle(), timestamps_.get(), 0, 2, sizeof ticks, ticks.data(), sizeof ticks[0],
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  return static_cast<double>(ticks[1] - ticks[0]) * device_.timestamp_period_ns() * 1e-9;
}

void Commands::wait() {
  const VolkDeviceTable& vk = device_.vk();
  const VkFence fence = fence_.get();
  VkResult result = VK_TIMEOUT;
  for (int k = 0; k < kMostWaits && result == VK_TIMEOUT; ++k)
    result = vk.vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, kWait_ns);
  if (result == VK_TIMEOUT) {
    device_.give_up();
    throw Error(Errc::device_failure,
                "the Vulkan device " + device_.abilities().name +
                    " hangs: work of seconds has not ended after ten minutes. Start again on another "
                    "device, or with the engine embree");
  }
  // Pending work must end before its buffers are destroyed.
  if (result != VK_SUCCESS) vk.vkDeviceWaitIdle(device_.handle());
  check(result, "vkWaitForFences");
}

double Commands::run_and_download(const Record& record, std::span<const Download> wanted) {
  VkDeviceSize bytes = 0;
  for (const Download& d : wanted) bytes += d.bytes;
  if (bytes > kStagingBytes) {
    const double seconds = run(record);
    for (const Download& d : wanted) download(d.from, d.to, d.bytes);
    return seconds;
  }
  if (!staging_down_ || staging_down_.size() < bytes)
    staging_down_ = Buffer(device_, bytes, Buffer::Where::download, "staging down");
  const double seconds = run([&](const Recorder& r) {
    record(r);
    r.shader_after_shader();
    VkDeviceSize at = 0;
    for (const Download& d : wanted) {
      if (d.bytes == 0) continue;
      r.copy(d.from, staging_down_, {0, at, d.bytes});
      at += d.bytes;
    }
  });
  VkDeviceSize at = 0;
  for (const Download& d : wanted) {
    if (d.bytes == 0) continue;
    std::memcpy(d.to, staging_down_.mapped<std::byte>() + at, d.bytes);
    at += d.bytes;
  }
  return seconds;
}

void Commands::stage(VkDeviceSize bytes) {
  const VkDeviceSize wanted = std::min(bytes, kStagingBytes);
  if (!staging_up_ || staging_up_.size() < wanted)
    staging_up_ = Buffer(device_, wanted, Buffer::Where::upload, "staging up");
}

void Commands::upload(const Buffer& to, const void* data, VkDeviceSize bytes, VkDeviceSize offset) {
  if (bytes == 0) return;
  uploaded_bytes_ += bytes;
  stage(bytes);
  for (VkDeviceSize done = 0; done < bytes; done += staging_up_.size()) {
    const VkDeviceSize part = std::min(staging_up_.size(), bytes - done);
    std::memcpy(staging_up_.mapped<void>(), static_cast<const std::byte*>(data) + done, part);
    run([&](const Recorder& r) { r.copy(staging_up_, to, {0, offset + done, part}); });
  }
}

void Commands::scatter(const Buffer& to, const void* values, VkDeviceSize size, std::span<const std::uint32_t> at) {
  if (at.empty()) return;
  uploaded_bytes_ += at.size() * size;
  stage(at.size() * size);
  const std::size_t at_once = staging_up_.size() / size;
  for (std::size_t done = 0; done < at.size(); done += at_once) {
    const std::size_t part = std::min(at_once, at.size() - done);
    std::memcpy(staging_up_.mapped<void>(), static_cast<const std::byte*>(values) + done * size, part * size);
    run([&](const Recorder& r) {
      for (std::size_t first = 0, end = 0; first < part; first = end) {
        for (end = first + 1; end < part && at[done + end] == at[done + end - 1] + 1;) ++end;
        r.copy(staging_up_, to, {first * size, at[done + first] * size, (end - first) * size});
      }
    });
  }
}

void Commands::download(const Buffer& from, void* data, VkDeviceSize bytes, VkDeviceSize offset) {
  if (bytes == 0) return;
  const VkDeviceSize wanted = std::min(bytes, kStagingBytes);
  if (!staging_down_ || staging_down_.size() < wanted)
    staging_down_ = Buffer(device_, wanted, Buffer::Where::download, "staging down");
  for (VkDeviceSize done = 0; done < bytes; done += staging_down_.size()) {
    const VkDeviceSize part = std::min(staging_down_.size(), bytes - done);
    run([&](const Recorder& r) { r.copy(from, staging_down_, {offset + done, 0, part}); });
    std::memcpy(static_cast<std::byte*>(data) + done, staging_down_.mapped<void>(), part);
  }
}

}  // namespace vantage::vulkan
