// SPDX-License-Identifier: Apache-2.0
// Density of a cloud: points in an occupied cell, for cells of several sizes, on a sample of the cells. Memory is
// bounded, whatever the number of points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vantage::importer {

class Density {
 public:
  static constexpr std::array<double, 11> kSizes_m{0.02, 0.025, 0.03, 0.04, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5};

  // `scale`: units of the points in a metre of `kSizes_m`.
  explicit Density(double scale = 1) : scale_(scale) {}

  void add(const Eigen::Vector3d& p);

  std::uint64_t points() const { return points_; }
  // Returns the median along each axis, which single far points do not move.
  Eigen::Vector3d middle() const;
  // Returns true if even the largest cells mostly hold too few points for a plane.
  bool too_thin() const;
  // Returns the cloud's length along each axis, without the farthest 2 % of points at each end.
  Eigen::Vector3d extent() const;
  // Returns the median number of points of an occupied cell, and the estimated number of such cells.
  double median(std::size_t size) const;
  double cells(std::size_t size) const;

 private:
  struct Sample {
    std::uint64_t mask = 0;  // a cell is in the sample if its hash has none of these bits
    std::unordered_map<std::uint64_t, std::uint32_t> counts;
  };

  double scale_;
  std::uint64_t points_ = 0, random_ = 0x9E3779B97F4A7C15;
  std::vector<Eigen::Vector3d> reservoir_;
  std::array<Sample, kSizes_m.size()> samples_;
};

// Returns the index of the smallest size whose cells mostly hold enough points for a plane and fit into `memory` bytes.
// Throws Refused if the cloud is too thin for any.
std::size_t choose_cell(const Density& density, double memory, double bytes_each);

}  // namespace vantage::importer
