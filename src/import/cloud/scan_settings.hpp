// SPDX-License-Identifier: Apache-2.0
// What the points of a scan tell of how it was made: the steps between rays, the field of view, the ranges.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace vantage::importer {

class ScanSettings {
 public:
  // A point in the scanner's frame, metres, and its row and column in the scan's grid.
  void add(const Eigen::Vector3d& p, std::optional<std::array<std::uint32_t, 2>> cell);

  // Degrees and metres: `azimuth` (middle and width of the sweep), `zenith` (first and last), `range` (from which to
  // which there are points, without lone ones), `step` (of azimuth and zenith, or null) and `by_grid`: whether the grid
  // tells the steps, or the density of points. Null without points.
  nlohmann::json as_json() const;

 private:
  struct Sample {
    double azimuth, zenith;  // degrees
    std::uint32_t row, column;
  };
  static constexpr int kAzimuths = 360, kZeniths = 180;  // cells of one degree
  static constexpr std::size_t kRanges = 400;

  std::optional<std::array<double, 2>> steps_by_grid() const;
  std::optional<double> step_by_density() const;

  std::uint64_t points_ = 0, random_ = 0;
  std::vector<Sample> samples_;                                                               // of points with a cell
  std::vector<std::uint32_t> directions_ = std::vector<std::uint32_t>(kAzimuths * kZeniths);  // points in each
  std::vector<std::uint64_t> ranges_ = std::vector<std::uint64_t>(kRanges);
};

}  // namespace vantage::importer
