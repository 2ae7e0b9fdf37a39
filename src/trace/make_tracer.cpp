// SPDX-License-Identifier: Apache-2.0
// The only file that names every engine.
#include <algorithm>
#include <future>
#include <iterator>
#include <string>
#include <utility>

#include "trace/choose_engine.hpp"
#include "trace/device_fault.hpp"
#include "trace/embree/embree_tracer.hpp"
#include "trace/rays/ray_finder.hpp"
#include "trace/rebuilding_tracer.hpp"
#include "trace/spread/spread_tracer.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/compute_bvh/compute_bvh.hpp"
#include "trace/vulkan/ray_query/ray_query.hpp"
#include "trace/vulkan/vulkan_engines.hpp"
#include "vantage/error.hpp"

namespace vantage {

namespace {

// Engines that run on Vulkan; `automatic` takes the first of those on a device.
constexpr const vulkan::VulkanEngine* kVulkanEngines[] = {
    &vulkan::ray_query_engine,
    &vulkan::compute_bvh_engine,
};

// Resolves `automatic`.
DeviceChoice resolved(Engine engine, std::optional<std::uint32_t> device_index) {
  if (engine != Engine::automatic) return {engine, device_index};
  const auto engines = list_engines();
  const EngineInfo& chosen = engines[default_engine(engines, device_index)];
  if (!device_index && chosen.engine != Engine::embree) device_index = chosen.device_index;
  return {chosen.engine, device_index};
}

// Returns null for the processor. Throws Error: no_suitable_device, invalid_argument.
const vulkan::VulkanEngine* vulkan_engine_of(const DeviceChoice& device) {
  if (device.engine == Engine::embree) {
    if (device.index.value_or(0) != 0)
      throw Error(Errc::no_suitable_device,
                  "there is no device " + std::to_string(*device.index) + " for embree, which has only device 0");
    return nullptr;
  }
  const auto chosen = std::find_if(std::begin(kVulkanEngines), std::end(kVulkanEngines),
                                   [&](const vulkan::VulkanEngine* each) { return each->engine == device.engine; });
  if (chosen == std::end(kVulkanEngines))
    throw Error(Errc::invalid_argument, "there is no engine number " + std::to_string(static_cast<int>(device.engine)));
  return *chosen;
}

std::unique_ptr<Tracer> make_once(const DeviceChoice& device, const TraceScene& scene) {
  const vulkan::VulkanEngine* const engine = vulkan_engine_of(device);
  return engine ? make_vulkan_tracer(*engine, device.index, scene) : make_embree_tracer(scene);
}

}  // namespace

std::size_t default_engine(const std::vector<EngineInfo>& engines, std::optional<std::uint32_t> device_index) {
  if (device_index) {
    const auto on_device = std::find_if(engines.begin(), engines.end(), [&](const EngineInfo& e) {
      return e.engine != Engine::embree && e.usable && e.device_index == *device_index;
    });
    if (on_device != engines.end()) return static_cast<std::size_t>(on_device - engines.begin());
  }
  for (const vulkan::VulkanEngine* wanted : kVulkanEngines)
    for (std::size_t k = 0; k < engines.size(); ++k)
      if (engines[k].engine == wanted->engine && engines[k].usable && !engines[k].software) return k;
  const auto embree =
      std::find_if(engines.begin(), engines.end(), [](const EngineInfo& e) { return e.engine == Engine::embree; });
  return static_cast<std::size_t>(embree - engines.begin());
}

std::vector<EngineInfo> list_engines() {
  std::vector<EngineInfo> engines = list_vulkan_engines(kVulkanEngines);
  engines.push_back(embree_engine_info());
  EngineInfo& chosen = engines[default_engine(engines)];
  chosen.chosen_by_default = true;
  if (chosen.engine == Engine::embree) {
    const bool software = std::any_of(engines.begin(), engines.end(), [](const EngineInfo& e) {
      return e.software && e.usable && e.engine != Engine::embree;
    });
    chosen.reason = (software ? "no graphics card found, and Embree is faster than a software device; "
                              : "no graphics card found; ") +
                    chosen.reason;
  }
  return engines;
}

ChosenDevice choose_device(Engine engine, std::optional<std::uint32_t> device_index) {
  const DeviceChoice chosen = resolved(engine, device_index);
  ChosenDevice device{.engine = chosen.engine};
  if (chosen.engine == Engine::embree) return device;
  const std::vector<EngineInfo> listed = list_vulkan_engines(kVulkanEngines);
  const EngineInfo* best = nullptr;
  for (const EngineInfo& info : listed)
    if (info.engine == chosen.engine && info.usable && (!chosen.index || *chosen.index == info.device_index) &&
        (!best || (best->software && !info.software)))
      best = &info;
  if (!best) return device;  // make_tracer() reports why
  device.software = best->software;
  if (!best->software) device.free_bytes = free_device_memory(best->device_index);
  return device;
}

std::unique_ptr<Tracer> make_tracer(Engine engine, std::optional<std::uint32_t> device_index, const TraceScene& scene,
                                    std::function<void(const std::string&)> warn) {
  const DeviceChoice device = resolved(engine, device_index);
  if (device.engine == Engine::embree) return make_once(device, scene);
  return std::make_unique<RebuildingTracer>([=](const TraceScene& now) { return make_once(device, now); }, scene,
                                            std::move(warn));
}

std::unique_ptr<RayFinder> make_ray_finder(const DeviceChoice& device, const std::shared_ptr<const SceneData>& scene) {
  const DeviceChoice chosen = resolved(device.engine, device.index);
  const vulkan::VulkanEngine* const engine = vulkan_engine_of(chosen);
  return engine ? make_vulkan_ray_finder(*engine, chosen.index, *scene) : nullptr;
}

std::vector<DeviceChoice> all_devices(Engine engine) {
  const std::vector<EngineInfo> listed = list_engines();
  if (engine == Engine::automatic) engine = listed[default_engine(listed)].engine;
  std::vector<DeviceChoice> all;
  for (const EngineInfo& info : listed)
    if (info.engine == engine && info.usable && !info.software) all.push_back({engine, info.device_index});
  if (all.empty()) all.push_back({engine, std::nullopt});
  return all;
}

std::unique_ptr<Tracer> make_tracer(std::span<const DeviceChoice> devices, const TraceScene& scene,
                                    std::function<void(const std::string&)> warn) {
  if (devices.size() == 1) return make_tracer(devices.front().engine, devices.front().index, scene, std::move(warn));
  std::vector<std::future<std::unique_ptr<Tracer>>> building;
  for (const DeviceChoice& device : devices)
    building.push_back(
        std::async(std::launch::async, [&] { return make_once(resolved(device.engine, device.index), scene); }));
  std::vector<std::unique_ptr<Tracer>> tracers;
  std::optional<DeviceFault> fault;
  for (auto& each : building) try {
      tracers.push_back(each.get());
    } catch (const DeviceFault& thrown) {
      fault = thrown;
      if (warn) warn(std::string("a device is left out: ") + thrown.what());
    }
  if (tracers.empty()) throw *fault;
  const bool gpus = std::ranges::none_of(tracers, [](const auto& t) { return t->info().engine == Engine::embree; });
  return std::make_unique<SpreadTracer>(
      std::move(tracers), scene, std::move(warn),
      SpreadTracer::Options{.population =
                                gpus ? SpreadTracer::Population::by_voxels : SpreadTracer::Population::by_networks});
}

}  // namespace vantage
