// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

Objective stations(const ObjectiveSettings& settings) {
  return {.name = "stations",
          .label = "Number of stations",
          .noun = "number of stations",
          .scale = {static_cast<double>(settings.stations_min), static_cast<double>(settings.stations_max)},
          .needs = {.counts = false},
          .value = [](const MeasuredNetwork& m) { return static_cast<double>(m.stations.size()); },
          .by_alpha = true,
          .advice = "ask for less to be captured"};
}

}  // namespace vantage::built_in
