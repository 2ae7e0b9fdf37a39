// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/count_schedule.hpp"

#include <gtest/gtest.h>

#include <ostream>

#include "core/philox.hpp"
#include "shared/trace_types.h"

namespace vantage::vulkan {
namespace {

struct Shape {
  std::uint32_t stations, rows, columns, rows_per_part;
  double rays;  // requested per submission
};
void PrintTo(const Shape& s, std::ostream* out) {
  *out << s.stations << " stations, " << s.rows << " x " << s.columns << ", " << s.rows_per_part << " rows a part, "
       << s.rays << " rays";
}

class CountSchedules : public testing::TestWithParam<Shape> {};

TEST_P(CountSchedules, EveryRowOfEveryStationComesOnceAndInOrder) {
  const Shape& shape = GetParam();
  CountSchedule schedule(shape.stations, shape.rows, shape.columns, shape.rows_per_part);
  std::uint32_t station = 0, row = 0;
  std::uint64_t rays = 0;
  while (!schedule.finished()) {
    const std::vector<CountPart> parts = schedule.next(shape.rays);
    ASSERT_FALSE(parts.empty());
    rays += schedule.rays_of(parts);
    for (const CountPart& part : parts) {
      EXPECT_EQ(part.station, station);
      EXPECT_EQ(part.first_row, row);
      EXPECT_EQ(part.first_row % tile_side, 0u) << "a tile belongs to one part";
      ASSERT_GE(part.row_count, 1u);
      EXPECT_LE(part.row_count, shape.rows_per_part);
      EXPECT_TRUE(part.row_count <= tile_side || static_cast<double>(part.row_count) * shape.columns <= shape.rays)
          << "no part is more than was asked for";
      row += part.row_count;
      if (row == shape.rows) {
        row = 0;
        ++station;
      }
    }
  }
  EXPECT_EQ(station, shape.stations);
  EXPECT_EQ(row, 0u);
  EXPECT_EQ(rays, schedule.all_rays());
  EXPECT_TRUE(schedule.next(shape.rays).empty());
}

TEST_P(CountSchedules, ASubmissionKeepsItsBounds) {
  const Shape& shape = GetParam();
  CountSchedule schedule(shape.stations, shape.rows, shape.columns, shape.rows_per_part);
  while (!schedule.finished()) {
    const std::vector<CountPart> parts = schedule.next(shape.rays);
    ASSERT_FALSE(parts.empty());
    EXPECT_LE(parts.size(), CountSchedule::kPartsPerSubmission);
    EXPECT_LT(parts.back().slot, CountSchedule::kStationsPerSubmission);
    EXPECT_TRUE(parts.size() == 1 ||
                static_cast<double>(schedule.rays_of(std::span(parts).first(parts.size() - 1))) < shape.rays)
        << "the last part begins below what was asked for";
    std::uint64_t free = 0;  // lists are contiguous
    for (std::size_t k = 0; k < parts.size(); ++k) {
      EXPECT_EQ(parts[k].list, free);
      free += 1 + schedule.tiles_of(parts[k]);
      if (k > 0) {
        EXPECT_EQ(parts[k].slot == parts[k - 1].slot, parts[k].station == parts[k - 1].station);
      }
    }
    EXPECT_LE(free, schedule.list_words());
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, CountSchedules,
                         testing::Values(Shape{15, 7200, 10000, 1856, 1e9}, Shape{1, 1, 1, tile_side, 1},
                                         Shape{40, 300, 600, tile_side, 1}, Shape{40, 33, 7, tile_side, 1e12},
                                         Shape{3, 20000, 5, tile_side, 1e12}, Shape{64, 100, 31, 64, 7777},
                                         Shape{0, 10, 10, tile_side, 100}));

TEST(CountHeadroom, NoCountWrapsAndNoClampIsInVain) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed);
    CountHeadroom headroom;
    std::uint64_t most = 0;  // count of a voxel that every ray hits
    for (int k = 0; k < 1000; ++k) {
      const auto rays = static_cast<std::uint64_t>(random.uniform() * random.uniform() * (count_limit - 1));
      const std::uint64_t unclamped = most + rays;
      if (headroom.clamp_before(rays)) {
        EXPECT_GE(unclamped, count_limit) << "seed " << seed;
        most = std::min<std::uint64_t>(most, count_limit);
      }
      most += rays;
      ASSERT_LT(most, std::uint64_t{1} << 32) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace vantage::vulkan
