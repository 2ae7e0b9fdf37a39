// SPDX-License-Identifier: Apache-2.0
#include "trace/field_counts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/philox.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {
namespace {

NetworkCounts by_the_book(const std::vector<std::uint32_t>& counts, const std::vector<std::uint64_t>& masks,
                          std::uint32_t stations, double goal) {
  NetworkCounts result;
  result.voxels = counts.size();
  result.stations = stations;
  for (const std::uint32_t n : counts) n >= goal ? void(++result.saturated) : void(result.partial_points += n);
  if (masks.empty()) return result;
  for (std::uint32_t i = 0; i < stations; ++i) {
    result.seen.push_back(0);
    for (const std::uint64_t mask : masks) result.seen[i] += mask >> i & 1;
    for (std::uint32_t j = i + 1; j < stations; ++j) {
      result.shared.push_back(0);
      for (const std::uint64_t mask : masks) result.shared.back() += (mask >> i & 1) & (mask >> j & 1);
    }
  }
  return result;
}

void expect_equal(const NetworkCounts& a, const NetworkCounts& b) {
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.stations, b.stations);
  EXPECT_EQ(a.saturated, b.saturated);
  EXPECT_EQ(a.partial_points, b.partial_points);
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.shared, b.shared);
}

struct Field {
  std::vector<std::uint32_t> counts;
  std::vector<std::uint64_t> masks;
};

Field random_field(std::size_t voxels, std::uint32_t stations, std::uint64_t seed) {
  RandomStream random(seed);
  Field field;
  for (std::size_t k = 0; k < voxels; ++k) {
    const std::uint64_t bits =
        (std::uint64_t{random.bits()} << 32 | random.bits()) & (std::uint64_t{random.bits()} << 32 | random.bits());
    field.masks.push_back(k % 5 == 0 ? 0 : stations == 64 ? bits : bits & ((std::uint64_t{1} << stations) - 1));
    field.counts.push_back(field.masks.back() == 0 ? 0 : random.bits() % 100);
  }
  return field;
}

TEST(FieldCounts, EqualTheBookForAnySizeAndNumberOfStations) {
  for (const std::uint32_t stations : {1u, 2u, 3u, 15u, 33u, 64u}) {
    for (const std::size_t voxels : {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65},
                                     std::size_t{3000}, std::size_t{70'001}}) {
      SCOPED_TRACE(std::to_string(stations) + " stations, " + std::to_string(voxels) + " voxels");
      const Field field = random_field(voxels, stations, stations * 1000 + voxels);
      if (voxels > 0)
        expect_equal(reduce_field(field.counts, field.masks, stations, 37.3),
                     by_the_book(field.counts, field.masks, stations, 37.3));
      expect_equal(reduce_field(field.counts, {}, stations, 37.3), by_the_book(field.counts, {}, stations, 37.3));
    }
  }
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
  const Field field = random_field(1003, 7, 5);
  const NetworkCounts all = reduce_sample(field.counts, field.masks, 20, 7, 50);
  expect_equal(all, by_the_book(field.counts, field.masks, 7, 50));
  ASSERT_EQ(all.groups.size(), 20u);
  for (std::size_t g = 0; g < 20; ++g) {
    Field part;
    for (std::size_t i = g; i < field.counts.size(); i += 20) {
      part.counts.push_back(field.counts[i]);
      part.masks.push_back(field.masks[i]);
    }
    expect_equal(all.groups[g], by_the_book(part.counts, part.masks, 7, 50));
  }
  double differences = 0;
  for (std::size_t i = 1; i < field.counts.size(); ++i)
    differences += std::pow(std::min(field.counts[i] / 50.0, 1.0) - std::min(field.counts[i - 1] / 50.0, 1.0), 2);
  EXPECT_NEAR(all.successive_difference_sum, differences, 1e-9 * differences);
}

TEST(SampleCounts, MoreGroupsThanVoxelsLeaveSomeEmpty) {
  const Field field = random_field(3, 4, 9);
  const NetworkCounts all = reduce_sample(field.counts, field.masks, 20, 4, 50);
  ASSERT_EQ(all.groups.size(), 20u);
  EXPECT_EQ(all.groups[2].voxels, 1u);
  EXPECT_EQ(all.groups[3].voxels, 0u);
  EXPECT_EQ(all.groups[3].seen, std::vector<std::uint64_t>(4, 0));
  EXPECT_EQ(all.groups[3].shared, std::vector<std::uint64_t>(6, 0));
}

}  // namespace
}  // namespace vantage
