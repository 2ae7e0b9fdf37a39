// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace vantage {

// Saturating addition of point counts.
inline void add_saturating(std::uint32_t& sum, std::uint32_t points) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  sum = points > kMost - sum ? kMost : sum + points;
}

}  // namespace vantage
