// SPDX-License-Identifier: Apache-2.0
#include "placement/shelf_packing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/first_numbers.hpp"

namespace vantage {
namespace {

// Packs by next-fit on shelves of the given width, highest first.
Packing pack(const std::vector<Uv>& sizes, const std::vector<std::size_t>& order, double width, double gap) {
  Packing packing;
  packing.corner.resize(sizes.size());
  double x = 0, shelf = 0, height = 0;
  for (const std::size_t i : order) {
    if (x > 0 && x + sizes[i].u > width) {
      shelf += height + gap;
      x = height = 0;
    }
    packing.corner[i] = {x, shelf};
    packing.size = {std::max(packing.size.u, x + sizes[i].u), std::max(packing.size.v, shelf + sizes[i].v)};
    x += sizes[i].u + gap;
    height = std::max(height, sizes[i].v);
  }
  return packing;
}

}  // namespace

Packing pack_shelves(const std::vector<Uv>& sizes, double gap) {
  std::vector<std::size_t> order = first_numbers(sizes.size());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a].v > sizes[b].v; });
  double widest = 0, area = 0;
  for (const Uv s : sizes) {
    widest = std::max(widest, s.u);
    area += (s.u + gap) * (s.v + gap);
  }
  Packing best;
  double least = std::numeric_limits<double>::infinity();
  constexpr int kWidths = 24;
  for (int i = 0; i < kWidths; ++i) {
    const double width = std::max(widest, std::sqrt(area) * (0.7 + 1.8 * i / kWidths));
    Packing packing = pack(sizes, order, width, gap);
    const double aspect =
        packing.size.u > packing.size.v ? packing.size.u / packing.size.v : packing.size.v / packing.size.u;
    const double cost = packing.size.u * packing.size.v * (1 + 0.01 * aspect);
    if (cost < least) {
      least = cost;
      best = std::move(packing);
    }
  }
  return best;
}

}  // namespace vantage
