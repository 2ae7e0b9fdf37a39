// SPDX-License-Identifier: Apache-2.0
// Coverage's demands on voxels, of all or of a sample, on the device.
#pragma once

#include <cstdint>
#include <span>

#include "trace/vulkan/buffer.hpp"
#include "trace/vulkan/commands.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage::vulkan {

// Addresses; null if all voxels are alike.
struct DemandAddresses {
  std::uint64_t weights = 0, point_weights = 0;
};

struct DeviceDemands {
  Buffer weights, point_weights;

  DemandAddresses addresses() const {
    return {weights ? weights.address() : 0, point_weights ? point_weights.address() : 0};
  }
};

inline DeviceDemands make_device_demands(Device& device, Commands& commands, VoxelDemands demands) {
  DeviceDemands made;
  demands.weights.resize((demands.weights.size() + 3) / 4 * 4);  // whole words, as shaders read them
  if (!demands.weights.empty())
    made.weights = make_device_buffer<std::uint8_t>(device, commands, demands.weights, "voxel weights");
  if (!demands.point_weights.empty())
    made.point_weights = make_device_buffer<std::uint32_t>(device, commands, demands.point_weights, "point weights");
  return made;
}

}  // namespace vantage::vulkan
