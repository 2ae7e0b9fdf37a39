// SPDX-License-Identifier: Apache-2.0
#include "trace/triangle_neighbours.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

#include "core/first_numbers.hpp"
#include "core/parallel.hpp"
#include "shared/trace_types.h"

namespace vantage {
namespace {

// Returns for each vertex the first vertex at the same place.
std::vector<std::uint32_t> first_at_its_place(std::span<const Float3> positions) {
  const auto place = [&](std::uint32_t v) {
    const Float3& p = positions[v];
    return std::array{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                      std::bit_cast<std::uint32_t>(p.z)};
  };
  std::vector<std::uint32_t> order = first_numbers<std::uint32_t>(positions.size());
  parallel::sort(order.begin(), order.end(),
                 [&](std::uint32_t a, std::uint32_t b) { return std::tuple(place(a), a) < std::tuple(place(b), b); });
  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && place(order[k]) == place(order[k - 1]);
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

struct Edge {
  std::uint32_t a, b;  // corners, the lower number first
  std::uint32_t at;    // 3 t + k
};

}  // namespace

std::vector<std::uint32_t> triangle_neighbours(std::span<const Float3> positions, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> first = first_at_its_place(positions);
  std::vector<Edge> edges(3 * triangles.size());
  parallel::for_all(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = first[triangles[t][k]], b = first[triangles[t][(k + 1) % 3]];
      edges[3 * t + k] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * t + k)};
    }
  });
  parallel::sort(edges.begin(), edges.end(), [](const Edge& one, const Edge& other) {
    return std::tie(one.a, one.b, one.at) < std::tie(other.a, other.b, other.at);
  });
  std::vector<std::uint32_t> neighbours(edges.size(), no_primitive);
  for (std::size_t k = 0, end = 0; k < edges.size(); k = end) {
    for (end = k + 1; end < edges.size() && edges[end].a == edges[k].a && edges[end].b == edges[k].b;) ++end;
    if (end - k != 2 || edges[k].at / 3 == edges[k + 1].at / 3) continue;
    neighbours[edges[k].at] = edges[k + 1].at / 3;
    neighbours[edges[k + 1].at] = edges[k].at / 3;
  }
  return neighbours;
}

std::vector<std::uint32_t> neighbours_after(std::span<const std::uint32_t> neighbours, const SceneData& later,
                                            const SceneDifference& difference) {
  if (neighbours.empty()) return {};
  const std::uint32_t opaque = later.opaque_count();
  std::vector<std::uint32_t> after(std::size_t{3} * opaque, no_primitive);
  const auto number_after = [&](std::uint32_t before) -> std::uint32_t {
    const auto next = std::ranges::upper_bound(difference.kept, before, {}, &KeptRun::first);
    if (next == difference.kept.begin()) return no_primitive;
    const KeptRun& run = *(next - 1);
    return before - run.first < run.count ? run.other + (before - run.first) : no_primitive;
  };
  for (const KeptRun& run : difference.kept) {
    if (run.other >= opaque) break;
    const std::size_t first = std::size_t{3} * run.first, other = std::size_t{3} * run.other;
    parallel::for_all(tbb::blocked_range<std::size_t>(0, std::size_t{3} * run.count, 1 << 14), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const std::uint32_t before = neighbours[first + k];
        if (before == no_primitive) continue;
        after[other + k] = before - run.first < run.count ? run.other + (before - run.first) : number_after(before);
      }
    });
  }
  for (const KeptRun& run : not_kept(difference.kept, opaque)) {
    const auto triangles = std::span(later.triangles).subspan(run.first, run.count);
    const auto [low, high] = corner_range(triangles);
    std::vector<Triangle> own(triangles.begin(), triangles.end());
    for (Triangle& t : own)
      for (std::uint32_t& v : t) v -= low;
    const std::vector<std::uint32_t> among =
        triangle_neighbours(std::span(later.positions).subspan(low, high - low + 1), own);
    for (std::size_t k = 0; k < among.size(); ++k)
      if (among[k] != no_primitive) after[std::size_t{3} * run.first + k] = run.first + among[k];
  }
  return after;
}

}  // namespace vantage
