// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "vantage/placement.hpp"

namespace vantage {

// Share of the security volume's radius that a station's head keeps from all surfaces.
inline constexpr double kHeadShare = 0.2;

// Places a station by its head (survey frame) and checks it as a search checks its stations. `area` may be null. The
// ground is the search area at `uv` if that is given and lies below the head. Otherwise it is the search area, or any
// mesh, at a depth below the head within half of `height_m` of that height. If there is none, it is the point
// `height_m` below.
PlacedHead place_head(const SearchArea* area, const ClashChecker& clash, double height_m, const Vec3& head,
                      std::optional<Uv> uv = {});

}  // namespace vantage
