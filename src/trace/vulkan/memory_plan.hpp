// SPDX-License-Identifier: Apache-2.0
// What a Vulkan engine takes of its device's memory, told before any of it is taken, and without Vulkan.
#pragma once

#include <cstdint>

#include "vantage/trace.hpp"

namespace vantage::vulkan {

struct DeviceLoad {
  Engine engine = Engine::compute_bvh;
  bool software = false;
  double vertices = 0, triangles = 0, voxels = 0, bricks = 0;
  std::uint32_t rows = 0, columns = 0;  // of the scanner's pattern
  std::uint32_t stations = 0;           // of a network
  bool shaded = false;                  // noise or limits, which look at the triangle that was hit
  bool normals = false;                 // vertices have them
};

// Bytes at most at once: while the structure is built, or with all that an exact evaluation and a sample take. Many
// networks sampled at once take more where there is more, and are counted in parts where there is not.
double device_bytes(const DeviceLoad& load);

}  // namespace vantage::vulkan
