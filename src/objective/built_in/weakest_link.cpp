// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Weakest link of the strongest spanning tree, on which registration depends, over surveyed voxels; `link` is over all
// surfaces. 0 if the network is not connected.
Objective weakest_link(const ObjectiveSettings&) {
  return {.name = "weakest_link",
          .label = "Weakest link (share of the smaller scan)",
          .noun = "overlap at the weakest link",
          .scale = maximise(1, 0),
          .needs = {.pairs = true},
          .value =
              [](const MeasuredNetwork& m) {
                return m.stations.size() == 1 ? 1 : connectivity(scan_overlap_matrix(m.counts), 0).weakest_overlap;
              },
          .advice = "allow more stations, or tie scans together with targets"};
}

}  // namespace vantage::built_in
