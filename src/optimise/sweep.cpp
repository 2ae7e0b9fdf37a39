// SPDX-License-Identifier: Apache-2.0
// Three dimensions: points are taken by ascending z, and the staircase of those non-dominated in (x, y) is kept in an
// ordered set (Beume, Fonseca, López-Ibáñez, Paquete, Vahrenhold: On the Complexity of Computing the Hypervolume
// Indicator, 2009). Contributions: each point on the staircase keeps the area that it alone dominates as a list of
// boxes, which newcomers cut (Emmerich, Fonseca: Computing Hypervolume Contributions in Low Dimensions, 2011).
#include "optimise/sweep.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/first_numbers.hpp"
#include "optimise/index_set.hpp"
#include "optimise/infinity.hpp"

namespace vantage::optimise {
namespace {

// Points sorted by x; rank i + 1 is the i-th of them. Ranks 0 and k + 1 are sentinels that close the staircase.
struct Sweep {
  Sweep(std::span<const Point3> points, const Point3& reference) : stairs(points.size() + 2) {
    const std::size_t k = points.size();
    index.resize(k);
    std::iota(index.begin(), index.end(), 0u);
    std::sort(index.begin(), index.end(),
              [&](std::uint32_t a, std::uint32_t b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
    sorted.reserve(k + 2);
    sorted.push_back({-kInfinity, reference[1], 0});
    for (const std::uint32_t i : index) sorted.push_back(points[i]);
    sorted.push_back({reference[0], -kInfinity, 0});
    order.resize(k);
    std::iota(order.begin(), order.end(), 1u);
    // Equal z are sorted by rank: a point that another weakly dominates in (x, y) then comes after it.
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return sorted[a][2] != sorted[b][2] ? sorted[a][2] < sorted[b][2] : a < b;
    });
    stairs.insert(0);
    stairs.insert(k + 1);
  }

  std::vector<std::uint32_t> index;  // rank − 1 to point
  std::vector<Point3> sorted;        // by rank
  std::vector<std::uint32_t> order;  // ranks by z
  IndexSet stairs;                   // ranks on the staircase
};

// The area that each staircase point alone dominates, as boxes from left to right with descending tops. All boxes of a
// point stand on its y; each stores the z from which it exists.
class ExclusiveAreas {
 public:
  ExclusiveAreas(std::span<const Point3> sorted)
      : sorted_(sorted), head_(sorted.size(), kEnd), tail_(sorted.size(), kEnd), volume_(sorted.size(), 0.0) {
    boxes_.reserve(4 * sorted.size());
  }

  void append(std::uint32_t p, double left, double right, double top, double z) {
    const std::uint32_t b = make({left, right, top, z, tail_[p], kEnd});
    (tail_[p] == kEnd ? head_[p] : boxes_[tail_[p]].next) = b;
    tail_[p] = b;
  }

  // Removes x ≥ left.
  void cut_right(std::uint32_t p, double left, double z) {
    while (tail_[p] != kEnd && boxes_[tail_[p]].left >= left) close(p, tail_[p], z);
    if (tail_[p] == kEnd) return;
    Box& last = boxes_[tail_[p]];
    if (last.right <= left) return;
    volume_[p] += (last.right - left) * (last.top - sorted_[p][1]) * (z - last.z);
    last.right = left;
  }

  // Removes the quadrant x ≥ left, y ≥ bottom.
  void cut_quadrant(std::uint32_t p, double left, double bottom, double z) {
    std::uint32_t b = head_[p];
    while (b != kEnd && boxes_[b].right <= left) b = boxes_[b].next;
    if (b == kEnd || boxes_[b].top <= bottom) return;
    if (boxes_[b].left < left) {  // keep the part left of the quadrant
      Box whole = boxes_[b];
      boxes_[b].right = left;
      const std::uint32_t rest = make({left, whole.right, whole.top, whole.z, b, whole.next});
      boxes_[b].next = rest;
      (whole.next == kEnd ? tail_[p] : boxes_[whole.next].previous) = rest;
      b = rest;
    }
    const double begin = boxes_[b].left;
    double end = begin;
    const std::uint32_t before = boxes_[b].previous;
    while (b != kEnd && boxes_[b].top > bottom) {
      end = boxes_[b].right;
      const std::uint32_t next = boxes_[b].next;
      close(p, b, z);
      b = next;
    }
    if (bottom <= sorted_[p][1]) return;
    const std::uint32_t merged = make({begin, end, bottom, z, before, b});
    (before == kEnd ? head_[p] : boxes_[before].next) = merged;
    (b == kEnd ? tail_[p] : boxes_[b].previous) = merged;
  }

  void close_all(std::uint32_t p, double z) {
    while (head_[p] != kEnd) close(p, head_[p], z);
  }

  double volume(std::uint32_t p) const { return volume_[p]; }

 private:
  static constexpr std::uint32_t kEnd = static_cast<std::uint32_t>(-1);
  struct Box {
    double left, right, top, z;
    std::uint32_t previous, next;
  };

