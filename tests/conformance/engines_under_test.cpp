// SPDX-License-Identifier: Apache-2.0
#include "conformance/engines_under_test.hpp"

#include <array>
#include <ostream>

#include "conformance/brute_force/brute_force.hpp"
#include "support/engines.hpp"
#include "trace/vulkan/vulkan_engines.hpp"

namespace vantage::test {

void PrintTo(const EngineUnderTest& engine, std::ostream* out) { *out << engine.name; }

std::vector<EngineUnderTest> engines_under_test() {
  std::vector<EngineUnderTest> engines;
  for (const EngineInfo& info : usable_engines())
    engines.push_back({name_of(info),
                       [info](const TraceScene& scene) { return make_tracer(info.engine, info.device_index, scene); }});
  const std::array added{&brute_force_engine};
  for (const EngineInfo& info : list_vulkan_engines(added))
    if (info.usable)
      engines.push_back({"brute_force_" + std::to_string(info.device_index), [info](const TraceScene& scene) {
                           return make_vulkan_tracer(brute_force_engine, info.device_index, scene);
                         }});
  return engines;
}

}  // namespace vantage::test
