// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// The weakest link of the strongest tree that spans the network: what its registration hangs by. 0 where it falls into
// parts. Over surveyed voxels; `link` is over all surfaces.
Objective weakest_link(const ObjectiveSettings&) {
  return {.name = "weakest_link",
          .label = "Weakest link (share of the smaller scan)",
          .needs = {.pairs = true},
          .value = [](const MeasuredNetwork& m) {
            return m.stations.size() == 1 ? 1 : connectivity(scan_overlap_matrix(m.counts), 0).weakest_overlap;
          }};
}

}  // namespace vantage::built_in
