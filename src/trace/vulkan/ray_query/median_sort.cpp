// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/ray_query/median_sort.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"

namespace vantage {
namespace {

struct Placed {
  std::array<float, 3> min, max;
  std::uint32_t triangle;
};

float half_area(std::span<const Placed> items) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (const Placed& item : items)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], item.min[k]);
      high[k] = std::max(high[k], item.max[k]);
    }
  const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
  return x * y + y * z + z * x;
}

void sort_items(std::span<Placed> items) {
  if (items.size() <= 2) return;
  const std::size_t half = (items.size() + 1) / 2;
  const auto halve = [&](std::size_t axis) {
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const Placed& a, const Placed& b) {
                       const float x = a.min[axis] + a.max[axis], y = b.min[axis] + b.max[axis];
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
  };
  std::size_t best = 0;
  float best_cost = std::numeric_limits<float>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    halve(axis);
    const float cost = half_area(items.first(half)) + half_area(items.subspan(half));
    if (cost < best_cost) {
      best_cost = cost;
      best = axis;
    }
  }
  if (best != 2) halve(best);
  if (items.size() > 4096) {
    parallel::both([&] { sort_items(items.first(half)); }, [&] { sort_items(items.subspan(half)); });
  } else {
    sort_items(items.first(half));
    sort_items(items.subspan(half));
  }
}

}  // namespace

std::vector<std::uint32_t> median_sort(std::span<const Float3> positions, std::span<const Triangle> triangles) {
  std::vector<Placed> items(triangles.size());
  parallel::for_all(std::size_t{0}, items.size(), [&](std::size_t t) {
    Placed& item = items[t];
    item.min.fill(std::numeric_limits<float>::infinity());
    item.max.fill(-std::numeric_limits<float>::infinity());
    for (const std::uint32_t vertex : triangles[t]) {
      const Float3& p = positions[vertex];
      const std::array<float, 3> v{p.x, p.y, p.z};
      for (std::size_t k = 0; k < 3; ++k) {
        item.min[k] = std::min(item.min[k], v[k]);
        item.max[k] = std::max(item.max[k], v[k]);
      }
    }
    item.triangle = static_cast<std::uint32_t>(t);
  });
  sort_items(items);
  std::vector<std::uint32_t> order(items.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const Placed& item) { return item.triangle; });
  return order;
}

}  // namespace vantage