  std::uint32_t make(const Box& box) {
    if (free_ == kEnd) {
      boxes_.push_back(box);
      return static_cast<std::uint32_t>(boxes_.size() - 1);
    }
    const std::uint32_t b = free_;
    free_ = boxes_[b].next;
    boxes_[b] = box;
    return b;
  }

  void close(std::uint32_t p, std::uint32_t b, double z) {
    Box& box = boxes_[b];
    volume_[p] += (box.right - box.left) * (box.top - sorted_[p][1]) * (z - box.z);
    (box.previous == kEnd ? head_[p] : boxes_[box.previous].next) = box.next;
    (box.next == kEnd ? tail_[p] : boxes_[box.next].previous) = box.previous;
    box.next = free_;
    free_ = b;
  }

  std::span<const Point3> sorted_;
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> head_, tail_;
  std::vector<double> volume_;
  std::uint32_t free_ = kEnd;
};

}  // namespace

double area(std::span<const std::array<double, 2>> points, const std::array<double, 2>& reference) {
  std::vector<std::array<double, 2>> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end());
  double sum = 0, top = reference[1];
  for (const auto& p : sorted) {
    if (p[1] >= top) continue;
    sum += (reference[0] - p[0]) * (top - p[1]);
    top = p[1];
  }
  return sum;
}

double volume3(std::span<const Point3> points, const Point3& reference) {
  Sweep sweep(points, reference);
  double sum = 0, covered = 0, z = 0;
  for (const std::uint32_t p : sweep.order) {
    const Point3& point = sweep.sorted[p];
    double top = sweep.sorted[sweep.stairs.previous(p)][1];
    if (top <= point[1]) continue;
    sum += covered * (point[2] - z);
    z = point[2];
    double left = point[0];
    std::size_t s = sweep.stairs.next(p);
    for (; sweep.sorted[s][1] >= point[1]; s = sweep.stairs.next(s)) {
      covered += (sweep.sorted[s][0] - left) * (top - point[1]);
      left = sweep.sorted[s][0];
      top = sweep.sorted[s][1];
      sweep.stairs.erase(s);
    }
    covered += (sweep.sorted[s][0] - left) * (top - point[1]);
    sweep.stairs.insert(p);
  }
  return sum + covered * (reference[2] - z);
}

std::vector<double> contributions2(std::span<const std::array<double, 2>> points,
                                   const std::array<double, 2>& reference) {
  const std::size_t k = points.size();
  std::vector<std::uint32_t> order = first_numbers<std::uint32_t>(k);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
  std::vector<double> result(k, 0.0);
  double ceiling = reference[1];
  for (std::size_t i = 0; i < k;) {
    // All points before the next staircase point are dominated by this one; they reduce its step by the part above
    // them.
    const auto& p = points[order[i]];
    const std::size_t begin = i++;
    double right = reference[0], shared = 0, top = ceiling;
    for (; i < k; ++i) {
      if (points[order[i]][1] < p[1]) {
        right = points[order[i]][0];
        break;
      }
    }
    for (std::size_t j = begin + 1; j < i; ++j) {
      const auto& q = points[order[j]];
      if (q[1] >= top) continue;
      shared += (right - q[0]) * (top - q[1]);
      top = q[1];
    }
    const bool twice = begin + 1 < k && points[order[begin + 1]] == p;
    result[order[begin]] = twice ? 0.0 : std::max(0.0, (right - p[0]) * (ceiling - p[1]) - shared);
    ceiling = p[1];
  }
  return result;
}

std::vector<double> contributions3(std::span<const Point3> points, const Point3& reference) {
  Sweep sweep(points, reference);
  ExclusiveAreas areas(sweep.sorted);
  const auto& at = sweep.sorted;
  for (const std::uint32_t p : sweep.order) {
    const double x = at[p][0], y = at[p][1], z = at[p][2];
    const auto above = static_cast<std::uint32_t>(sweep.stairs.previous(p));
    double top = at[above][1];
    if (top <= y) {
      areas.cut_quadrant(above, x, y, z);
      continue;
    }
    areas.cut_right(above, x, z);
    double left = x;
    auto s = static_cast<std::uint32_t>(sweep.stairs.next(p));
    for (; at[s][1] >= y; s = static_cast<std::uint32_t>(sweep.stairs.next(s))) {
      if (at[s][0] > left) areas.append(p, left, at[s][0], top, z);
      left = at[s][0];
      top = at[s][1];
      areas.close_all(s, z);
      sweep.stairs.erase(s);
    }
    areas.append(p, left, at[s][0], top, z);
    areas.cut_quadrant(s, -kInfinity, y, z);
    sweep.stairs.insert(p);
  }
  std::vector<double> result(points.size());
  for (std::uint32_t p = 1; p <= points.size(); ++p) {
    areas.close_all(p, reference[2]);
    result[sweep.index[p - 1]] = areas.volume(p);
  }
  return result;
}

}  // namespace vantage::optimise
