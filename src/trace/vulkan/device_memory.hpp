// SPDX-License-Identifier: Apache-2.0
// Estimates a Vulkan engine's device memory before any is allocated, without Vulkan.
#pragma once

#include <cstdint>

#include "vantage/trace.hpp"

namespace vantage::vulkan {

struct DeviceLoad {
  Engine engine = Engine::compute_bvh;
  bool software = false;
  double vertices = 0, triangles = 0;  // as stored: those of shared meshes once
  double runs = 0;                     // of triangles, if meshes are shared (SceneData::instances)
  double voxels = 0, bricks = 0;
  std::uint32_t rows = 0, columns = 0;  // of the scanner's pattern
  std::uint32_t stations = 0;           // per network
  bool shaded = false;                  // noise or limits, which read the triangle that was hit
  bool normals = false;                 // vertices have normals
  double glass = 0;                     // of the triangles, those of glass that weakens echoes
};

// Peak memory in bytes: while the structure is built, or with all buffers of an exact evaluation and a sample. Large
// sampled populations use more memory if available; otherwise they are counted in parts.
double device_bytes(const DeviceLoad& load);

}  // namespace vantage::vulkan
