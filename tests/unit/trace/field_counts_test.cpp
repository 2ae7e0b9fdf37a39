// SPDX-License-Identifier: Apache-2.0
#include "trace/field_counts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/philox.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {
namespace {

VoxelField random_field(std::size_t voxels, std::uint32_t stations, std::uint64_t seed) {
  RandomStream random(seed);
  VoxelField field;
  field.count.resize(voxels);
  for (std::uint32_t first = 0; first < stations; first += 64)
    for (std::size_t k = 0; k < voxels; ++k) {
      const std::uint64_t bits =
          (std::uint64_t{random.bits()} << 32 | random.bits()) & (std::uint64_t{random.bits()} << 32 | random.bits());
      const std::uint32_t here = stations - first;
      field.stations.push_back(k % 5 == 0 ? 0 : here >= 64 ? bits : bits & ((std::uint64_t{1} << here) - 1));
      if (field.stations.back() != 0) field.count[k] = random.bits() % 100;
    }
  return field;
}

TEST(FieldCounts, EqualTheBookForAnySizeAndNumberOfStations) {
  for (const std::uint32_t stations : {1u, 2u, 3u, 15u, 33u, 64u, 65u, 200u}) {
    for (const std::size_t voxels : {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65},
                                     std::size_t{3000}, std::size_t{70'001}}) {
      if (stations > 64 && voxels > 3000) continue;  // the reference is slow
      SCOPED_TRACE(std::to_string(stations) + " stations, " + std::to_string(voxels) + " voxels");
      VoxelField field = random_field(voxels, stations, stations * 1000 + voxels);
      if (voxels > 0)
        test::expect_equal_counts(reduce_field(field.count, field.stations, stations, 37.3),
                                  test::reference_counts(field, stations, 37.3));
      field.stations.clear();
      test::expect_equal_counts(reduce_field(field.count, {}, stations, 37.3),
                                test::reference_counts(field, stations, 37.3));
    }
  }
}

TEST(FieldCounts, WeightsAndGoalsCountInCoverageAlone) {
  const VoxelField field = random_field(70'001, 15, 3);
  RandomStream random(8);
  VoxelDemands demands;
  for (std::size_t k = 0; k < field.count.size(); ++k)
    demands.weights.push_back(static_cast<std::uint8_t>(1 + random.bits() % 255));
  const NetworkCounts weighted = reduce_field(field.count, field.stations, 15, 37.3, demands);
  test::expect_equal_counts(weighted, test::reference_counts(field, 15, 37.3, demands));
  for (std::size_t k = 0; k < field.count.size(); ++k)
    demands.point_weights.push_back(densest_point_weight + static_cast<std::uint32_t>(random.bits() % (1u << 20)));
  const NetworkCounts valued = reduce_field(field.count, field.stations, 15, 370.3, demands);
  test::expect_equal_counts(valued, test::reference_counts(field, 15, 370.3, demands));
  EXPECT_GT(valued.saturated, 0u);
  EXPECT_LT(valued.saturated, valued.weight);
  EXPECT_EQ(weighted.shared, reduce_field(field.count, field.stations, 15, 37.3).shared);
  EXPECT_GT(weighted.weight, 2 * weighted.voxels);
}

TEST(FieldCounts, AVoxelIsFullAtTheGoalRoundedUp) {
  const std::vector<std::uint32_t> counts{60, 61, 62, 0xFFFFFFFFu};
  EXPECT_EQ(reduce_field(counts, {}, 1, 61.3).saturated, 2u);
  EXPECT_EQ(reduce_field(counts, {}, 1, 61.3).partial_points, 121u);
  EXPECT_EQ(reduce_field(counts, {}, 1, 61).saturated, 3u);
}

TEST(FieldCounts, SumsDoNotWrap) {
  const std::vector<std::uint32_t> counts(5, 0xFFFFFFFEu);
  EXPECT_EQ(reduce_field(counts, {}, 1, 4294967295.0).partial_points, 5 * std::uint64_t{0xFFFFFFFEu});
}

TEST(SampleCounts, GroupsInterleaveAndAddUp) {
  const VoxelField field = random_field(1003, 7, 5);
  const NetworkCounts all = reduce_sample(field.count, field.stations, 20, 7, 50);
  test::expect_equal_counts(all, test::reference_counts(field, 7, 50));
  ASSERT_EQ(all.groups.size(), 20u);
  for (std::size_t g = 0; g < 20; ++g) {
    VoxelField part;
    for (std::size_t i = g; i < field.count.size(); i += 20) {
      part.count.push_back(field.count[i]);
      part.stations.push_back(field.stations[i]);
    }
    test::expect_equal_counts(all.groups[g], test::reference_counts(part, 7, 50));
  }
  double differences = 0;
  for (std::size_t i = 1; i < field.count.size(); ++i)
    differences += std::pow(std::min(field.count[i] / 50.0, 1.0) - std::min(field.count[i - 1] / 50.0, 1.0), 2);
  EXPECT_NEAR(all.successive_difference_sum, differences, 1e-9 * differences);
}

TEST(SampleCounts, MoreGroupsThanVoxelsLeaveSomeEmpty) {
  const VoxelField field = random_field(3, 4, 9);
  const NetworkCounts all = reduce_sample(field.count, field.stations, 20, 4, 50);
  ASSERT_EQ(all.groups.size(), 20u);
  EXPECT_EQ(all.groups[2].voxels, 1u);
  EXPECT_EQ(all.groups[3].voxels, 0u);
  EXPECT_EQ(all.groups[3].seen, std::vector<std::uint64_t>(4, 0));
  EXPECT_EQ(all.groups[3].shared, std::vector<std::uint64_t>(6, 0));
}

}  // namespace
}  // namespace vantage
