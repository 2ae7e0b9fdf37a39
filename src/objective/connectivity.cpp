// SPDX-License-Identifier: Apache-2.0
// Bridges by depth-first search: Tarjan, A Note on Finding the Bridges of a Graph, 1974.
#include <algorithm>
#include <functional>

#include "vantage/measure.hpp"

namespace vantage {

Connectivity connectivity(const PairMatrix& overlap, double min_overlap) {
  const std::size_t n = overlap.size();
  const auto linked = [&](std::size_t i, std::size_t j) {
    return i != j && overlap(i, j) > 0 && overlap(i, j) >= min_overlap;
  };
  Connectivity result;
  result.part.assign(n, 0);
  std::vector<std::size_t> order(n, 0), low(n, 0);  // 0: not visited yet
  std::size_t counter = 0;
  const std::function<void(std::size_t, std::size_t)> visit = [&](std::size_t i, std::size_t parent) {
    order[i] = low[i] = ++counter;
    result.part[i] = result.parts;
    for (std::size_t j = 0; j < n; ++j) {
      if (!linked(i, j) || j == parent) continue;
      if (order[j] == 0) {
        visit(j, i);
        if (low[j] > order[i]) result.bridges.emplace_back(std::min(i, j), std::max(i, j));
      }
      low[i] = std::min(low[i], order[j] > order[i] ? low[j] : order[j]);
    }
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (order[i] != 0) continue;
    visit(i, n);
    ++result.parts;
  }
  std::sort(result.bridges.begin(), result.bridges.end());

  // Weakest link of the strongest spanning tree (Prim), on which the whole network depends.
  if (result.parts == 1 && n > 1) {
    std::vector<double> best(n, -1);
    std::vector<bool> done(n, false);
    std::vector<std::size_t> from(n, 0);
    std::size_t at = 0;
    result.weakest_link = {0, 0};
    double weakest = 2;
    for (std::size_t step = 1; step < n; ++step) {
      done[at] = true;
      for (std::size_t j = 0; j < n; ++j)
        if (!done[j] && linked(at, j) && overlap(at, j) > best[j]) best[j] = overlap(at, j), from[j] = at;
      std::size_t next = n;
      for (std::size_t j = 0; j < n; ++j)
        if (!done[j] && best[j] > 0 && (next == n || best[j] > best[next])) next = j;
      if (best[next] < weakest) {
        weakest = best[next];
        result.weakest_link = {std::min(next, from[next]), std::max(next, from[next])};
      }
      at = next;
    }
    result.weakest_overlap = weakest;
  }
  return result;
}

}  // namespace vantage
