// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

std::vector<PlacedStation> stations(std::size_t count) { return std::vector<PlacedStation>(count); }

// 0–1–2 in a chain, 3–4 a pair that is near to 2, 5 by itself, 6 in a hole.
TEST(StationLinks, TellPartsAndWhereTheyAreNearest) {
  OverlapMatrix overlap(7);
  overlap.set(0, 1, 0.4), overlap.set(1, 2, 0.25), overlap.set(3, 4, 0.5), overlap.set(2, 3, 0.004);
  overlap.set(0, 4, 0.002);
  overlap.set(6, 5, 0.9);
  std::vector<PlacedStation> seven = stations(7);
  seven[6].status = StationStatus::hole;
  const StationLinks links = station_links(overlap, 0.01, seven);
  EXPECT_EQ(links.parts, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {3, 4}, {5}}));
  EXPECT_FALSE(links.weakest);
  ASSERT_EQ(links.gaps.size(), 2u);
  EXPECT_EQ(links.gaps[0].inside, 3u);
  EXPECT_EQ(links.gaps[0].outside, 2u);
  EXPECT_EQ(links.gaps[0].value, 0.004);
  EXPECT_EQ(links.gaps[1].inside, 5u);
  EXPECT_EQ(links.gaps[1].value, 0);
}

TEST(StationLinks, TellTheWeakestOfTheStrongestTree) {
  OverlapMatrix ring(3);
  ring.set(0, 1, 0.4), ring.set(1, 2, 0.25), ring.set(0, 2, 0.1);
  const StationLinks links = station_links(ring, 0.01, stations(3));
  ASSERT_TRUE(links.weakest);
  EXPECT_EQ(*links.weakest, (std::pair<std::size_t, std::size_t>{1, 2}));
  EXPECT_EQ(links.weakest_value, 0.25);
}

// Two scans of 100 voxels that share 2: 2 of 198 seen by either, 2 of the 100 of one.
TEST(StationLinks, SayWhichOfTheTwoOverlapsTheyGoBy) {
  NetworkCounts counts;
  counts.stations = 2, counts.seen = {100, 100}, counts.shared = {2};
  Evaluation network{.stations = stations(2)};
  EXPECT_FALSE(network.links()) << "nothing is known";
  network.overlap_matrix = overlap_matrix(counts);
  ASSERT_TRUE(network.links());
  EXPECT_EQ(network.links()->measure, LinkMeasure::overlap);
  EXPECT_EQ(network.links()->least, default_link_overlap);
  EXPECT_DOUBLE_EQ(network.links()->weakest_value, 2.0 / 198);
  network.scan_overlap_matrix = scan_overlap_matrix(counts);
  EXPECT_EQ(network.links()->measure, LinkMeasure::scan_overlap);
  EXPECT_EQ(network.links()->parts.size(), 2u) << "less than the 30 % that practice wants";
  network.link = 0.02;
  EXPECT_DOUBLE_EQ(network.links()->weakest_value, 0.02);
}

}  // namespace
}  // namespace vantage
