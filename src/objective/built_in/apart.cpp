// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Distance between the two nearest usable stations.
Objective apart(const ObjectiveSettings&) {
  return {.name = "apart",
          .label = "Distance of the nearest two stations",
          .unit = "m",
          .noun = "distance between the nearest stations",
          .scale = maximise(1, 0),
          .needs = {.counts = false},
          .value =
              [](const MeasuredNetwork& m) {
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t i = 0; i < m.stations.size(); ++i)
                  for (std::size_t j = i + 1; j < m.stations.size(); ++j) {
                    if (!active(m.stations[i]) || !active(m.stations[j])) continue;
                    const Vec3 between = m.stations[i].position - m.stations[j].position;
                    nearest = std::min(nearest, std::sqrt(dot(between, between)));
                  }
                return nearest;
              },
          .kind = Objective::Kind::distance,
          .advice = "allow fewer stations"};
}

}  // namespace vantage::built_in
