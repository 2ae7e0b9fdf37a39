// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {

// Coverage as a share of attainable coverage, at most 1: the attainable coverage is an estimate, which a plan may
// exceed by its error.
Objective capture(const ObjectiveSettings& settings) {
  const double visible = settings.visible;
  if (!(visible > 0 && visible <= 1))
    throw Error(Errc::invalid_argument,
                "capture is a share of attainable coverage, which is above 0 and at most 1, not " + number(visible));
  return {.name = "capture",
          .label = "Capture (share of what can be seen)",
          .scale = maximise(1, 0),
          .needs = {.attainable = true},
          .value =
              [visible](const MeasuredNetwork& m) {
                return std::min(1.0, vantage::coverage(m.counts, m.goal_density) / visible);
              },
          .standard_error =
              [visible](const MeasuredNetwork& m) {
                return coverage_estimate(m.counts, m.goal_density, m.voxels).standard_error / visible;
              },
          .kind = Objective::Kind::coverage,
          .coverage_of_one = visible,
          .advice = "allow more stations, or more places to stand",
          .parameters = "of a coverage of " + number(visible)};
}

}  // namespace vantage::built_in
