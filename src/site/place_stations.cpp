// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "placement/in_the_way.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/error.hpp"

namespace vantage {

PlacementOracle make_placement_oracle(Site& site) {
  const SearchArea& area = site.area();
  const ClashChecker& clash = site.clash();
  return {.uv_min = area.uv_min(),
          .uv_max = area.uv_max(),
          .locate = [&area](Uv uv) { return area.locate(uv); },
          .project = [&area](const Vec3& ground) { return area.project(ground); },
          .clashes = [&clash](const Vec3& ground, double height_m) { return clash.clashes(ground, height_m); },
          .check_head = [&site](const Vec3& head) { return site.place_head(head).station; },
          .sees = [&clash](const Vec3& a, const Vec3& b) { return clash.sees(a, b); },
          .better_aside = [&clash](const Vec3& ground) { return better_aside(clash, ground); },
          .at_brink = [&clash](const Vec3& ground) { return at_brink(clash, ground); },
          .height_m = site.scanner().height_m,
          .range_m = site.scanner().max_range_m};
}

std::vector<PlacedStation> place_stations(Site& site, std::span<const double> uvs) {
  if (uvs.size() % 2 != 0)
    throw Error(Errc::invalid_argument,
                "place_stations: (u, v) pairs are wanted, " + std::to_string(uvs.size()) + " values were given");
  const PlacementOracle oracle = make_placement_oracle(site);
  std::vector<PlacedStation> stations;
  stations.reserve(uvs.size() / 2);
  for (std::size_t i = 0; i < uvs.size(); i += 2)
    stations.push_back(place_station(oracle, {uvs[i], uvs[i + 1]}, oracle.height_m));
  return stations;
}

}  // namespace vantage
