// SPDX-License-Identifier: Apache-2.0
// Table 3 of the method counted independently, in double precision and from the paper alone: own grid, rays, noise and
// sums, nothing from the library.
#pragma once

#include <array>
#include <cstdint>

namespace vantage::test {

// One station at (0, 0, 1.5) facing walls of 5 × 2.5 m perpendicular to the x axis: one at x = 10, two at x = `far`
// with their middles at y = ±`aside`. 360° × 300°, diffuse 0.1, noise of table 1, spacing 6 mm.
struct WallCase {
  double aside, far = 30;
  double step = 0.006 / 10;  // radians: 6 mm at 10 m
  double voxel_size = 0;     // 0: by equation 2 from a user size of 1 cm
};

struct WallCounts {
  double voxel_size = 0, goal_density = 0;
  std::uint64_t voxels = 0, points = 0;
  struct Side {
    std::uint64_t on_surface = 0;
    double coverage = 0;
    std::array<double, 3> lost{};  // points lost per wall: centre, left, right
  } clean, noisy;
  double least_sigma = 0, most_sigma = 0;
};

WallCounts count_walls_in_double(const WallCase& walls);

}  // namespace vantage::test
