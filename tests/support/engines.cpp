// SPDX-License-Identifier: Apache-2.0
#include "support/engines.hpp"

#include <ostream>

namespace vantage {

void PrintTo(const EngineInfo& info, std::ostream* out) { *out << to_string(info.engine) << " on " << info.device; }

namespace test {

std::vector<EngineInfo> usable_of(std::vector<EngineInfo> listed) {
  std::erase_if(listed, [](const EngineInfo& info) { return !info.usable; });
  return listed;
}

std::vector<EngineInfo> usable_engines() { return usable_of(list_engines()); }

std::string name_of(const EngineInfo& info) { return to_string(info.engine) + "_" + std::to_string(info.device_index); }

}  // namespace test
}  // namespace vantage
