// SPDX-License-Identifier: Apache-2.0
// The only file that names every engine.
#include <algorithm>
#include <string>
#include <utility>

#include "trace/choose_engine.hpp"
#include "trace/embree/embree_tracer.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/vulkan_engines.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::size_t default_engine(const std::vector<EngineInfo>& engines, std::optional<std::uint32_t> device_index) {
  if (device_index) {
    const auto on_device = std::find_if(engines.begin(), engines.end(), [&](const EngineInfo& e) {
      return e.engine != Engine::embree && e.usable && e.device_index == *device_index;
    });
    if (on_device != engines.end()) return static_cast<std::size_t>(on_device - engines.begin());
  }
  for (const Engine wanted : {Engine::ray_query, Engine::compute_bvh})
    for (std::size_t k = 0; k < engines.size(); ++k)
      if (engines[k].engine == wanted && engines[k].usable && !engines[k].software) return k;
  const auto embree =
      std::find_if(engines.begin(), engines.end(), [](const EngineInfo& e) { return e.engine == Engine::embree; });
  return static_cast<std::size_t>(embree - engines.begin());
}

std::vector<EngineInfo> list_engines() {
  std::vector<EngineInfo> engines = list_vulkan_engines();
  engines.push_back(embree_engine_info());
  EngineInfo& chosen = engines[default_engine(engines)];
  chosen.chosen_by_default = true;
  if (chosen.engine == Engine::embree) {
    const bool software = std::any_of(engines.begin(), engines.end(), [](const EngineInfo& e) {
      return e.software && e.usable && e.engine != Engine::embree;
    });
    chosen.reason =
        (software ? "Vulkan offers only a software device, which Embree outruns; " : "no Vulkan GPU is usable; ") +
        chosen.reason;
  }
  return engines;
}

std::unique_ptr<Tracer> make_tracer(Engine engine, std::optional<std::uint32_t> device_index, const TraceScene& scene) {
  if (engine == Engine::automatic) {
    const auto engines = list_engines();
    const EngineInfo& chosen = engines[default_engine(engines, device_index)];
    engine = chosen.engine;
    if (!device_index && engine != Engine::embree) device_index = chosen.device_index;
  }
  if (engine == Engine::embree) {
    if (device_index.value_or(0) != 0)
      throw Error(Errc::no_suitable_device,
                  "there is no device " + std::to_string(*device_index) + " for embree, which has only device 0");
    return make_embree_tracer(scene);
  }
  return make_vulkan_tracer(engine, device_index, scene);
}

}  // namespace vantage
