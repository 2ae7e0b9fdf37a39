// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "vantage/measure.hpp"

namespace vantage {
namespace {

using Pair = std::pair<std::size_t, std::size_t>;

TEST(Connectivity, TwoTripletsByOneBridge) {
  OverlapMatrix overlap(6);
  for (const auto& [i, j] : {Pair{0, 1}, {1, 2}, {0, 2}, {3, 4}, {4, 5}, {3, 5}}) overlap.set(i, j, 0.4);
  overlap.set(2, 3, 0.05);
  const Connectivity joined = connectivity(overlap, 0.01);
  EXPECT_EQ(joined.parts, 1u);
  EXPECT_EQ(joined.bridges, (std::vector<Pair>{{2, 3}}));
  EXPECT_EQ(joined.weakest_link, (Pair{2, 3}));
  EXPECT_EQ(joined.weakest_overlap, 0.05);
  const Connectivity apart = connectivity(overlap, 0.1);
  EXPECT_EQ(apart.parts, 2u);
  EXPECT_TRUE(apart.bridges.empty());
  EXPECT_EQ(apart.part, (std::vector<std::size_t>{0, 0, 0, 1, 1, 1}));
}

TEST(Connectivity, ChainsAreAllBridges) {
  OverlapMatrix overlap(4);
  overlap.set(0, 2, 0.3), overlap.set(2, 1, 0.2), overlap.set(1, 3, 0.5);
  const Connectivity chain = connectivity(overlap, 0);
  EXPECT_EQ(chain.parts, 1u);
  EXPECT_EQ(chain.bridges, (std::vector<Pair>{{0, 2}, {1, 2}, {1, 3}}));
  EXPECT_EQ(chain.weakest_link, (Pair{1, 2}));
}

TEST(Connectivity, SmallNetworks) {
  EXPECT_EQ(connectivity(OverlapMatrix(), 0.1).parts, 0u);
  EXPECT_EQ(connectivity(OverlapMatrix(1), 0.1).parts, 1u);
  EXPECT_EQ(connectivity(OverlapMatrix(3), 0).parts, 3u);  // zero overlap is no link
}

TEST(Connectivity, BridgesAreTheLinksWhoseLossParts) {
  std::mt19937 random(11);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 2 + random() % 9;
    OverlapMatrix overlap(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (random() % 4 == 0) overlap.set(i, j, 0.1 + 0.001 * static_cast<double>(random() % 900));
    const Connectivity whole = connectivity(overlap, 0.2);
    std::vector<Pair> bridges;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        const double value = overlap(i, j);
        if (value < 0.2) continue;
        overlap.set(i, j, 0);
        if (connectivity(overlap, 0.2).parts > whole.parts) bridges.emplace_back(i, j);
        overlap.set(i, j, value);
      }
    }
    EXPECT_EQ(whole.bridges, bridges) << "round " << round;
    // The network is connected at the weakest link's overlap and not just above it.
    if (whole.parts == 1 && n > 1) {
      EXPECT_EQ(connectivity(overlap, whole.weakest_overlap).parts, 1u);
      EXPECT_GT(connectivity(overlap, whole.weakest_overlap * 1.0000001).parts, 1u);
      EXPECT_EQ(overlap(whole.weakest_link.first, whole.weakest_link.second), whole.weakest_overlap);
    }
  }
}

}  // namespace
}  // namespace vantage
