// SPDX-License-Identifier: Apache-2.0
// Where stations may stand, as the search sees it: SearchArea and ClashChecker behind two functions, so that the search
// can be tested on sites made of formulas. The functions must be safe to call from several threads.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "vantage/planner.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

struct Site {
  Uv uv_min, uv_max;
  std::function<std::optional<Vec3>(Uv)> locate;          // ground under (u, v)
  std::function<std::optional<Uv>(const Vec3&)> project;  // and back
  std::function<bool(const Vec3&, double)> clashes;       // by ground point and the head's height above it
  std::function<PlacedStation(const Vec3&)> check_head;   // a station given by its head
  std::function<bool(const Vec3&, const Vec3&)> sees;     // one head the other, nothing between
  double height_m = 0;                                    // of the scanner's head
  double range_m = 0;                                     // how far a scanner sees
};

// Borrows both.
Site make_site(const SearchArea& area, const ClashChecker& clash, const Scanner& scanner);

PlacedStation place_station(const Site& site, Uv uv, double height_m);

// Stations that are there already. `setups`: one each, or none. Throws Error invalid_argument for another number.
std::vector<PlacedStation> kept_stations(const Site& site, std::span<const Vec3> heads,
                                         std::span<const StationSetup> setups);

// Connected parts of the graph of stations that see each other within range. A skipped station is a part of its own.
std::size_t visibility_parts(const Site& site, const Network& network);

}  // namespace vantage
