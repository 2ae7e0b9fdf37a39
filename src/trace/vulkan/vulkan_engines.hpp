// SPDX-License-Identifier: Apache-2.0
// Lists engines on devices, and makes their tracers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trace/rays/ray_finder.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage {

using VulkanEngines = std::span<const vulkan::VulkanEngine* const>;

// Lists each engine on every device of this machine, usable or not, with the reason. Without Vulkan, one entry for each
// engine, without a device, says why. A missing device is no error.
std::vector<EngineInfo> list_vulkan_engines(VulkanEngines engines);

// Returns the memory of a device that this process may still allocate, by VK_EXT_memory_budget; without that extension,
// all of it. Empty if unknown.
std::optional<std::uint64_t> free_device_memory(std::uint32_t device);

// Without `device`, takes the best one that has what the engine needs, hardware before software. Throws Error
// no_suitable_device with the reason for each refusal.
std::unique_ptr<Tracer> make_vulkan_tracer(const vulkan::VulkanEngine& engine, std::optional<std::uint32_t> device,
                                           const TraceScene& scene);
// Makes a finder for a caller's own rays in the same way. REQUIRES: a scene with triangles.
std::unique_ptr<RayFinder> make_vulkan_ray_finder(const vulkan::VulkanEngine& engine,
                                                  std::optional<std::uint32_t> device, const SceneData& scene);

}  // namespace vantage
