// SPDX-License-Identifier: Apache-2.0
// Allowed positions as the search sees them. Functions hide SearchArea and ClashChecker, so that tests can search on
// sites made of formulas. The functions must be safe to call from several threads.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "vantage/site.hpp"

namespace vantage {

struct PlacementOracle {
  Uv uv_min, uv_max;
  std::function<std::optional<Vec3>(Uv)> locate;          // ground under (u, v)
  std::function<std::optional<Uv>(const Vec3&)> project;  // (u, v) of a ground point
  std::function<bool(const Vec3&, double)> clashes;       // ground point; height of the head above it
  std::function<PlacedStation(const Vec3&)> check_head;   // a station given by its head
  std::function<bool(const Vec3&, const Vec3&)> sees;     // whether one head sees the other
  // These judge ground points (placement/in_the_way.hpp); an empty one judges none.
  std::function<bool(const Vec3&)> better_aside = {}, at_brink = {};
  double height_m = 0;                       // of the scanner's head
  double range_m = 0;                        // of a scanner
  std::vector<std::uint32_t> scanners = {};  // of the site, to choose from; empty: the first
};

// Borrows the site. Heights and range are the first scanner's.
PlacementOracle make_placement_oracle(Site& site);

PlacedStation place_station(const PlacementOracle& oracle, Uv uv, double height_m);

// Existing stations. `setups`: one each, or none. Throws Error invalid_argument for another number.
std::vector<PlacedStation> existing_stations(const PlacementOracle& oracle, std::span<const Vec3> heads,
                                             std::span<const StationSetup> setups);

}  // namespace vantage
