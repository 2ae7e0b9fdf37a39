// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_engines.hpp"

#include <cstdlib>
#include <numeric>
#include <string>

#include "trace/vulkan/vulkan_tracer.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using namespace vulkan;

std::string join(const std::vector<std::string>& parts) {
  return std::accumulate(parts.begin(), parts.end(), std::string(), [](std::string all, const std::string& part) {
    return all.empty() ? part : std::move(all) + ", " + part;
  });
}

EngineInfo describe(Engine engine, const DeviceAbilities& abilities, std::uint32_t index) {
  EngineInfo info;
  info.engine = engine;
  info.device = abilities.name;
  info.driver = abilities.driver;
  info.device_index = index;
  info.software = abilities.software();
  std::vector<std::string> lacks = abilities.compute_lacks;
  if (engine == Engine::ray_query)
    lacks.insert(lacks.end(), abilities.ray_query_lacks.begin(), abilities.ray_query_lacks.end());
  info.usable = lacks.empty();
  if (!info.usable) {
    info.reason = "lacks " + join(lacks);
    if (engine == Engine::ray_query && info.software && abilities.compute_lacks.empty())
      info.reason += "; install mesa-vulkan-drivers >= 24.1";
  } else {
    info.reason = info.software ? "a software device" : "usable";
  }
  return info;
}

bool validation_wanted(const TraceScene& scene) {
  const char* variable = std::getenv("VANTAGE_VALIDATION");
  return scene.validation || (variable && *variable && std::string(variable) != "0");
}

}  // namespace

std::vector<EngineInfo> list_vulkan_engines() {
  std::vector<EngineInfo> engines;
  try {
    const auto instance = Instance::get(false);
    const auto devices = instance->physical_devices();
    for (std::uint32_t d = 0; d < devices.size(); ++d) {
      const DeviceAbilities abilities = abilities_of(devices[d]);
      engines.push_back(describe(Engine::ray_query, abilities, d));
      engines.push_back(describe(Engine::compute_bvh, abilities, d));
    }
    if (!devices.empty()) return engines;
    throw Error(Errc::no_suitable_device,
                "Vulkan finds no device; install a driver (Debian: mesa-vulkan-drivers >= 24.1)");
  } catch (const Error& error) {
    for (const Engine engine : {Engine::ray_query, Engine::compute_bvh}) {
      EngineInfo info;
      info.engine = engine;
      info.device = "none";
      info.reason = error.what();
      engines.push_back(info);
    }
  }
  return engines;
}

std::unique_ptr<Tracer> make_vulkan_tracer(Engine engine, std::optional<std::uint32_t> device,
                                           const TraceScene& scene) {
  const auto instance = Instance::get(validation_wanted(scene));
  const auto devices = instance->physical_devices();
  std::vector<std::string> refusals;
  std::optional<std::uint32_t> best;
  DeviceAbilities best_abilities;
  // Hardware before software, discrete before integrated, then the most memory.
  const auto better = [](const DeviceAbilities& a, const DeviceAbilities& b) {
    const auto rank = [](const DeviceAbilities& x) {
      return x.type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 3
             : x.type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 2
             : x.software()                                     ? 0
                                                                : 1;
    };
    return rank(a) != rank(b) ? rank(a) > rank(b) : a.memory_bytes > b.memory_bytes;
  };
  for (std::uint32_t d = 0; d < devices.size(); ++d) {
    if (device && *device != d) continue;
    const DeviceAbilities abilities = abilities_of(devices[d]);
    const EngineInfo info = describe(engine, abilities, d);
    if (!info.usable)
      refusals.push_back("device " + std::to_string(d) + ", " + info.device + ": " + info.reason);
    else if (!best || better(abilities, best_abilities)) {
      best = d;
      best_abilities = abilities;
    }
  }
  if (device && *device >= devices.size())
    refusals.push_back("there are only " + std::to_string(devices.size()) + " devices, counted from 0");
  if (!best)
    throw Error(Errc::no_suitable_device,
                "no Vulkan device can run the engine " + to_string(engine) +
                    (engine == Engine::ray_query ? "; it needs VK_KHR_ray_query: a GPU with ray tracing, or "
                                                   "mesa-vulkan-drivers >= 24.1 for the software device"
                                                 : "; it needs Vulkan 1.2"),
                std::move(refusals));
  return std::make_unique<VulkanTracer>(describe(engine, best_abilities, *best), instance, devices[*best],
                                        best_abilities, scene);
}

}  // namespace vantage
