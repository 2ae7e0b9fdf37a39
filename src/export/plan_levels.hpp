// SPDX-License-Identifier: Apache-2.0
// The floors of a site, as a plan shows them: one picture each.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Ground from `low` to below `high` (survey frame, metres) is shown with the floor at `floor`.
struct PlanLevel {
  double floor = 0;
  double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
  std::optional<double> cut = std::nullopt;  // height at which its plan is cut; empty: seen from above, uncut
  bool only() const {                        // of its site
    return low == std::numeric_limits<double>::lowest() && high == std::numeric_limits<double>::max();
  }
  bool holds(double ground_z) const { return ground_z >= low && ground_z < high; }
};

// Where one may stand above and below at one place, on a twentieth of the ground or more, or where stations stand so:
// the heights at which most of such ground lies, and those of stations, `apart_m` or more from each other, lowest
// first. Stairs belong to the floor that they start from, and so do landings half way up. One level, at the median
// height, of any other site: a slope or a terrace needs one picture. Never empty, never cut.
std::vector<PlanLevel> plan_levels(const SearchMesh& mesh, std::span<const PlacedStation> stations = {},
                                   double apart_m = 1.8);

// The same, with the heights at which they are cut: 1.2 m above the floor, between window sills and lintels, under a
// scanner at 1.85 m; heads at other heights, as in models of unusual size, move it in proportion. Several levels are
// all cut. A single one is cut above the ground of the stations under a roof, if a tenth of its stations or more stand
// under one, or one stands in a building; where there is no station, if most of its ground lies under something.
std::vector<PlanLevel> cut_levels(const Scene& scene, const SearchMesh& mesh, std::span<const PlacedStation> stations);

// Of each station, whether something of the scene hangs over its head.
std::vector<bool> under_roof(const Scene& scene, std::span<const PlacedStation> stations);

}  // namespace vantage
