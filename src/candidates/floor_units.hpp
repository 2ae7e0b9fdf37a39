// SPDX-License-Identifier: Apache-2.0
// Parts of the floor that are each worth a visit: the rooms that a file names, and the charts of the search area, which
// are floors above each other and floors that no way joins.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

class FloorUnits {
 public:
  FloorUnits() = default;
  // Those of at least `least_m2` of floor. The scene's rooms are copied.
  FloorUnits(const Scene& scene, const SearchArea& area, double least_m2);

  // The stations in each, by their places.
  std::vector<std::vector<std::size_t>> stations_in(std::span<const PlacedStation> stations) const;

 private:
  struct UvBox {
    Uv min, max;
  };
  std::vector<Room> all_rooms_;
  std::vector<std::size_t> rooms_;  // indices of those that are units
  std::vector<UvBox> charts_;       // one alone is no part
};

// Units that get a station of their own if it captures `least_m2` of new surface. Each voxel of the sample stands for
// `element_m2` of surface.
struct UnitsToVisit {
  FloorUnits units;
  double least_m2 = 0, element_m2 = 0;
};

}  // namespace vantage
