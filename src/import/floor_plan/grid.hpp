// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// Finds things by the boxes around them: a grid of square cells.
class Grid {
 public:
  explicit Grid(double cell) : cell_(cell) {}

  void add(std::size_t index, Point low, Point high) {
    constexpr double kMostCells = 1024;  // of one thing; larger ones are looked at each time
    const double cells = (1 + (high.x - low.x) / cell_) * (1 + (high.y - low.y) / cell_);
    if (!(cells <= kMostCells)) {
      large_.push_back(index);
      return;
    }
    for_cells(low, high, [&](std::int64_t key) { cells_[key].push_back(index); });
  }

  // Calls `visit(index)` for all things whose cells meet the box, some of them more than once.
  template <class Visit>
  void visit(Point low, Point high, const Visit& visit) const {
    for (const std::size_t index : large_) visit(index);
    for_cells(low, high, [&](std::int64_t key) {
      if (const auto found = cells_.find(key); found != cells_.end())
        for (const std::size_t index : found->second) visit(index);
    });
  }

 private:
  template <class Visit>
  void for_cells(Point low, Point high, const Visit& visit) const {
    const auto cell = [&](double v) { return static_cast<std::int64_t>(std::floor(v / cell_)); };
    for (std::int64_t y = cell(low.y); y <= cell(high.y); ++y)
      for (std::int64_t x = cell(low.x); x <= cell(high.x); ++x) visit((x << 32) ^ (y & 0xFFFFFFFF));
  }

  double cell_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
  std::vector<std::size_t> large_;
};

inline Point lowest(Point a, Point b) { return {std::fmin(a.x, b.x), std::fmin(a.y, b.y)}; }
inline Point highest(Point a, Point b) { return {std::fmax(a.x, b.x), std::fmax(a.y, b.y)}; }

}  // namespace vantage::floor_plan
