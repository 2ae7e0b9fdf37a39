// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>

#include "vantage/error.hpp"
#include "vantage/objective.hpp"

namespace vantage {

// Returns the value of an objective. Throws Error invalid_argument if it is NaN, which cannot rank networks.
inline double number_of(const Objective& objective, const MeasuredNetwork& network) {
  const double value = objective.value(network);
  if (std::isnan(value))
    throw Error(Errc::invalid_argument, "objective \"" + objective.name + "\": its value is NaN for a network of " +
                                            std::to_string(network.stations.size()) +
                                            " stations; it must be a number for every network");
  return value;
}

}  // namespace vantage
