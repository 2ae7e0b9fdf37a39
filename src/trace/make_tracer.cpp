// SPDX-License-Identifier: Apache-2.0
// The only file that names every engine.
#include <utility>

#include "trace/embree/embree_tracer.hpp"
#include "trace/tracer.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::vector<EngineInfo> list_engines() {
  std::vector<EngineInfo> engines{embree_engine_info()};
  engines.front().chosen_by_default = true;
  return engines;
}

std::unique_ptr<Tracer> make_tracer(Engine engine, std::optional<std::uint32_t>, const TraceScene& scene) {
  if (engine != Engine::embree && engine != Engine::automatic)
    throw Error(Errc::no_suitable_device, "this build has no engine " + to_string(engine) + "; use embree");
  return make_embree_tracer(scene);
}

}  // namespace vantage
