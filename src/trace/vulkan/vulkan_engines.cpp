// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_engines.hpp"

#include <cstdlib>
#include <string>

#include "trace/vulkan/vulkan_ray_finder.hpp"
#include "trace/vulkan/vulkan_tracer.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using namespace vulkan;

EngineInfo describe(const VulkanEngine& engine, const DeviceAbilities& abilities, std::uint32_t index) {
  EngineInfo info;
  info.engine = engine.engine;
  info.device = abilities.name;
  info.driver = abilities.driver;
  info.device_index = index;
  info.software = abilities.software();
  info.reason = abilities.refusal(engine.needs);
  info.usable = info.reason.empty();
  if (info.usable) info.reason = info.software ? "a software device" : "usable";
  return info;
}

bool validation_wanted() {
  const char* variable = std::getenv("VANTAGE_VALIDATION");
  return variable && *variable && std::string(variable) != "0";
}

// The device that an engine runs on.
struct Selected {
  std::shared_ptr<Instance> instance;
  VkPhysicalDevice device;
  DeviceAbilities abilities;
  EngineInfo info;
};

Selected select_device(const VulkanEngine& engine, std::optional<std::uint32_t> device, bool validation) {
  const auto instance = Instance::get(validation || validation_wanted());
  const auto devices = instance->physical_devices();
  std::vector<std::string> refusals;
  std::optional<std::uint32_t> best;
  DeviceAbilities best_abilities;
  for (std::uint32_t d = 0; d < devices.size(); ++d) {
    if (device && *device != d) continue;
    const DeviceAbilities abilities = abilities_of(*instance, devices[d]);
    const std::string refusal = abilities.refusal(engine.needs);
    if (!refusal.empty())
      refusals.push_back("device " + std::to_string(d) + ", " + abilities.name + ": " + refusal);
    else if (!best || abilities.better_than(best_abilities)) {
      best = d;
      best_abilities = abilities;
    }
  }
  if (device && *device >= devices.size())
    refusals.push_back("there are only " + std::to_string(devices.size()) + " devices, counted from 0");
  if (!best)
    throw Error(
        Errc::no_suitable_device,
        "no Vulkan device can run the engine " + to_string(engine.engine) + "; it needs " + who_has(engine.needs),
        std::move(refusals));
  return {instance, devices[*best], best_abilities, describe(engine, best_abilities, *best)};
}

}  // namespace

std::vector<EngineInfo> list_vulkan_engines(VulkanEngines engines) {
  std::vector<EngineInfo> infos;
  try {
    const auto instance = Instance::get(false);
    const auto devices = instance->physical_devices();
    for (std::uint32_t d = 0; d < devices.size(); ++d) {
      const DeviceAbilities abilities = abilities_of(*instance, devices[d]);
      for (const VulkanEngine* engine : engines) infos.push_back(describe(*engine, abilities, d));
    }
    if (!devices.empty()) return infos;
    throw Error(Errc::no_suitable_device,
                "Vulkan finds no device; install a driver (Debian: mesa-vulkan-drivers >= 24.1)");
  } catch (const Error& error) {
    for (const VulkanEngine* engine : engines) {
      EngineInfo info;
      info.engine = engine->engine;
      info.device = "none";
      info.reason = error.what();
      infos.push_back(info);
    }
  }
  return infos;
}

std::optional<std::uint64_t> free_device_memory(std::uint32_t device) {
  try {
    const auto instance = Instance::get(false);
    return memory_of(*instance, instance->physical_devices().at(device)).free;
  } catch (const std::exception&) {  // the next user of the device gets the error
    return std::nullopt;
  }
}

std::unique_ptr<Tracer> make_vulkan_tracer(const VulkanEngine& engine, std::optional<std::uint32_t> device,
                                           const TraceScene& given) {
  TraceScene scene = given;
  if (!engine.places_meshes) scene.scene = flattened(scene.scene);
  const Selected on = select_device(engine, device, scene.validation);
  return std::make_unique<VulkanTracer>(engine, on.info, on.instance, on.device, on.abilities, scene);
}

std::unique_ptr<RayFinder> make_vulkan_ray_finder(const VulkanEngine& engine, std::optional<std::uint32_t> device,
                                                  const SceneData& scene) {
  const Selected on = select_device(engine, device, false);
  return std::make_unique<VulkanRayFinder>(engine, on.info, on.instance, on.device, on.abilities, scene);
}

}  // namespace vantage
