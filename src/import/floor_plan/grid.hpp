// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// Finds objects by their bounding boxes, in a grid of square cells.
class Grid {
 public:
  explicit Grid(double cell) : cell_(cell) {}

  void add(std::size_t index, Point low, Point high) {
    constexpr double kMostCells = 1024;  // of one object; larger ones are tested on every visit
    const double cells = (1 + (high.x - low.x) / cell_) * (1 + (high.y - low.y) / cell_);
    if (!(cells <= kMostCells)) {
      large_.push_back(index);
      return;
    }
    for_cells(low, high, [&](std::int64_t x, std::int64_t y) { cells_[key(x, y)].push_back(index); });
  }

  // Adds a line, widened by `margin`.
  void add_line(std::size_t index, Point a, Point b, double margin) {
    if (is_long(a, b))
      large_.push_back(index);
    else
      for_cells_of_line(a, b, margin, [&](std::int64_t x, std::int64_t y) { cells_[key(x, y)].push_back(index); });
  }

  // Calls `visit(index)` for all objects whose cells meet the box, for some more than once.
  template <class Visit>
  void visit(Point low, Point high, const Visit& visit) const {
    for (const std::size_t index : large_) visit(index);
    for_cells(low, high, [&](std::int64_t x, std::int64_t y) {
      if (const auto found = cells_.find(key(x, y)); found != cells_.end())
        for (const std::size_t index : found->second) visit(index);
    });
  }

  // Calls `visit(index, low corner of the cell, cell)` for all objects in the cells that a line passes; for none if the
  // line is longer than some thousand cells.
  template <class Visit>
  void visit_line(Point a, Point b, const Visit& visit) const {
    if (is_long(a, b)) return;
    for_cells_of_line(a, b, 0, [&](std::int64_t x, std::int64_t y) {
      if (const auto found = cells_.find(key(x, y)); found != cells_.end())
        for (const std::size_t index : found->second)
          visit(index, Point{static_cast<double>(x) * cell_, static_cast<double>(y) * cell_}, cell_);
    });
  }

 private:
  static std::int64_t key(std::int64_t x, std::int64_t y) { return (x << 32) ^ (y & 0xFFFFFFFF); }
  std::int64_t cell_of(double v) const { return static_cast<std::int64_t>(std::floor(v / cell_)); }

  bool is_long(Point a, Point b) const {
    constexpr double kMostCells = 8192;
    return !((std::abs(b.x - a.x) + std::abs(b.y - a.y)) / cell_ <= kMostCells);
  }

  template <class Visit>
  void for_cells(Point low, Point high, const Visit& visit) const {
    for (std::int64_t y = cell_of(low.y); y <= cell_of(high.y); ++y)
      for (std::int64_t x = cell_of(low.x); x <= cell_of(high.x); ++x) visit(x, y);
  }

  // Visits the cells row by row.
  template <class Visit>
  void for_cells_of_line(Point a, Point b, double margin, const Visit& visit) const {
    if (a.y > b.y) std::swap(a, b);
    const auto x_at = [&](double y) { return a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0); };
    for (std::int64_t row = cell_of(a.y - margin); row <= cell_of(b.y + margin); ++row) {
      const double low = static_cast<double>(row) * cell_;
      const bool level = !(b.y > a.y);
      const double from = level ? a.x : x_at(low - margin), to = level ? b.x : x_at(low + cell_ + margin);
      for (std::int64_t x = cell_of(std::min(from, to) - margin); x <= cell_of(std::max(from, to) + margin); ++x)
        visit(x, row);
    }
  }

  double cell_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
  std::vector<std::size_t> large_;
};

inline Point lowest(Point a, Point b) { return {std::fmin(a.x, b.x), std::fmin(a.y, b.y)}; }
inline Point highest(Point a, Point b) { return {std::fmax(a.x, b.x), std::fmax(a.y, b.y)}; }

}  // namespace vantage::floor_plan
