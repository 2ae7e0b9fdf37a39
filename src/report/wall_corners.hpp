// SPDX-License-Identifier: Apache-2.0
// Corners of walls from which a crew finds a station's spot with a tape.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "vantage/types.hpp"

namespace vantage {

// Survey frame, metres.
struct WallCorner {
  double x = 0, y = 0;
  double distance_m = 0;  // from the station, in plan
  bool wall = false;      // no corner, but the nearest point of a wall
};

class WallCorners {
 public:
  static constexpr double kReach_m = 30;  // length of a tape
  // Angles between the directions to two corners within which distances to both locate a spot well.
  static constexpr Angle kLeast = Angle::degrees(30), kMost = Angle::degrees(150);

  // `lines`: curves in which surfaces cross the height of the walls, by `section_lines()`. A corner is a place where
  // two straight stretches of 15 cm or more meet or cross at 30 degrees or more. `above`: the same over the heads of
  // cars and most furniture. Corners and walls below none of these lines may be gone when the crew comes, and do not
  // count. Empty: all count.
  explicit WallCorners(std::span<const std::array<Vec3, 2>> lines,
                       std::optional<std::span<const std::array<Vec3, 2>>> above = std::nullopt);

  // Returns the pair of corners with the least sum of distances, the nearer corner first. Both are within reach and in
  // free sight of the spot, in directions at a good angle. If there is no such pair: the nearest corner, and the
  // nearest point of a wall if its angle is good. Empty without a corner.
  std::vector<WallCorner> nearest(double x, double y) const;
  // True if nothing stands on the straight line from one point to another, seen from above. A line that ends within 1
  // cm of the second point does not count.
  bool sees(double x, double y, double to_x, double to_y) const;
  const std::vector<std::array<double, 2>>& corners() const { return corners_; }

 private:
  // Returns the nearest point of a wall in free sight; farther away than a tape reaches if there is none.
  WallCorner nearest_wall(double x, double y) const;
  struct Line {
    double ax, ay, bx, by;
  };
  // Calls found(index of a line) for lines near a straight line, for some of them several times.
  template <class Found>
  void for_each_near(const Line& line, Found&& found) const;
  std::vector<double> straight_runs() const;
  bool stays(double x, double y) const;

  std::vector<Line> lines_;
  std::optional<std::vector<Line>> above_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_above_;
  std::vector<double> runs_;                                             // of each line, `straight_runs()`
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;  // lines by square metre
  std::vector<std::array<double, 2>> corners_;
};

}  // namespace vantage
