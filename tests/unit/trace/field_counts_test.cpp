// SPDX-License-Identifier: Apache-2.0
#include "trace/field_counts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "core/philox.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {
namespace {

PassField random_field(std::size_t voxels, std::uint32_t stations, std::uint64_t seed) {
  RandomStream random(seed);
  PassField field;
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
      PassField field = random_field(voxels, stations, stations * 1000 + voxels);
      if (voxels > 0)
        test::expect_equal_counts(reduce_field(field.count, field.stations, stations, 37.3),
                                  test::reference_counts(field, stations, 37.3));
      field.stations.clear();
      test::expect_equal_counts(reduce_field(field.count, {}, stations, 37.3),
                                test::reference_counts(field, stations, 37.3));
    }
  }
}

// Each 64 stations see their own stretch of the voxels, as they do of a large site.
PassField field_of_stretches(std::size_t voxels, std::uint32_t stations) {
  PassField field = random_field(voxels, stations, 11);
  const std::size_t words = mask_words(stations);
  for (std::size_t w = 0; w < words; ++w)
    for (std::size_t k = 0; k < voxels; ++k)
      if (k * words / voxels != w) field.stations[w * voxels + k] = 0;
  return field;
}

StationMasks kept(const PassField& field, std::uint32_t stations) {
  StationMasks masks(field.count.size(), stations);
  for (std::size_t w = 0; w < masks.words(); ++w)
    masks.set_words(w, std::span(field.stations).subspan(w * field.count.size(), field.count.size()));
  return masks;
}

TEST(FieldCounts, OfKeptMasksAreThoseOfAllWords) {
  for (const std::uint32_t stations : {1u, 64u, 65u, 200u})
    for (const std::size_t voxels : {std::size_t{1}, std::size_t{4096}, std::size_t{4097}, std::size_t{70'001}}) {
      SCOPED_TRACE(std::to_string(stations) + " stations, " + std::to_string(voxels) + " voxels");
      const PassField field = field_of_stretches(voxels, stations);
      test::expect_equal_counts(reduce_field({field.count, kept(field, stations)}, stations, 37.3),
                                reduce_field(field.count, field.stations, stations, 37.3));
    }
}

TEST(StationMasks, KeepOnlyBlocksWithAPoint) {
  constexpr std::size_t voxels = 70'001;
  constexpr std::uint32_t stations = 200;
  const PassField field = field_of_stretches(voxels, stations);
  StationMasks masks = kept(field, stations);
  EXPECT_EQ(masks.voxels(), voxels);
  ASSERT_EQ(masks.words(), 4u);
  EXPECT_EQ(masks.all_words(), field.stations);
  for (std::size_t w = 0; w < 4; ++w) {
    std::size_t empty = 0;
    for (std::size_t k = 0; k < 18; ++k) empty += masks.block(w, k).empty();
    EXPECT_GE(empty, 12u) << "of 18";
  }
  for (const std::size_t voxel : {std::size_t{1}, std::size_t{40'001}, voxels - 2}) {
    std::vector<std::size_t> expected, seen;
    for (std::size_t s = 0; s < stations; ++s)
      if (field.stations[s / 64 * voxels + voxel] >> (s % 64) & 1) expected.push_back(s);
    masks.for_each_station(voxel, [&](std::size_t s) { seen.push_back(s); });
    EXPECT_EQ(seen, expected);
    EXPECT_FALSE(seen.empty());
  }
  const std::vector<std::uint64_t> none(voxels, 0);
  for (std::size_t w = 0; w < 4; ++w) masks.set_words(w, none);
  EXPECT_EQ(masks, StationMasks(voxels, stations)) << "as if no station had had a point";
  EXPECT_TRUE(StationMasks().empty());
}

TEST(FieldCounts, WeightsAndGoalsCountInCoverageAlone) {
  const PassField field = random_field(70'001, 15, 3);
  RandomStream random(8);
  VoxelDemands demands;
  for (std::size_t k = 0; k < field.count.size(); ++k)
    demands.weights.push_back(static_cast<std::uint8_t>(1 + random.bits() % 255));
  const NetworkCounts weighted = reduce_field(field.count, field.stations, 15, 37.3, demands);
  test::expect_equal_counts(weighted, test::reference_counts(field, 15, 37.3, demands));
  for (std::size_t k = 0; k < field.count.size(); ++k)
    demands.point_weights.push_back(kDensestPointWeight + static_cast<std::uint32_t>(random.bits() % (1u << 20)));
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
  const PassField field = random_field(1003, 7, 5);
  const NetworkCounts all = reduce_sample(field.count, field.stations, 20, 7, 50);
  test::expect_equal_counts(all, test::reference_counts(field, 7, 50));
  ASSERT_EQ(all.groups.size(), 20u);
  for (std::size_t g = 0; g < 20; ++g) {
    PassField part;
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
  const PassField field = random_field(3, 4, 9);
  const NetworkCounts all = reduce_sample(field.count, field.stations, 20, 4, 50);
  ASSERT_EQ(all.groups.size(), 20u);
  EXPECT_EQ(all.groups[2].voxels, 1u);
  EXPECT_EQ(all.groups[3].voxels, 0u);
  EXPECT_EQ(all.groups[3].seen, std::vector<std::uint64_t>(4, 0));
  EXPECT_EQ(all.groups[3].shared, std::vector<std::uint64_t>(6, 0));
}

}  // namespace
}  // namespace vantage
