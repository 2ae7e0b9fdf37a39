// SPDX-License-Identifier: Apache-2.0
// Decides if the winding of a mesh's triangles shows their front side: sketching tools leave each face as it was
// drawn.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/first_numbers.hpp"

namespace vantage {

// Edges that two triangles share, and those that both pass in the same direction, so that one shows its back beside the
// other's front.
struct Winding {
  std::size_t edges = 0, against = 0;

  Winding& operator+=(const Winding& other) {
    edges += other.edges, against += other.against;
    return *this;
  }
  // If each face is wound as drawn, half of the edges between faces are passed in the same direction, and none of those
  // within a face. Few edges tell nothing.
  bool either_way() const { return edges >= 12 && static_cast<double>(against) > 0.15 * static_cast<double>(edges); }
};

// Returns the winding of the first of `count` triangles, without non-finite ones. `corners(k)` has the positions of
// triangle k, which are equal to the bit if triangles meet.
template <class Corners>
Winding winding_of(std::uint32_t count, const Corners& corners) {
  constexpr std::uint32_t kLookedAt = 2000;
  count = std::min(count, kLookedAt);
  using Position = std::remove_cvref_t<decltype(corners(0)[0])>;
  std::vector<Position> positions;
  positions.reserve(3 * std::size_t{count});
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::array<Position, 3> t = corners(k);
    if (std::ranges::all_of(t, [](const Position& p) { return std::isfinite(p.x + p.y + p.z); }))
      positions.insert(positions.end(), t.begin(), t.end());
  }
  const auto key = [&](std::uint32_t v) { return std::tie(positions[v].x, positions[v].y, positions[v].z); };
  std::vector<std::uint32_t> order = first_numbers<std::uint32_t>(positions.size()), point(positions.size());
  std::ranges::sort(order, [&](std::uint32_t v, std::uint32_t w) { return key(v) < key(w); });
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (key(order[i]) != key(order[first])) first = i;
    point[order[i]] = order[first];
  }
  struct Edge {
    std::uint32_t low, high;
    bool rising;
  };
  std::vector<Edge> edges;
  edges.reserve(positions.size());
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const std::uint32_t a = point[v], b = point[v % 3 == 2 ? v - 2 : v + 1];
    if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b});
  }
  const auto ends = [](const Edge& e) { return std::tie(e.low, e.high); };
  std::ranges::sort(edges, [&](const Edge& e, const Edge& f) { return ends(e) < ends(f); });
  Winding winding;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && ends(edges[end]) == ends(edges[i])) ++end;
    if (end == i + 2) ++winding.edges, winding.against += edges[i].rising == edges[i + 1].rising;
    i = end;
  }
  return winding;
}

}  // namespace vantage
