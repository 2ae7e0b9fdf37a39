// SPDX-License-Identifier: Apache-2.0
// Bridges by depth-first search: Tarjan, A Note on Finding the Bridges of a Graph, 1974.
#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "core/graph.hpp"
#include "core/parse.hpp"
#include "vantage/measure.hpp"

namespace vantage {

Connectivity connectivity(const PairMatrix& overlap, double min_overlap) {
  check_number(min_overlap, "the least overlap of connected stations", kAnyShare);
  const std::size_t n = overlap.size();
  const auto linked = [&](std::size_t i, std::size_t j) {
    return i != j && overlap(i, j) > 0 && overlap(i, j) >= min_overlap;
  };
  Connectivity result;
  Components found = components(n, linked);
  result.parts = found.count;
  result.part = std::move(found.of);
  std::vector<std::size_t> order(n, 0), low(n, 0);  // 0: not yet seen
  std::size_t counter = 0;
  const std::function<void(std::size_t, std::size_t)> visit = [&](std::size_t i, std::size_t parent) {
    order[i] = low[i] = ++counter;
    for (std::size_t j = 0; j < n; ++j) {
      if (!linked(i, j) || j == parent) continue;
      if (order[j] == 0) {
        visit(j, i);
        if (low[j] > order[i]) result.bridges.emplace_back(std::min(i, j), std::max(i, j));
      }
      low[i] = std::min(low[i], order[j] > order[i] ? low[j] : order[j]);
    }
  };
  for (std::size_t i = 0; i < n; ++i)
    if (order[i] == 0) visit(i, n);
  std::sort(result.bridges.begin(), result.bridges.end());

  if (result.parts == 1 && n > 1) {
    const auto weight = [&](std::size_t i, std::size_t j) { return linked(i, j) ? overlap(i, j) : 0; };
    const std::vector<TreeEdge> tree = strongest_spanning_tree(n, weight);
    const TreeEdge& weakest = *std::ranges::min_element(tree, {}, &TreeEdge::weight);
    result.weakest_link = {std::min(weakest.from, weakest.to), std::max(weakest.from, weakest.to)};
    result.weakest_overlap = weakest.weight;
  }
  return result;
}

}  // namespace vantage
