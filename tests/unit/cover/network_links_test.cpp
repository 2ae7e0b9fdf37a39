// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "cover/network.hpp"
#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

// The components of some members by definition: each takes the least label of those that it is linked to, until none
// changes. The member itself is its label to begin with; the one that is left out has no part in it.
std::vector<std::size_t> labels(const StationGraph& graph, std::size_t without) {
  std::vector<std::size_t> of(graph.size());
  std::iota(of.begin(), of.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < of.size(); ++a)
      for (std::size_t b = 0; b < of.size(); ++b)
        if (a != without && b != without && graph.overlap(a, b) > 0 && of[b] < of[a]) of[a] = of[b], changed = true;
  }
  return of;
}

// From forests in which each member cuts off another, to networks that no member cuts.
TEST(NetworkLinks, KnowsWhatFallsApartWithoutAMember) {
  constexpr std::size_t size = 24;
  std::size_t cutting = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const CoverageMatrix matrix = test::random_matrix(size, 4, seed);
    const StationGraph graph = test::random_links(size, seed, 0.03 + 0.004 * static_cast<double>(seed % 30));
    const CoverProblem problem{.matrix = matrix, .graph = &graph, .link = 0.5};
    std::vector<std::size_t> network(size);
    std::iota(network.begin(), network.end(), std::size_t{0});
    const NetworkLinks links(problem, network, problem.link);
    const NetworkLinks::Trees trees = links.trees();
    for (std::size_t at = 0; at <= size; ++at) {  // the last is no member: all are there
      const Components found = links.components_without(at, trees);
      const std::vector<std::size_t> right = labels(graph, at);
      std::map<std::size_t, std::size_t> component;  // by label
      for (std::size_t k = 0; k < size; ++k) {
        if (k == at) {
          EXPECT_EQ(found.of[k], size);
          continue;
        }
        EXPECT_EQ(component.emplace(right[k], found.of[k]).first->second, found.of[k]) << seed << ": " << k;
      }
      EXPECT_EQ(found.count, component.size()) << "seed " << seed << " without " << at;
      for (const auto& [label, of] : component) EXPECT_LT(of, found.count);
      if (at == size) continue;
      EXPECT_EQ(trees.without[at], found.count);
      cutting += found.count > links.components().count;
    }
  }
  EXPECT_GT(cutting, 100u);
}

TEST(NetworkLinks, AreOneComponentWhereLinksAreNotAskedFor) {
  const CoverageMatrix matrix = test::random_matrix(5, 4, 1);
  const CoverProblem problem{.matrix = matrix};
  const NetworkLinks links(problem, std::vector<std::size_t>{0, 2, 4}, 0);
  EXPECT_EQ(links.components().count, 1u);
  EXPECT_EQ(links.trees().without, std::vector<std::size_t>(3, 1));
}

}  // namespace
}  // namespace vantage
