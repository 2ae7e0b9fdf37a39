// SPDX-License-Identifier: Apache-2.0
// The two Vulkan engines. They share every shader line but trace().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage {

// ray_query and compute_bvh on every device of this machine, usable or not, each with the reason. Where there is no
// Vulkan at all, two entries without a device say why. Never throws for want of a device.
std::vector<EngineInfo> list_vulkan_engines();

// `engine` is ray_query or compute_bvh; without `device` the best one that has it: hardware before software.
// Throws Error no_suitable_device with why each device was refused.
std::unique_ptr<Tracer> make_vulkan_tracer(Engine engine, std::optional<std::uint32_t> device, const TraceScene& scene);

}  // namespace vantage
