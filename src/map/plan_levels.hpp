// SPDX-License-Identifier: Apache-2.0
// The floors of a site, as a plan shows them: one picture each.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/person.hpp"
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

// Returns the floors of a site, lowest first and `apart_m` or more from each other. A site has several floors if a
// twentieth of its ground or more lies over other ground, or if stations stand over each other. The floors then lie at
// the heights where most of that ground lies, and at those of the stations. Stairs, and landings half way up, belong to
// the floor that they start from. Any other site, such as a slope or a terrace, has one level at its median height. The
// result is never empty, and no level is cut.
std::vector<PlanLevel> plan_levels(const SearchMesh& mesh, std::span<const PlacedStation> stations = {},
                                   double apart_m = person::kHeight_m);

// Returns the same levels with the heights at which their plans are cut: 1.2 m above the floor, between window sills
// and lintels, for a scanner at 1.85 m. Heads at other heights, as in models of unusual size, change it in proportion.
// Several levels are all cut. A single level is cut above the ground of the stations under a roof, if a tenth of its
// stations or more stand under one, or one stands in a building. A site without stations is cut if most of its ground
// lies under something.
std::vector<PlanLevel> cut_levels(const Scene& scene, const SearchMesh& mesh, std::span<const PlacedStation> stations);

// Tells of each station whether something of the scene hangs over its head.
std::vector<bool> under_roof(const Scene& scene, std::span<const PlacedStation> stations);

}  // namespace vantage
