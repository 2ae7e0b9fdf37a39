// SPDX-License-Identifier: Apache-2.0
// Free space that the rays of scans passed through, and cells that cannot belong to the site.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "import/cloud/cell_grid.hpp"

namespace vantage::importer {

// The plane in a cell, about the cell's middle.
struct CellPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset = 0, thickness = 0, width = 0;
};

class FreeSpace {
 public:
  // `planes`: one for each cell. Both must outlive the object.
  FreeSpace(CellGrid& grid, const std::vector<CellPlane>& planes);

  // Follows a ray from a scanner to its point, in cells of the grid. Each cell that only another scan saw counts the
  // ray if the ray crosses it well before its end.
  void add_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, std::uint16_t scan);

  // Returns true if the coarse cell at a place was seen through or holds surface.
  bool known(const Eigen::Vector3d& place) const;
  double coarse_cells() const { return coarse_; }  // side of a coarse cell, in cells

 private:
  static constexpr std::int32_t kSide = 8;  // of a brick, in coarse cells
  static constexpr std::uint8_t kFree = 1, kSurface = 2;
  using Brick = std::array<std::uint8_t, kSide * kSide * kSide>;

  static std::uint64_t brick_key(const CellIndex& coarse);
  static std::size_t place_in_brick(const CellIndex& coarse);
  std::uint8_t& state(const CellIndex& coarse);
  void test_cells(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double begin, double end,
                  std::uint16_t scan);

  CellGrid& grid_;
  const std::vector<CellPlane>& planes_;
  std::int32_t coarse_ = 1;
  Eigen::Array3d low_, high_;  // of the box in which rays are followed, in cells
  std::unordered_map<std::uint64_t, Brick> bricks_;
  std::uint64_t last_key_ = UINT64_MAX;
  Brick* last_ = nullptr;
};

// Drops cells that rays of other scans went through. Returns the number of dropped cells.
std::uint32_t drop_seen_through(CellGrid& grid);

}  // namespace vantage::importer
