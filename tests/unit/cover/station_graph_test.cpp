// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/cover.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

TEST(StationGraph, CountsWhatBothCover) {
  CoverageMatrix matrix(std::vector<std::uint32_t>(70, 1), 1);
  std::vector<std::uint32_t> first(70, 0), second(70, 0);
  for (std::size_t e = 0; e < 40; ++e) first[e] = 1;
  for (std::size_t e = 30; e < 70; e += 2) second[e] = 5;
  matrix.add(first), matrix.add(second);
  const StationGraph graph(matrix, 3);
  EXPECT_FLOAT_EQ(graph.overlap(0, 1), 5.0F / 20);  // of the smaller one
  EXPECT_FLOAT_EQ(graph.overlap(1, 0), 5.0F / 20);
  EXPECT_EQ(graph.overlap(0, 2), 0) << "of which nothing is known";
  EXPECT_TRUE(graph.linked(0, 1, 0.25));
  EXPECT_FALSE(graph.linked(0, 1, 0.26));
  EXPECT_FALSE(StationGraph(1, std::vector<float>{1}).linked(0, 0, 0.5)) << "with itself";
  EXPECT_THROW(StationGraph(2, std::vector<float>{0, 1, 1}), Error);
}

TEST(StationGraph, ExcludesPairsThatStandTooNear) {
  StationGraph graph(3);
  EXPECT_FALSE(graph.excluded(0, 1));
  const std::vector<Vec3> positions{{0, 0, 0}, {0, 0.6, 0.8}, {5, 0, 0}};
  graph.exclude_nearer(positions, 1);
  EXPECT_FALSE(graph.excluded(0, 1));
  graph.exclude_nearer(positions, 1.01);
  EXPECT_TRUE(graph.excluded(0, 1) && graph.excluded(1, 0));
  EXPECT_FALSE(graph.excluded(0, 2));
  graph.exclude(2, 0);
  EXPECT_TRUE(graph.excluded(0, 2) && graph.excluded(2, 0));
}

TEST(StationGraph, ExcludesPairsNearerThanTheirOwnDistanceUnlessTheyAreParted) {
  StationGraph graph(4);
  const std::vector<Vec3> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 5}};
  const std::vector<double> least{3, 2.5, 1.5, 9};
  const auto wall = [](std::size_t i, std::size_t j) { return i + j == 1; };
  graph.exclude_nearer(positions, least, [](std::size_t, std::size_t) { return false; });
  EXPECT_TRUE(graph.excluded(0, 1) && graph.excluded(1, 0)) << "2 m, and each wants 2.5 m";
  EXPECT_FALSE(graph.excluded(0, 2)) << "2 m, and one wants 1.5 m";
  EXPECT_FALSE(graph.excluded(0, 3)) << "5 m, and one wants 3 m";
  StationGraph parted(4);
  parted.exclude_nearer(positions, least, wall);
  EXPECT_FALSE(parted.excluded(0, 1)) << "a wall is between them";
}

}  // namespace
}  // namespace vantage
