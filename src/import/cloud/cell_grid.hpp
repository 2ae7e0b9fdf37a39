// SPDX-License-Identifier: Apache-2.0
// Points summed up in the cells of a cubic grid: memory grows with the surface, not with the points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace vantage::importer {

using CellIndex = Eigen::Vector3i;

// First and second moments of points, in cells, about a place that the caller chooses.
struct Moments {
  double count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  // Adds moments about a place that lies at `shift`.
  void add(const Moments& other, const Eigen::Vector3d& shift);
  Eigen::Vector3d mean() const { return sum / count; }
  Eigen::Matrix3d covariance() const { return products / count - mean() * mean().transpose(); }
  // Returns the mean square distance from the plane normal · x = offset.
  double square_distance(const Eigen::Vector3d& normal, double offset) const;
};

struct Cell {
  static constexpr std::uint16_t kSeveralScans = 0xFFFF;
  std::uint64_t key = 0;
  std::uint32_t count = 0;
  std::uint16_t scan = 0;         // the only scan that saw it, or `kSeveralScans`
  std::uint8_t seen_through = 0;  // rays of other scans that went through it
  bool kept = true;
  std::array<float, 3> sum{}, towards{};  // about its middle, in cells; summed unit vectors to the scanner
  std::array<float, 6> products{};        // xx xy xz yy yz zz

  Moments moments() const;
};

class CellGrid {
 public:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  static constexpr std::int32_t kReach = 1 << 20;         // cells from the middle
  static constexpr double kBytesEach = 3 * sizeof(Cell);  // with all that is kept for a cell until the end

  CellGrid(const Eigen::Vector3d& middle, double cell_m);

  // Returns false if the point lies too far away. `towards`: a unit vector to the scanner, or 0.
  bool add(const Eigen::Vector3d& p, std::uint16_t scan, const Eigen::Vector3d& towards);

  double cell_m() const { return cell_m_; }
  const Eigen::Vector3d& middle() const { return middle_; }
  Eigen::Vector3d in_cells(const Eigen::Vector3d& p) const { return (p - middle_) / cell_m_; }

  std::uint32_t size() const { return static_cast<std::uint32_t>(cells_.size()); }
  Cell& operator[](std::uint32_t k) { return cells_[k]; }
  const Cell& operator[](std::uint32_t k) const { return cells_[k]; }
  // Returns the number of the cell there, or `kNone`. Also finds cells that are not kept.
  std::uint32_t find(const CellIndex& index) const;
  static CellIndex index_of(const Cell& cell);
  static Eigen::Vector3d middle_of(const CellIndex& index) { return index.cast<double>().array() + 0.5; }
  // Calls `visit(number, index)` for each of the 26 cells around one that exists.
  template <class Visit>
  void for_all_around(const CellIndex& index, Visit&& visit) const {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          if (x == 0 && y == 0 && z == 0) continue;
          const CellIndex beside = index + CellIndex(x, y, z);
          if (const std::uint32_t k = find(beside); k != kNone) visit(k, beside);
        }
  }
  // Does the same for kept cells only.
  template <class Visit>
  void for_neighbours(const CellIndex& index, Visit&& visit) const {
    for_all_around(index, [&](std::uint32_t k, const CellIndex& beside) {
      if (cells_[k].kept) visit(k, beside);
    });
  }
  // Returns the moments of a cell and its kept neighbours about the cell's middle.
  Moments around(std::uint32_t k) const;

 private:
  static std::optional<std::uint64_t> key_of(const CellIndex& index);
  std::size_t slot_of(std::uint64_t key) const;
  void grow();

  Eigen::Vector3d middle_;
  double cell_m_;
  std::deque<Cell> cells_;            // never moved, so that growing takes no second copy
  std::vector<std::uint32_t> slots_;  // open addressing
};

}  // namespace vantage::importer
