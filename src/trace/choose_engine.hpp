// SPDX-License-Identifier: Apache-2.0
// Resolves `automatic` to an engine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/trace.hpp"

namespace vantage {

// Returns the index of the default engine: a hardware GPU with ray queries, else one with our own BVH, else the CPU.
// If a device is given, it is the first usable Vulkan engine on that. REQUIRES: embree is listed.
std::size_t default_engine(const std::vector<EngineInfo>& engines,
                           std::optional<std::uint32_t> device_index = std::nullopt);

}  // namespace vantage
