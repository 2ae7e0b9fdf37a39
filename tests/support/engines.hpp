// SPDX-License-Identifier: Apache-2.0
// The engines of this machine, as parameters of test suites.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage {

void PrintTo(const EngineInfo& info, std::ostream* out);

namespace test {

// All pairs of engine and device that can run. If the GPU has no ray queries, they run on the software device.
std::vector<EngineInfo> usable_engines();
// The same for a given list.
std::vector<EngineInfo> usable_of(std::vector<EngineInfo> listed);
std::string name_of(const EngineInfo& info);  // letters, digits and _ only

}  // namespace test
}  // namespace vantage
