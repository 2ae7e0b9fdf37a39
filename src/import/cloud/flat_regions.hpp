// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "import/cloud/cell_grid.hpp"
#include "import/cloud/free_space.hpp"

namespace vantage::importer {

// A plane, and the columns of cells whose points it stands for. Columns run along `axis`, the largest component of the
// normal; the two numbers of a column are its cells along the next two axes.
struct FlatRegion {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // towards the scanners
  Eigen::Vector3d base = Eigen::Vector3d::Zero();     // a place near it, in cells
  double offset = 0;                                  // normal · (x - base) = offset
  int axis = 2;
  std::vector<std::array<std::int32_t, 2>> columns;

  // Returns the height along the axis at coordinates u, v of the other two.
  double height(double u, double v) const;
};

// Fits a plane to each cell together with its neighbours.
std::vector<CellPlane> cell_planes(const CellGrid& grid);

// Drops groups of cells too small to be anything but noise. Returns the number of dropped cells.
std::uint32_t drop_lone(CellGrid& grid);

// Returns regions of cells that lie in one plane within the noise of the points, and single cells elsewhere. Each cell
// belongs to one region; a cell at an edge belongs to those of its neighbours.
std::vector<FlatRegion> flat_regions(const CellGrid& grid, const std::vector<CellPlane>& planes);

}  // namespace vantage::importer
