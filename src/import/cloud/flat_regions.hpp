// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "import/cloud/cell_grid.hpp"
#include "import/cloud/free_space.hpp"

namespace vantage::importer {

// A plane and the columns of cells in which it stands for points. Columns run along `axis`, the normal's largest part;
// their two numbers are those of the axes after it.
struct FlatRegion {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // to where it was seen from
  Eigen::Vector3d base = Eigen::Vector3d::Zero();     // a place near it, in cells
  double offset = 0;                                  // normal · (x - base) = offset
  int axis = 2;
  std::vector<std::array<std::int32_t, 2>> columns;

  // Height along the axis at a place of the other two.
  double height(double u, double v) const;
};

// The planes of cells and their neighbours.
std::vector<CellPlane> cell_planes(const CellGrid& grid);

// Drops groups of cells too small to be anything but noise. Returns the number of cells.
std::uint32_t drop_lone(CellGrid& grid);

// Regions of cells that lie in one plane within the noise of the points, and single cells elsewhere. Each cell belongs
// to one, or, in an edge, to those of its neighbours.
std::vector<FlatRegion> flat_regions(const CellGrid& grid, const std::vector<CellPlane>& planes);

}  // namespace vantage::importer
