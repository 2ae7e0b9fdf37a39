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
  static constexpr double kReach_m = 30;  // of a tape
  // Between what directions to two corners a spot is found well by its distances to them.
  static constexpr Angle kLeast = Angle::degrees(30), kMost = Angle::degrees(150);

  // `lines`: where surfaces cross the height of the walls, as `section_lines()` has them. A corner is where two
  // straight stretches of 15 cm or more meet or cross at 30 degrees or more. `above`: the same lines over the heads of
  // cars and most furniture; corners and walls with none of these over them may be gone when the crew comes, and do not
  // count. Empty: all count.
  explicit WallCorners(std::span<const std::array<Vec3, 2>> lines,
                       std::optional<std::span<const std::array<Vec3, 2>>> above = std::nullopt);

  // Of the pairs of corners in free sight of a spot, within reach, whose directions make a good angle, the one with the
  // least sum of distances, the nearer corner first. Where there is no such pair, the nearest corner, and the nearest
  // point of a wall if that makes a good angle with it; none where there is no corner.
  std::vector<WallCorner> nearest(double x, double y) const;
  // Whether nothing stands on the straight line from one point to another, seen from above. A line that ends within
  // 1 cm of the second point does not stand in its way.
  bool sees(double x, double y, double to_x, double to_y) const;
  const std::vector<std::array<double, 2>>& corners() const { return corners_; }

 private:
  // Of the walls in free sight; further than a tape reaches where there is none.
  WallCorner nearest_wall(double x, double y) const;
  struct Line {
    double ax, ay, bx, by;
  };
  // Calls found(number of a line) for lines near a straight line, some of them several times.
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
