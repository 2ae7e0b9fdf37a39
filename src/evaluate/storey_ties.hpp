// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vantage/on_site.hpp"

namespace vantage {

// True if a link of two stations joins ground at heights that differ by a storey.
bool crosses_storeys(const PlacedStation& a, const PlacedStation& b);
// True if a link of each pair of stations joins storeys, and nobody walks along it: the way on foot is longer than a
// stair, and than a slope.
std::vector<std::uint8_t> past_stairs(std::span<const PlacedStation> stations,
                                      std::span<const std::pair<std::size_t, std::size_t>> pairs,
                                      const OnSite& on_site);

}  // namespace vantage
