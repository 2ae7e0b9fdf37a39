// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {
namespace {

// What two scans share, of the smaller one: how practice states the overlap that registration takes.
OverlapMatrix shares_of_the_smaller(const NetworkCounts& counts) {
  OverlapMatrix shares(counts.stations);
  for (std::size_t i = 0; i < counts.stations; ++i)
    for (std::size_t j = i + 1; j < counts.stations; ++j)
      if (const std::uint64_t both = counts.shared_by(i, j))
        shares.set(i, j, static_cast<double>(both) / static_cast<double>(std::min(counts.seen[i], counts.seen[j])));
  return shares;
}

}  // namespace

// The weakest link of the strongest tree that spans the network: what its registration hangs by. 0 where it falls into
// parts.
Objective weakest_link(const ObjectiveSettings&) {
  return {.name = "weakest_link",
          .label = "Weakest link (share of the smaller scan)",
          .needs = {.pairs = true},
          .value = [](const MeasuredNetwork& m) {
            return m.stations.size() == 1 ? 1 : connectivity(shares_of_the_smaller(m.counts), 0).weakest_overlap;
          }};
}

}  // namespace vantage::built_in
