// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {

// Equation 1 with the Φ of section 5.1.2.
Objective fitness(const ObjectiveSettings& settings) {
  const FitnessWeights weights = settings.fitness;
  for (const double weight : {weights.coverage, weights.station_count, weights.visibility})
    if (!(weight >= 0 && weight <= 1))
      throw Error(Errc::invalid_argument, "the weights of a fitness lie in [0, 1], not " + std::to_string(weight));
  const auto low = static_cast<double>(settings.stations_min), high = static_cast<double>(settings.stations_max);
  return {.name = "fitness",
          .label = "Fitness (weighted sum of coverage, spared stations, visibility)",
          .scale = maximise(1, 0),
          .needs = {.visibility = true},
          .value =
              [weights, low, high](const MeasuredNetwork& m) {
                const double spared =
                    high == low ? 1 : (high - static_cast<double>(m.stations.size() - m.existing)) / (high - low);
                return weights.coverage * vantage::coverage(m.counts, m.goal_density) +
                       weights.station_count * (std::exp2(spared) - 1) +
                       weights.visibility / static_cast<double>(m.visible_parts);
              },
          .standard_error =
              [weights](const MeasuredNetwork& m) {
                return weights.coverage * coverage_estimate(m.counts, m.goal_density, m.voxels).standard_error;
              },
          .parameters = "weights " + number(weights.coverage) + ", " + number(weights.station_count) + ", " +
                        number(weights.visibility)};
}

}  // namespace vantage::built_in
