// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vantage/error.hpp"

namespace vantage {
namespace {

// Up to this many holes are subtracted one by one; with more, the polygon is first halved.
constexpr std::size_t kFewHoles = 16;

// A line, with the signed distance of points to its left.
struct Line {
  PlanePoint at, normal;  // unit, to the left

  static Line through(const PlanePoint& a, const PlanePoint& b) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    return {a, {-dy / length, dx / length}};
  }
  double left(const PlanePoint& p) const { return dot(p - at, normal); }
  Line turned() const { return {at, -normal}; }
};

// Returns the part of a convex polygon left of the line, or right of it by at most `reach`.
ConvexPolygon clip(const ConvexPolygon& polygon, const Line& line, double reach) {
  ConvexPolygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double a = line.left(p) + reach, b = line.left(q) + reach;
    if (a >= 0) kept.push_back(p);
    if ((a < 0) != (b < 0) && a != 0 && b != 0) {
      const double s = a / (a - b);
      kept.push_back(p + (q - p) * s);
    }
  }
  return kept;
}

// Returns the least distance between two parallel lines that enclose the polygon; one runs along an edge.
double width(const ConvexPolygon& polygon) {
  if (polygon.size() < 3) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if (a == b) continue;
    const Line edge = Line::through(a, b);
    double farthest = 0;
    for (const PlanePoint& p : polygon) farthest = std::max(farthest, edge.left(p));
    least = std::min(least, farthest);
  }
  return std::isfinite(least) ? least : 0;
}

struct Bounds {
  PlanePoint min, max;

  explicit Bounds(const ConvexPolygon& polygon) : min(polygon.front()), max(polygon.front()) {
    for (const PlanePoint& p : polygon) {
      min = glm::min(min, p);
      max = glm::max(max, p);
    }
  }
  bool overlaps(const Bounds& o) const {
    return min.x < o.max.x && o.min.x < max.x && min.y < o.max.y && o.min.y < max.y;
  }
};

struct Hole {
  ConvexPolygon polygon;
  Bounds bounds;
};

class Cut {
 public:
  Cut(const std::vector<ConvexPolygon>& holes, double slack, CutAllowance& allowance)
      : slack_(slack), allowance_(allowance) {
    for (const ConvexPolygon& hole : holes)
      if (width(hole) > 0) holes_.push_back({hole, Bounds(hole)});
  }

  std::vector<ConvexPolygon> from(const ConvexPolygon& polygon) {
    std::vector<const Hole*> all;
    for (const Hole& hole : holes_) all.push_back(&hole);
    cut(polygon, all);
    return std::move(parts_);
  }

 private:
  void cut(const ConvexPolygon& polygon, const std::vector<const Hole*>& candidates) {
    if (width(polygon) < slack_) return;
    const Bounds bounds(polygon);
    std::vector<const Hole*> holes;
    for (const Hole* hole : candidates)
      if (hole->bounds.overlaps(bounds)) holes.push_back(hole);
    if (holes.size() > kFewHoles && halve(polygon, bounds, holes)) return;
    std::vector<ConvexPolygon> parts{polygon};
    for (const Hole* hole : holes) {
      std::vector<ConvexPolygon> left;
      spend(allowance_.visits, parts.size());
      for (ConvexPolygon& part : parts) {
        if (Bounds(part).overlaps(hole->bounds))
          subtract(std::move(part), hole->polygon, left);
        else
          left.push_back(std::move(part));
      }
      spend(allowance_.parts, left.size() > parts.size() ? left.size() - parts.size() : 0);
      parts = std::move(left);
    }
    std::ranges::move(parts, std::back_inserter(parts_));
  }

  // Cuts each half of the polygon with the holes that it meets. Returns false if a half would keep nearly all holes.
  bool halve(const ConvexPolygon& polygon, const Bounds& bounds, const std::vector<const Hole*>& holes) {
    const bool along_x = bounds.max.x - bounds.min.x > bounds.max.y - bounds.min.y;
    std::vector<double> centres;
    for (const Hole* hole : holes) {
      const Bounds& b = hole->bounds;
      centres.push_back(along_x ? (b.min.x + b.max.x) / 2 : (b.min.y + b.max.y) / 2);
    }
    const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(centres.size() / 2);
    std::nth_element(centres.begin(), middle, centres.end());
    const Line line = along_x ? Line{{*middle, 0}, {1, 0}} : Line{{0, *middle}, {0, 1}};
    const ConvexPolygon high = clip(polygon, line, slack_ / 4), low = clip(polygon, line.turned(), slack_ / 4);
    if (high.size() < 3 || low.size() < 3) return false;
    const Bounds in_high(high), in_low(low);
    const auto meeting = [&](const Bounds& half) {
      return std::ranges::count_if(holes, [&](const Hole* hole) { return hole->bounds.overlaps(half); });
    };
    if (4 * std::max(meeting(in_high), meeting(in_low)) > 3 * std::ssize(holes)) return false;
    cut(high, holes);
    cut(low, holes);
    return true;
  }

  // Cuts off the part beyond each edge of the hole in turn; the remainder lies in the hole.
  void subtract(ConvexPolygon part, const ConvexPolygon& hole, std::vector<ConvexPolygon>& left) const {
    if (misses(part, hole)) {
      left.push_back(std::move(part));
      return;
    }
    for (std::size_t k = 0; k < hole.size() && part.size() >= 3; ++k) {
      const Line edge = Line::through(hole[k], hole[(k + 1) % hole.size()]);
      ConvexPolygon beyond = clip(part, edge.turned(), slack_ / 4);
      if (width(beyond) >= slack_) left.push_back(std::move(beyond));
      part = clip(part, edge, 0);
    }
  }

  // Returns true if the whole part lies beyond an edge of the hole, so that it need not be divided.
  bool misses(const ConvexPolygon& part, const ConvexPolygon& hole) const {
    for (std::size_t k = 0; k < hole.size(); ++k) {
      const Line edge = Line::through(hole[k], hole[(k + 1) % hole.size()]);
      if (std::ranges::all_of(part, [&](const PlanePoint& p) { return edge.left(p) <= slack_ / 4; })) return true;
    }
    return false;
  }

  static void spend(std::atomic<std::int64_t>& left, std::size_t amount) {
    if (left.fetch_sub(static_cast<std::int64_t>(amount), std::memory_order_relaxed) <
        static_cast<std::int64_t>(amount))
      throw Error(Errc::out_of_memory,
                  "surveyed surfaces lie in one plane with blocking ones and cut these into too many parts; leave "
                  "either of them out");
  }

  double slack_;
  CutAllowance& allowance_;
  std::vector<Hole> holes_;
  std::vector<ConvexPolygon> parts_;
};

}  // namespace

std::vector<ConvexPolygon> cut_away(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes, double slack,
                                    CutAllowance& allowance) {
  return Cut(holes, slack, allowance).from(polygon);
}

}  // namespace vantage
