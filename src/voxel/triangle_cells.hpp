// SPDX-License-Identifier: Apache-2.0
// Cells of a unit grid that one triangle touches. Separating axes after Akenine-Möller, Fast 3D Triangle-Box Overlap
// Testing, 2001, with the nine edge axes taken as 2-D tests in the three coordinate planes (Schwarz and Seidel, Fast
// Parallel Surface and Solid Voxelization on GPUs, 2010).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vantage {

// Cell (i, j, k) is the closed box [i − margin, i + 1 + margin] × … in grid units, 0 <= i, j, k < cells_per_side. Tests
// are in double, and rounding favours touching: no touched cell is lost, and every cell found lies within some 2^-50 of
// the triangle's extent.
class TriangleCells {
 public:
  using Point = std::array<double, 3>;
  using Cell = std::array<std::int64_t, 3>;

  TriangleCells(const std::array<Point, 3>& corners, std::int64_t cells_per_side, double margin = 0) : margin_(margin) {
    const double last = static_cast<double>(cells_per_side - 1);
    int wide_axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [lo, hi] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      const double first_cell = std::max(0.0, std::ceil(lo - margin - 1));
      const double last_cell = std::min(last, std::floor(hi + margin));
      if (!(first_cell <= last_cell)) {
        empty_ = true;
        return;
      }
      base_[axis] = static_cast<std::int64_t>(first_cell);
      count_[axis] = static_cast<std::int64_t>(last_cell) - base_[axis] + 1;
      wide_axes += count_[axis] > 1;
      for (int c = 0; c < 3; ++c) corner_[c][axis] = corners[c][axis] - first_cell;
    }
    // Within a single row of cells, the triangle's extent decides: it is connected, so it touches each.
    full_ = wide_axes <= 1;
    if (!full_) prepare();
  }

  // Calls visit(cell) once for every cell that the triangle touches. With `parts`, only for part number `part`; each
  // cell is in one part.
  template <class Visit>
  void for_each(Visit&& visit, std::int64_t part = 0, std::int64_t parts = 1) const {
    if (empty_) return;
    std::array<Range, 3> within = all();
    const std::int64_t layers = count_[full_ ? 0 : u_];
    within[static_cast<std::size_t>(full_ ? 0 : u_)] = {layers * part / parts, layers * (part + 1) / parts - 1};
    walk(within, visit);
  }
  // Visits only the cells from `low` to `high`, both included.
  template <class Visit>
  void for_each_within(const Cell& low, const Cell& high, Visit&& visit) const {
    if (empty_) return;
    std::array<Range, 3> within = all();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      within[axis].first = std::max(within[axis].first, low[axis] - base_[axis]);
      within[axis].last = std::min(within[axis].last, high[axis] - base_[axis]);
      if (within[axis].first > within[axis].last) return;
    }
    walk(within, visit);
  }

  bool touches(const Cell& cell) const {
    if (empty_) return false;
    Cell local;
    for (int axis = 0; axis < 3; ++axis) {
      local[axis] = cell[axis] - base_[axis];
      if (local[axis] < 0 || local[axis] >= count_[axis]) return false;
    }
    if (full_) return true;
    const std::int64_t i = local[u_], j = local[v_], k = local[w_];
    if (!inside(uv_, i, j) || !inside(vw_, j, k) || !inside(wu_, k, i)) return false;
    const auto [low, high] = column(i, j);
    return low <= k && k <= high;
  }

 private:
  struct Range {
    std::int64_t first, last;
  };
  // One edge in one coordinate plane. A cell (p, q) overlaps the triangle along the edge's normal while low <= a·p +
  // b·q <= high.
  struct Edge {
    double a, b, low, high;
  };
  using Edges = std::array<Edge, 3>;

  std::array<Range, 3> all() const { return {Range{0, count_[0] - 1}, {0, count_[1] - 1}, {0, count_[2] - 1}}; }

  // Visits the touched cells within these ranges of local cells. REQUIRES: not empty.
  template <class Visit>
  void walk(const std::array<Range, 3>& within, Visit&& visit) const {
    if (full_) {
      for (std::int64_t x = within[0].first; x <= within[0].last; ++x)
        for (std::int64_t y = within[1].first; y <= within[1].last; ++y)
          for (std::int64_t z = within[2].first; z <= within[2].last; ++z)
            visit(Cell{base_[0] + x, base_[1] + y, base_[2] + z});
      return;
    }
    const Range of_u = within[static_cast<std::size_t>(u_)], of_v = within[static_cast<std::size_t>(v_)],
                of_w = within[static_cast<std::size_t>(w_)];
    for (std::int64_t i = of_u.first; i <= of_u.last; ++i) {
      const Range of_row = row(i);
      for (std::int64_t j = std::max(of_row.first, of_v.first); j <= std::min(of_row.last, of_v.last); ++j) {
        if (!inside(uv_, i, j)) continue;
        const Range of_column = column(i, j);
        for (std::int64_t k = std::max(of_column.first, of_w.first); k <= std::min(of_column.last, of_w.last); ++k) {
          if (!inside(vw_, j, k) || !inside(wu_, k, i)) continue;
          Cell cell;
          cell[u_] = base_[u_] + i;
          cell[v_] = base_[v_] + j;
          cell[w_] = base_[w_] + k;
          visit(cell);
        }
      }
    }
  }
  static constexpr double kRounding = 0x1p-50;

  void prepare() {
    Point e0, e1;
    double reach = 0;  // of local coordinates
    for (int axis = 0; axis < 3; ++axis) {
      e0[axis] = corner_[1][axis] - corner_[0][axis];
      e1[axis] = corner_[2][axis] - corner_[0][axis];
      reach = std::max({reach, std::abs(corner_[0][axis]), std::abs(corner_[1][axis]), std::abs(corner_[2][axis]),
                        static_cast<double>(count_[axis])});
    }
    const Point normal{e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2], e0[0] * e1[1] - e0[1] * e1[0]};
    w_ = 0;
    for (int axis = 1; axis < 3; ++axis)
      if (std::abs(normal[axis]) > std::abs(normal[w_])) w_ = axis;
    u_ = (w_ + 1) % 3;
    v_ = (w_ + 2) % 3;
    uv_ = edges(u_, v_);
    vw_ = edges(v_, w_);
    wu_ = edges(w_, u_);

    const double nw = normal[w_];
    slope_u_ = normal[u_] / nw;
    slope_v_ = normal[v_] / nw;
    // The products of the normal are rounded relative to the edges' lengths, which for a sliver far exceed the normal.
    const double products =
        (std::abs(e0[0]) + std::abs(e0[1]) + std::abs(e0[2])) * (std::abs(e1[0]) + std::abs(e1[1]) + std::abs(e1[2]));
    plane_slack_ = kRounding * (reach + margin_ + 1) * (4 + 4 * products / std::abs(nw));
    plane_known_ = std::isfinite(plane_slack_);
    height_ = corner_[0][w_] + slope_u_ * corner_[0][u_] + slope_v_ * corner_[0][v_];
    const double half = 0.5 + margin_;
    height_ -= 0.5 * (slope_u_ + slope_v_);  // at the middle of cell (0, 0)
    spread_ = half * (std::abs(slope_u_) + std::abs(slope_v_)) + plane_slack_ + margin_;
  }

  Edges edges(int p, int q) const {
    Edges result;
    for (int e = 0; e < 3; ++e) {
      const Point &from = corner_[e], &to = corner_[(e + 1) % 3], &opposite = corner_[(e + 2) % 3];
      const double a = from[q] - to[q], b = to[p] - from[p];
      const double at_edge = a * from[p] + b * from[q], at_opposite = a * opposite[p] + b * opposite[q];
      const auto reach = [&](int axis) {
        return std::max({std::abs(from[axis]), std::abs(to[axis]), std::abs(opposite[axis]),
                         static_cast<double>(count_[axis])}) +
               margin_;
      };
      const double slack = kRounding * (std::abs(a) * reach(p) + std::abs(b) * reach(q));
      const double box_low = std::min(-a * margin_, a * (1 + margin_)) + std::min(-b * margin_, b * (1 + margin_));
      const double box_high = std::max(-a * margin_, a * (1 + margin_)) + std::max(-b * margin_, b * (1 + margin_));
      result[e] = {a, b, std::min(at_edge, at_opposite) - box_high - slack,
                   std::max(at_edge, at_opposite) - box_low + slack};
    }
    return result;
  }

  static bool inside(const Edges& edges, std::int64_t p, std::int64_t q) {
    const double x = static_cast<double>(p), y = static_cast<double>(q);
    for (const Edge& e : edges) {
      const double value = e.a * x + e.b * y;
      if (value < e.low || value > e.high) return false;
    }
    return true;
  }

  // Returns a range of j that contains every cell (i, j) inside the projection on (u, v).
  Range row(std::int64_t i) const {
    double first = 0, last = static_cast<double>(count_[v_] - 1);
    for (const Edge& e : uv_) {
      const double a = e.a * static_cast<double>(i);
      if (e.b == 0) {
        if (a < e.low || a > e.high) return {0, -1};
        continue;
      }
      double from = (e.low - a) / e.b, to = (e.high - a) / e.b;
      if (e.b < 0) std::swap(from, to);
      const double slack = kRounding * 4 * (std::abs(from) + std::abs(to) + std::abs(a / e.b));
      first = std::max(first, from - slack);
      last = std::min(last, to + slack);
    }
    if (!(first <= last)) return {0, -1};
    return {static_cast<std::int64_t>(std::ceil(first)), static_cast<std::int64_t>(std::floor(last))};
  }

  // Returns the cells that the plane crosses within column (i, j), inside the triangle's extent.
  Range column(std::int64_t i, std::int64_t j) const {
    if (!plane_known_) return {0, count_[w_] - 1};
    const double middle = height_ - slope_u_ * static_cast<double>(i) - slope_v_ * static_cast<double>(j);
    const double low = std::max(0.0, std::ceil(middle - spread_ - 1));
    const double high = std::min(static_cast<double>(count_[w_] - 1), std::floor(middle + spread_));
    if (!(low <= high)) return {0, -1};
    return {static_cast<std::int64_t>(low), static_cast<std::int64_t>(high)};
  }

  double margin_;
  bool empty_ = false, full_ = false;
  std::array<std::int64_t, 3> base_{}, count_{};  // cells of the triangle's extent
  std::array<Point, 3> corner_{};                 // relative to base_, which keeps the numbers small
  int u_ = 0, v_ = 1, w_ = 2;  // w: axis of the largest normal component, so that a column crosses few cells
  Edges uv_{}, vw_{}, wu_{};
  double slope_u_ = 0, slope_v_ = 0, height_ = 0, spread_ = 0, plane_slack_ = 0;
  bool plane_known_ = false;
};

}  // namespace vantage
