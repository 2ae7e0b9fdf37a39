// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace vantage {

// Points and masks of every voxel after one pass, of at most `mask_bits` stations.
struct PassField {
  std::vector<std::uint32_t> count;     // points, saturating
  std::vector<std::uint64_t> stations;  // bit `TraceStation::bit()` of those with a point; empty without masks
};

}  // namespace vantage
