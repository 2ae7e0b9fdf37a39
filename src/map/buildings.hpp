// SPDX-License-Identifier: Apache-2.0
// Buildings of a site, by the ground in them.
#pragma once

#include <cstdint>
#include <vector>

#include "map/relief.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// The building of each cell of a map, counted from 1; 0: none.
struct BuildingMap {
  MapWindow window;
  std::vector<std::uint32_t> building;
  std::uint32_t count = 0;

  std::uint32_t at(const Vec3& p) const {
    const MapPoint m = window.at(p);
    if (!(m.x >= 0 && m.y >= 0 && m.x < static_cast<double>(window.columns) && m.y < static_cast<double>(window.rows)))
      return 0;
    return building[static_cast<std::size_t>(m.y) * window.columns + static_cast<std::size_t>(m.x)];
  }
};

// Ground under a roof, 15 m² or more, most of whose border is walls. Ground on both sides of a wall is one building,
// and so are houses that stand less than half a metre apart. The largest is the first.
BuildingMap buildings_of(const Scene& scene, const SearchMesh& ground);

}  // namespace vantage
