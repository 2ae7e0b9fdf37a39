// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "core/text.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {

std::vector<std::string> station_names(std::span<const PlacedStation> stations, std::span<const std::string> given) {
  std::vector<std::string> names;
  const std::set<std::string> own(given.begin(), given.end());
  std::set<std::string> taken;
  std::size_t placed = 0, kept = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    std::string name;
    do name = stations[k].existing ? "K" + number(++kept) : "S" + number(++placed);
    while (own.contains(name) && (k >= given.size() || given[k].empty()));
    if (k < given.size() && !given[k].empty()) name = given[k];
    if (!taken.insert(name).second) taken.insert(name += " (" + number(k + 1) + ")");
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace vantage
