// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Equation 13.
Objective overlap(const ObjectiveSettings&) {
  return {.name = "overlap",
          .label = "Overlap (average clustering coefficient)",
          .noun = "overlap",
          .scale = maximise(1, 0),
          .needs = {.pairs = true},
          .value = [](const MeasuredNetwork& m) { return clustering_coefficient(m.overlap); },
          .advice = "allow more stations, or tie scans together with targets"};
}

}  // namespace vantage::built_in
