// SPDX-License-Identifier: Apache-2.0
#include "core/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "core/philox.hpp"

namespace vantage {
namespace {

// Symmetric weights of all pairs; 0: no edge.
std::vector<std::vector<double>> random_weights(std::size_t n, std::uint64_t seed, double density) {
  RandomStream random(seed);
  std::vector<std::vector<double>> weights(n, std::vector<double>(n, 0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      if (random.uniform() < density) weights[i][j] = weights[j][i] = random.uniform();
  return weights;
}

// True for two nodes if a path of edges of at least `least` connects them (Warshall).
std::vector<std::vector<bool>> reachable(const std::vector<std::vector<double>>& weights, double least) {
  const std::size_t n = weights.size();
  std::vector<std::vector<bool>> reach(n, std::vector<bool>(n, false));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) reach[i][j] = i == j || (weights[i][j] > 0 && weights[i][j] >= least);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (reach[i][k] && reach[k][j]) reach[i][j] = true;
  return reach;
}

TEST(Graph, ComponentsAreWhatPathsReach) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const auto weights = random_weights(seed % 12, seed, 0.15);
    const std::size_t n = weights.size();
    const Components found = components(n, [&](std::size_t i, std::size_t j) { return weights[i][j] > 0; });
    const auto reach = reachable(weights, 0);
    std::size_t numbered = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) EXPECT_EQ(found.of[i] == found.of[j], reach[i][j]) << i << " and " << j;
      EXPECT_LE(found.of[i], numbered) << "numbered by their lowest nodes";
      numbered = std::max(numbered, found.of[i] + 1);
    }
    EXPECT_EQ(found.count, numbered);
  }
}

TEST(Graph, TheWeakestEdgeOfTheStrongestTreeIsTheBottleneck) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const auto weights = random_weights(1 + seed % 10, seed, 0.5);
    const std::size_t n = weights.size();
    const auto tree = strongest_spanning_tree(n, [&](std::size_t i, std::size_t j) { return weights[i][j]; });
    ASSERT_EQ(tree.size(), n - 1);
    std::vector<bool> joined(n, false);
    joined[0] = true;
    double weakest = 1;
    for (const TreeEdge& edge : tree) {
      EXPECT_FALSE(joined[edge.to]);
      EXPECT_TRUE(joined[edge.from] || edge.weight == 0);
      joined[edge.to] = true;
      EXPECT_EQ(edge.weight, edge.weight > 0 ? weights[edge.from][edge.to] : 0);
      weakest = std::min(weakest, edge.weight);
    }
    const auto connected_by = [&](double least) {
      const auto reach = reachable(weights, least);
      return std::ranges::all_of(reach[0], [](bool one) { return one; });
    };
    if (n < 2) continue;
    EXPECT_EQ(connected_by(0), weakest > 0);
    if (weakest == 0) continue;
    EXPECT_TRUE(connected_by(weakest));
    EXPECT_FALSE(connected_by(weakest + 1e-12));
  }
}

}  // namespace
}  // namespace vantage
