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

std::vector<EngineInfo> usable_engines();
std::string name_of(const EngineInfo& info);  // letters, digits and _ only

}  // namespace test
}  // namespace vantage
