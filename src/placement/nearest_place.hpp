// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// Returns the place nearest to a head (survey frame) where a scanner may stand `height_m` above the search area, at
// most `reach_m` from the head in space; empty if there is none. The place is nearest to within a fiftieth of the
// security volume's radius; narrower free ground may be overlooked.
std::optional<PlacedStation> nearest_place(const SearchArea& area, const ClashChecker& clash, double height_m,
                                           const Vec3& head, double reach_m = nearest_place_reach_m);

// Returns a move for each station in a bad place, except existing ones and those without a position.
std::vector<StationMove> station_moves(const SearchArea& area, const ClashChecker& clash, double height_m,
                                       std::span<const PlacedStation> stations);

// Returns e.g. "0.42 m to the north-east and 1.20 m down".
std::string offset_text(const Vec3& from, const Vec3& to);

}  // namespace vantage
