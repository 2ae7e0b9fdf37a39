// SPDX-License-Identifier: Apache-2.0
#include "conformance/engines_under_test.hpp"

#include <array>
#include <ostream>
#include <utility>

#include "conformance/brute_force/brute_force.hpp"
#include "support/engines.hpp"
#include "trace/spread/spread_tracer.hpp"
#include "trace/vulkan/vulkan_engines.hpp"

namespace vantage::test {

void PrintTo(const EngineUnderTest& engine, std::ostream* out) { *out << engine.name; }

std::vector<EngineUnderTest> engines_under_test() {
  std::vector<EngineUnderTest> engines;
  for (const EngineInfo& info : usable_engines())
    engines.push_back({name_of(info),
                       [info](const TraceScene& scene) { return make_tracer(info.engine, info.device_index, scene); }});
  // Several devices together, software ones if there are no others. A network is always split here, since a small one
  // never would be. GPUs split a population by voxels, processors by networks.
  const auto together = [&](const std::string& name, const DeviceChoice& device, std::size_t many) {
    engines.push_back({name, [device, many](const TraceScene& scene) {
                         std::vector<std::unique_ptr<Tracer>> tracers;
                         for (std::size_t k = 0; k < many; ++k)
                           tracers.push_back(make_tracer(device.engine, device.index, scene));
                         const bool gpus = device.engine != Engine::embree;
                         return std::make_unique<SpreadTracer>(
                             std::move(tracers), scene, WorkerPool::Warn(),
                             SpreadTracer::Options{.split = SpreadTracer::Split::always,
                                                   .population = gpus ? SpreadTracer::Population::by_voxels
                                                                      : SpreadTracer::Population::by_networks});
                       }});
  };
  together("two_compute_bvh", {.engine = Engine::compute_bvh}, 2);
  together("three_embree", {.engine = Engine::embree}, 3);
  const std::array added{&brute_force_engine};
  for (const EngineInfo& info : list_vulkan_engines(added))
    if (info.usable)
      engines.push_back({"brute_force_" + std::to_string(info.device_index), [info](const TraceScene& scene) {
                           return make_vulkan_tracer(brute_force_engine, info.device_index, scene);
                         }});
  return engines;
}

}  // namespace vantage::test
