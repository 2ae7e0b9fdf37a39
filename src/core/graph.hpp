// SPDX-License-Identifier: Apache-2.0
// Small graphs: connected components and the strongest spanning tree.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vantage {

struct Components {
  std::vector<std::size_t> of;  // the component of each node; numbered from 0 by their lowest nodes
  std::size_t count = 0;
};

// Returns the components of the undirected graph over nodes 0 to n − 1; `linked(i, j)`: i and j are neighbours.
template <class Linked>
Components components(std::size_t n, Linked linked) {
  Components found{.of = std::vector<std::size_t>(n, n)};
  std::vector<std::size_t> open, left(n);
  for (std::size_t i = 0; i < n; ++i) left[i] = i;
  while (!left.empty()) {
    open.assign(1, left.front());
    found.of[left.front()] = found.count;
    left.erase(left.begin());
    while (!open.empty() && !left.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      std::erase_if(left, [&](std::size_t j) {
        if (!linked(at, j)) return false;
        found.of[j] = found.count;
        open.push_back(j);
        return true;
      });
    }
    ++found.count;
  }
  return found;
}

// Does the same for a sparse graph; `for_each_neighbour(i, visit)` calls visit(j) for each neighbour.
template <class ForEachNeighbour>
Components components_along(std::size_t n, ForEachNeighbour for_each_neighbour) {
  Components found{.of = std::vector<std::size_t>(n, n)};
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < n; ++k) {
    if (found.of[k] != n) continue;
    found.of[k] = found.count;
    for (open.assign(1, k); !open.empty();) {
      const std::size_t at = open.back();
      open.pop_back();
      for_each_neighbour(at, [&](std::size_t j) {
        if (found.of[j] == n) found.of[j] = found.count, open.push_back(j);
      });
    }
    ++found.count;
  }
  return found;
}

struct TreeEdge {
  std::size_t from, to;
  double weight;
};

// Returns the spanning tree with the largest sum of weights, and thus the largest minimum (Prim: Shortest Connection
// Networks and Some Generalizations, 1957). Edges are in the order in which they join the tree of node 0. `weight(i,
// j)` is symmetric; a weight not above 0 means no edge. An unreachable node joins by an edge of weight 0.
template <class Weight>
std::vector<TreeEdge> strongest_spanning_tree(std::size_t n, Weight weight) {
  std::vector<TreeEdge> tree, best(n);  // the strongest edge from the tree to each node
  std::vector<char> joined(n, 0);
  for (std::size_t j = 0; j < n; ++j) best[j] = {0, j, 0};
  std::size_t at = 0;
  for (std::size_t step = 1; step < n; ++step) {
    joined[at] = 1;
    std::size_t next = n;
    for (std::size_t j = 0; j < n; ++j) {
      if (joined[j]) continue;
      if (const double now = weight(at, j); now > best[j].weight) best[j] = {at, j, now};
      if (next == n || best[j].weight > best[next].weight) next = j;
    }
    tree.push_back(best[next]);
    at = next;
  }
  return tree;
}

}  // namespace vantage
