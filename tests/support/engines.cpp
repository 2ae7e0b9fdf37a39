// SPDX-License-Identifier: Apache-2.0
#include "support/engines.hpp"

#include <ostream>
#include <utility>

namespace vantage {

void PrintTo(const EngineInfo& info, std::ostream* out) { *out << to_string(info.engine) << " on " << info.device; }

namespace test {

std::vector<EngineInfo> usable_engines() {
  std::vector<EngineInfo> usable;
  for (EngineInfo& info : list_engines()) {
    if (info.usable) usable.push_back(std::move(info));
  }
  return usable;
}

std::string name_of(const EngineInfo& info) { return to_string(info.engine) + "_" + std::to_string(info.device_index); }

}  // namespace test
}  // namespace vantage
