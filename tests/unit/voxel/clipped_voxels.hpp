// SPDX-License-Identifier: Apache-2.0
// An independent voxelization: clips the triangle, as a polygon, against each cell's six half-spaces in turn, and marks
// the cell if anything is left, even a point. In double, or in fractions to decide touches exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage::test {

// A reduced fraction; wide enough for clipped triangles of small whole coordinates.
class Fraction {
 public:
  __extension__ using Wide = __int128;
  Fraction(Wide n = 0, Wide d = 1) {
    Wide a = n < 0 ? -n : n, b = d < 0 ? -d : d;
    while (b != 0) std::swap(a %= b, b);
    n_ = static_cast<std::int64_t>((d < 0 ? -n : n) / a);
    d_ = static_cast<std::int64_t>((d < 0 ? -d : d) / a);
  }
  friend Fraction operator+(Fraction a, Fraction b) {
    return {Wide(a.n_) * b.d_ + Wide(b.n_) * a.d_, Wide(a.d_) * b.d_};
  }
  friend Fraction operator-(Fraction a, Fraction b) {
    return {Wide(a.n_) * b.d_ - Wide(b.n_) * a.d_, Wide(a.d_) * b.d_};
  }
  friend Fraction operator*(Fraction a, Fraction b) { return {Wide(a.n_) * b.n_, Wide(a.d_) * b.d_}; }
  friend Fraction operator/(Fraction a, Fraction b) { return {Wide(a.n_) * b.d_, Wide(a.d_) * b.n_}; }
  int sign() const { return (n_ > 0) - (n_ < 0); }

 private:
  std::int64_t n_, d_;
};
inline int sign_of(const Fraction& f) { return f.sign(); }
inline int sign_of(double v) { return (v > 0) - (v < 0); }

template <class Number>
using Polygon = std::vector<std::array<Number, 3>>;

// Part of a polygon where side · (p[axis] − bound) <= 0.
template <class Number>
Polygon<Number> clip(const Polygon<Number>& in, int axis, Number bound, int side) {
  Polygon<Number> out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto &a = in[i], &b = in[(i + 1) % in.size()];
    const Number da = a[axis] - bound, db = b[axis] - bound;
    if (side * sign_of(da) <= 0) out.push_back(a);
    if (sign_of(da) * sign_of(db) < 0) {
      std::array<Number, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = a[k] + (b[k] - a[k]) * (da / (da - db));
      p[axis] = bound;
      out.push_back(p);
    }
  }
  return out;
}

template <class Number>
bool touches_box(const Polygon<Number>& triangle, const std::array<Number, 3>& low, const std::array<Number, 3>& high) {
  Polygon<Number> p = triangle;
  for (int axis = 0; axis < 3 && !p.empty(); ++axis) p = clip(clip(p, axis, low[axis], -1), axis, high[axis], 1);
  return !p.empty();
}

// Cells {x, y, z} of 2^depth per side that the triangles touch, each box widened by `margin`. Slow: for tests.
inline std::set<std::array<std::uint32_t, 3>> clipped_voxels(std::span<const Float3> positions,
                                                             std::span<const Triangle> triangles,
                                                             const std::array<double, 3>& min, double size, int depth,
                                                             double margin = 0) {
  std::set<std::array<std::uint32_t, 3>> cells;
  const int n = 1 << depth;
  for (const Triangle& t : triangles) {
    Polygon<double> polygon;
    std::array<int, 3> first, last;
    for (const std::uint32_t v : t) polygon.push_back({positions[v].x, positions[v].y, positions[v].z});
    for (int axis = 0; axis < 3; ++axis) {
      const auto [lo, hi] = std::minmax({polygon[0][axis], polygon[1][axis], polygon[2][axis]});
      first[axis] = std::max(0, int(std::floor((lo - margin - min[axis]) / size)) - 1);
      last[axis] = std::min(n - 1, int(std::floor((hi + margin - min[axis]) / size)) + 1);
    }
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z) {
          const std::array<double, 3> low{min[0] + x * size - margin, min[1] + y * size - margin,
                                          min[2] + z * size - margin};
          const std::array<double, 3> high{min[0] + (x + 1) * size + margin, min[1] + (y + 1) * size + margin,
                                           min[2] + (z + 1) * size + margin};
          if (touches_box(polygon, low, high)) cells.insert({std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)});
        }
  }
  return cells;
}

}  // namespace vantage::test
