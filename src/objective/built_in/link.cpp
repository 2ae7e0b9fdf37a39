// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// The weakest link of the strongest tree that spans the network, by scan overlap over all surfaces, surveyed or not:
// what practice asks to be at least 30 %. 0 where the network falls into parts.
Objective link(const ObjectiveSettings&) {
  return {.name = "link",
          .label = "Weakest link (share of the smaller scan, over all surfaces)",
          .needs = {.counts = false, .surroundings = true},
          .value = [](const MeasuredNetwork& m) {
            return m.stations.size() == 1 ? 1 : connectivity(scan_overlap_matrix(*m.surroundings), 0).weakest_overlap;
          }};
}

}  // namespace vantage::built_in
