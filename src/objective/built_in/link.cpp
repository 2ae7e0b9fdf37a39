// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Weakest link of the strongest spanning tree, by scan overlap over all surfaces, surveyed or not. Practice requires at
// least 30 %. 0 if the network is not connected.
Objective link(const ObjectiveSettings&) {
  return {.name = "link",
          .label = "Weakest link (share of the smaller scan, over all surfaces)",
          .noun = "scan overlap at the weakest link",
          .scale = maximise(1, 0),
          .needs = {.counts = false, .surroundings = true},
          .value =
              [](const MeasuredNetwork& m) {
                return m.stations.size() == 1 ? 1
                                              : connectivity(scan_overlap_matrix(*m.surroundings), 0).weakest_overlap;
              },
          .kind = Objective::Kind::link,
          .advice = "allow more stations, or tie scans together with targets"};
}

}  // namespace vantage::built_in
