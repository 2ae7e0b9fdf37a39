// SPDX-License-Identifier: Apache-2.0
#include "map/left_out_hatch.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

// A table of 1 x 1 m at z = 0.75 over a floor at 0, on a map of 2 x 2 m.
TEST(LeftOutHatch, CoversWhatShowsAndNothingElse) {
  const MapWindow window{.x_min = 0, .y_max = 2, .pixel_m = 0.01, .columns = 200, .rows = 200};
  HeightBuffer heights{window, std::vector<float>(200 * 200, 0.0f), {}};
  const auto at = [&](double x, double y) {
    const MapPoint p = window.at({x, y, 0});
    return static_cast<std::size_t>(p.y) * 200 + static_cast<std::size_t>(p.x);
  };
  for (double x = 0.505; x < 1.5; x += 0.01)
    for (double y = 0.505; y < 1.5; y += 0.01) heights.z[at(x, y)] = 0.75f;
  LeftOut table;
  table.positions = {{0.5, 0.5, 0.75}, {1.5, 0.5, 0.75}, {1.5, 1.5, 0.75}, {0.5, 1.5, 0.75}};
  table.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<LeftOut> left_out{table};
  const auto hatched = [&](const PlanLevel* level) {
    std::vector<std::uint32_t> pixels(200 * 200, 0xFFFFFFFFu);
    std::size_t count = 0;
    const bool any = hatch_left_out(pixels, heights, 0, left_out, level);
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (pixels[k] == 0xFFFFFFFFu) continue;
      ++count;
      EXPECT_EQ(heights.z[k], 0.75f) << "beside the table";
    }
    EXPECT_EQ(any, count > 0);
    return count;
  };
  const PlanLevel here{.floor = 0, .low = -1, .high = 2}, above{.floor = 3, .low = 2};
  EXPECT_NEAR(static_cast<double>(hatched(nullptr)), 100 * 100 * 4.0 / 22, 100);
  EXPECT_EQ(hatched(&here), hatched(nullptr));
  EXPECT_EQ(hatched(&above), 0u);
  // A sheet just below allowed ground is no part of what shows.
  const SearchMesh allowed{.positions = {{0.5, 0.5, 0.8}, {1.5, 0.5, 0.8}, {1.5, 1.5, 0.8}, {0.5, 1.5, 0.8}},
                           .uvs = {},
                           .triangles = {{0, 1, 2}, {0, 2, 3}}};
  std::vector<std::uint32_t> pixels(200 * 200, 0xFFFFFFFFu);
  EXPECT_FALSE(hatch_left_out(pixels, heights, 0, left_out, nullptr, allowed));
  for (float& z : heights.z) z = 3;  // under a roof
  EXPECT_EQ(hatched(nullptr), 0u);
}

}  // namespace
}  // namespace vantage
