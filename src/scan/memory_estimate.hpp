// SPDX-License-Identifier: Apache-2.0
// Memory is known before it is spent.
#pragma once

#include <cstdint>
#include <span>

#include "vantage/simulator.hpp"

namespace vantage {

// For a scanner's pattern and the engine that `config` comes to; of several devices, the one that takes most.
struct SimulatorMemory {
  std::uint64_t voxels = 0;        // surveyed ones, about
  std::uint64_t bytes = 0;         // of the whole process, at most at once; with a software device's
  std::uint64_t device_bytes = 0;  // of a device, likewise; a software device's are in `bytes` too
};
SimulatorMemory simulator_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config,
                                 std::size_t stations);

// Throws Error out_of_memory, with the numbers and the user size that would fit, where the estimate is above
// `config.max_memory_bytes`, or without one above half of what is free on the host, or all that is on a device.
void require_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config);

}  // namespace vantage
