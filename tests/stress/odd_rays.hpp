// SPDX-License-Identifier: Apache-2.0
// Rays for which rounding is worst: from inside or on a surface, at the ends of the range, grazing, at the poles.
#pragma once

#include <string>
#include <vector>

#include "stress/comparison.hpp"

namespace vantage::test {

struct OddRays {
  std::string name;
  TraceScene scene;
  std::vector<TraceStation> stations;
  bool at_a_limit = false;  // hits lie within rounding of an end of the range, so each may count or not
};
std::vector<OddRays> odd_rays(double step_degrees);

}  // namespace vantage::test
