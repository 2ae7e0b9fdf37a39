// SPDX-License-Identifier: Apache-2.0
// From engines and devices to tracers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trace/tracer.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage {

using VulkanEngines = std::span<const vulkan::VulkanEngine* const>;

// Each engine on every device of this machine, usable or not, with the reason. Where there is no Vulkan at all, one
// entry an engine without a device says why. Never throws for want of a device.
std::vector<EngineInfo> list_vulkan_engines(VulkanEngines engines);

// What the driver says that this process may still take of a device's own memory, by VK_EXT_memory_budget, or all of
// it; nothing where that cannot be told.
std::optional<std::uint64_t> free_device_memory(std::uint32_t device);

// Without `device` the best one that has what the engine needs: hardware before software.
// Throws Error no_suitable_device with why each device was refused.
std::unique_ptr<Tracer> make_vulkan_tracer(const vulkan::VulkanEngine& engine, std::optional<std::uint32_t> device,
                                           const TraceScene& scene);

}  // namespace vantage
