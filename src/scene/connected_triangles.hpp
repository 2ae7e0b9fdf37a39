// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "core/first_numbers.hpp"
#include "core/parallel.hpp"
#include "scene/scene_data.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {

// Triangles of a mesh, grouped by connected components.
struct Connected {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> begin;  // of each component in `triangles`, and their end
};

// Groups triangles. Two are connected if they share the position of a corner.
template <class Position>
Connected connect(std::span<const Triangle> triangles, std::span<const Position> positions) {
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::uint32_t low = kNone, high = 0;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) low = std::min(low, v), high = std::max(high, v);
  if (triangles.empty()) return {};
  DisjointSets parts(high - low + 1);
  std::vector<std::uint32_t> order = first_numbers<std::uint32_t>(parts.size());
  for (const Triangle& t : triangles) parts.join(t[0] - low, t[1] - low), parts.join(t[0] - low, t[2] - low);
  const auto key = [&](std::uint32_t v) {
    const Position& p = positions[low + v];
    return std::tie(p.x, p.y, p.z);
  };
  std::erase_if(order, [&](std::uint32_t v) {
    const auto [x, y, z] = key(v);
    return !sound({x, y, z});
  });
  parallel::sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) { return key(v) < key(w); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i]) == key(order[i - 1])) parts.join(order[i], order[i - 1]);
  Connected out{std::vector<std::uint32_t>(triangles.size()), {0}};
  std::vector<std::uint32_t>& number = order;  // of the part of each root
  number.assign(parts.size(), kNone);
  for (const Triangle& t : triangles) {
    std::uint32_t& part = number[parts.find(t[0] - low)];
    if (part == kNone) part = static_cast<std::uint32_t>(out.begin.size()) - 1, out.begin.push_back(0);
    ++out.begin[part + 1];
  }
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  std::vector<std::uint32_t> at = out.begin;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    out.triangles[at[number[parts.find(triangles[i][0] - low)]]++] = i;
  return out;
}

}  // namespace vantage
