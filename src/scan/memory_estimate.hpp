// SPDX-License-Identifier: Apache-2.0
// Memory, estimated before it is allocated.
#pragma once

#include <cstdint>
#include <span>

#include "scene/scene_data.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Memory for a scanner's pattern and the engine that `config` resolves to; of several devices, the most demanding one.
struct SimulatorMemory {
  std::uint64_t voxels = 0;        // approximate number of surveyed voxels
  std::uint64_t bytes = 0;         // peak of the whole process, including a software device's memory
  std::uint64_t device_bytes = 0;  // peak of a device; a software device's are in `bytes`, too
};
SimulatorMemory simulator_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config,
                                 std::size_t stations);

// Returns the estimate. Throws Error out_of_memory, with the numbers and the user size that would fit, if it exceeds
// `config.max_memory_bytes`. Without such a limit, it may take half of the host's free memory and all free memory of a
// device.
SimulatorMemory require_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config);

// Bounds the bytes that some meshes take beside the rest of a scene, on the CPU engine.
std::uint64_t bytes_of_meshes(const SceneData& scene, std::span<const MeshRange> meshes, double voxel_size_m);

}  // namespace vantage
