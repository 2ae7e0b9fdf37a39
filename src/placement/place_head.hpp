// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "vantage/placement.hpp"

namespace vantage {

// A station's head keeps so much of the security volume's radius from everything.
inline constexpr double kHeadShare = 0.2;

// Places a station by its head (survey frame) and checks it as a search checks its stations. `area` may be null.
// The ground is the search area at `uv` if that is given and lies below the head. Otherwise it is the search area, or
// any mesh, whose depth below the head is within half of `height_m` of it. If there is none, it is the point
// `height_m` below.
PlacedHead place_head(const SearchArea* area, const ClashChecker& clash, double height_m, const Vec3& head,
                      std::optional<Uv> uv = {});

}  // namespace vantage
