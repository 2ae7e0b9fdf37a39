// SPDX-License-Identifier: Apache-2.0
// The floors of a site, as a plan shows them: one picture each.
#pragma once

#include <limits>
#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// Ground from `low` to below `high` (survey frame, metres) is shown with the floor at `floor`.
struct PlanLevel {
  double floor = 0;
  double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
  bool holds(double ground_z) const { return ground_z >= low && ground_z < high; }
};

// Where one may stand above and below at one place, on a twentieth of the ground or more: the heights at which most of
// such ground lies, `apart_m` or more from each other, lowest first. Stairs belong to the floor that they start from.
// One level, at the median height, of any other site: a slope or a terrace needs one picture. Never empty.
std::vector<PlanLevel> plan_levels(const SearchMesh& mesh, double apart_m = 1.8);

}  // namespace vantage
