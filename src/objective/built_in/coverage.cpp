// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Equation 8.
Objective coverage(const ObjectiveSettings&) {
  return {
      .name = "coverage",
      .label = "Coverage (1: every surveyed voxel at its goal density)",
      .noun = "share captured of the site",
      .percent = true,
      .scale = maximise(1, 0),
      .value = [](const MeasuredNetwork& m) { return vantage::coverage(m.counts, m.goal_density); },
      .standard_error =
          [](const MeasuredNetwork& m) { return coverage_estimate(m.counts, m.goal_density, m.voxels).standard_error; },
      .kind = Objective::Kind::coverage,
      .advice = "allow more stations, or give more places to stand"};
}

}  // namespace vantage::built_in
