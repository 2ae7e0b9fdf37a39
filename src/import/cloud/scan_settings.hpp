// SPDX-License-Identifier: Apache-2.0
// Settings of a scan, estimated from its points: steps between rays, field of view, ranges.
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
  // Adds a point in the scanner's frame, metres, with its row and column in the scan's grid.
  void add(const Eigen::Vector3d& p, std::optional<std::array<std::uint32_t, 2>> cell);

  // Returns degrees and metres: `azimuth` (middle and width of the sweep), `zenith` (first and last), `range` (nearest
  // and farthest, without lone points), `step` (of azimuth and zenith, or null) and `by_grid`: true if the grid tells
  // the steps, false if the density of points does. Null without points.
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
