// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "plan/placement_oracle.hpp"
#include "vantage/error.hpp"

namespace vantage {

PlacementOracle make_placement_oracle(const SearchArea& area, const ClashChecker& clash, const Scanner& scanner) {
  return {.uv_min = area.uv_min(),
          .uv_max = area.uv_max(),
          .locate = [&area](Uv uv) { return area.locate(uv); },
          .project = [&area](const Vec3& ground) { return area.project(ground); },
          .clashes = [&clash](const Vec3& ground, double height_m) { return clash.clashes(ground, height_m); },
          .check_head = [&area, &clash, height_m = scanner.height_m](
                            const Vec3& head) { return place_head(&area, clash, height_m, head).station; },
          .sees = [&clash](const Vec3& a, const Vec3& b) { return clash.sees(a, b); },
          .height_m = scanner.height_m,
          .range_m = scanner.max_range_m};
}

std::vector<PlacedStation> place_stations(const SearchArea& area, const ClashChecker& clash, double height_m,
                                          std::span<const double> uvs) {
  if (uvs.size() % 2 != 0)
    throw Error(Errc::invalid_argument,
                "place_stations: (u, v) pairs are wanted, " + std::to_string(uvs.size()) + " values were given");
  Scanner scanner;
  scanner.height_m = height_m;
  const PlacementOracle site = make_placement_oracle(area, clash, scanner);
  std::vector<PlacedStation> stations;
  stations.reserve(uvs.size() / 2);
  for (std::size_t i = 0; i < uvs.size(); i += 2)
    stations.push_back(place_station(site, {uvs[i], uvs[i + 1]}, height_m));
  return stations;
}

}  // namespace vantage
