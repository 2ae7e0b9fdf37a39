// SPDX-License-Identifier: Apache-2.0
// Boundaries of hatches. Their codes repeat, so groups are read in their order.
#include <algorithm>
#include <cmath>
#include <span>

#include "import/floor_plan/content.hpp"

namespace vantage::floor_plan {
namespace {

using Ring = std::vector<Point>;

bool holds(const Ring& ring, Point p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    if ((ring[i].y > p.y) != (ring[j].y > p.y) &&
        p.x < (ring[j].x - ring[i].x) * (p.y - ring[i].y) / (ring[j].y - ring[i].y) + ring[i].x)
      inside = !inside;
  return inside;
}

// Returns for each ring how many others enclose it, by most of its points, as rings may touch.
std::vector<std::size_t> depths(const std::vector<Ring>& rings) {
  std::vector<std::size_t> out(rings.size());
  for (std::size_t a = 0; a < rings.size(); ++a)
    for (std::size_t b = 0; b < rings.size(); ++b) {
      if (a == b) continue;
      const auto in = std::ranges::count_if(rings[a], [&](const Point& p) { return holds(rings[b], p); });
      out[a] += 2 * static_cast<std::size_t>(in) > rings[a].size();
    }
  return out;
}

void add_bulge(Ring& ring, Point a, Point b, double bulge) {
  const Ring points = ellipse_points(bulge_circle(a, b, bulge), 0, 4 * std::atan(bulge));
  ring.insert(ring.end(), points.begin() + 1, points.end() - 1);
}

class Cursor {
 public:
  explicit Cursor(std::span<const Group> groups) : groups_(groups) {}

  bool done() const { return at_ >= groups_.size(); }
  int code() const { return groups_[at_].code; }
  bool is(int code) const { return !done() && groups_[at_].code == code; }
  void skip() { ++at_; }
  // Returns the value of the next group if it has this code, else `otherwise`.
  double take(int code, double otherwise = 0) { return is(code) ? number(groups_[at_++]) : otherwise; }
  int whole(int code, int otherwise = 0) { return is(code) ? integer(groups_[at_++]) : otherwise; }
  std::size_t count(int code) {
    const double value = take(code);
    return value > 0 ? std::min(static_cast<std::size_t>(value), groups_.size()) : 0;
  }
  Point point(int code) {
    const double x = take(code);
    return {x, take(code + 10)};
  }

 private:
  std::span<const Group> groups_;
  std::size_t at_ = 0;
};

Ring polyline(Cursor& groups) {
  groups.take(72), groups.take(73);
  std::vector<std::pair<Point, double>> vertices;
  for (std::size_t left = groups.count(93); left > 0 && groups.is(10); --left) {
    const Point p = groups.point(10);
    vertices.emplace_back(p, groups.take(42));
  }
  Ring ring;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto& [a, bulge] = vertices[i];
    const Point b = vertices[(i + 1) % vertices.size()].first;
    ring.push_back(a);
    if (std::abs(bulge) > kStraightBulge && distance(a, b) > 0) add_bulge(ring, a, b, bulge);
  }
  return ring;
}

Ring spline(Cursor& groups) {
  Spline out;
  out.degree = groups.whole(94);
  const bool rational = groups.whole(73) != 0;
  groups.take(74);
  const std::size_t knots = groups.count(95), control = groups.count(96);
  for (std::size_t k = 0; k < knots && groups.is(40); ++k) out.knots.push_back(groups.take(40));
  for (std::size_t k = 0; k < control && groups.is(10); ++k) {
    out.control.push_back(groups.point(10));
    const double weight = groups.take(42, 1);
    if (rational) out.weights.push_back(weight);
  }
  return spline_points(out);
}

// Reads an edge as a chain. Angles of clockwise arcs count clockwise.
Ring edge(Cursor& groups) {
  enum { line = 1, arc = 2, ellipse = 3 };
  const int kind = groups.whole(72);
  if (kind > ellipse) return spline(groups);
  const Point at = groups.point(10);
  if (kind == line) return {at, groups.point(11)};
  const Point major = kind == arc ? Point{1, 0} : groups.point(11);
  const double size = groups.take(40), from = groups.take(50) * kDegree;
  double sweep = std::fmod(groups.take(51) * kDegree - from, kTurn);
  if (sweep <= 1e-9) sweep += kTurn;
  const double turn = groups.whole(73, 1) != 0 ? 1 : -1;
  const Placement circle = kind == arc ? Placement{{size, 0}, {0, turn * size}, at}
                                       : Placement{major, Point{-major.y, major.x} * (turn * size), at};
  return ellipse_points(circle, from, sweep);
}

// Joins edges, some of which run backwards or stand in another order.
Ring joined(std::vector<Ring> edges) {
  std::erase_if(edges, [](const Ring& edge) { return edge.empty(); });
  if (edges.empty()) return {};
  Ring ring = edges.front();
  edges.erase(edges.begin());
  while (!edges.empty()) {
    const auto miss = [&](const Ring& edge) {
      return std::min(distance(ring.back(), edge.front()), distance(ring.back(), edge.back()));
    };
    // Takes the next edge if it fits, as most do; else the nearest one.
    const double tolerance = 1e-6 * (1 + length(ring.back()));
    const auto next = miss(edges.front()) <= tolerance ? edges.begin() : std::ranges::min_element(edges, {}, miss);
    if (distance(ring.back(), next->back()) < distance(ring.back(), next->front())) std::ranges::reverse(*next);
    ring.insert(ring.end(), next->begin(), next->end());
    edges.erase(next);
  }
  return ring;
}

}  // namespace

std::vector<std::vector<Point>> hatch_rings(const Entity& hatch) {
  constexpr int kPolyline = 2, kAroundText = 8;
  enum { odd = 0, outermost = 1, all = 2 };
  Cursor groups(hatch.groups);
  std::vector<Ring> rings;
  int style = odd;
  while (!groups.done() && !groups.is(91)) groups.skip();
  while (!groups.done()) {
    if (groups.is(75)) {
      style = groups.whole(75);
      break;
    }
    if (!groups.is(92)) {
      groups.skip();
      continue;
    }
    const int flags = groups.whole(92);
    Ring ring;
    if ((flags & kPolyline) != 0) {
      ring = polyline(groups);
    } else {
      std::vector<Ring> edges;
      for (std::size_t left = groups.count(93); left > 0; --left) {
        while (!groups.done() && !groups.is(72) && !groups.is(92) && !groups.is(75)) groups.skip();
        if (!groups.is(72)) break;
        edges.push_back(edge(groups));
      }
      ring = joined(std::move(edges));
    }
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    if ((flags & kAroundText) == 0 && ring.size() >= 3) rings.push_back(std::move(ring));
  }
  if (style == odd || rings.size() < 2) return rings;
  const auto depth = depths(rings);
  std::vector<Ring> out;
  for (std::size_t r = 0; r < rings.size(); ++r)
    if (depth[r] == 0 || (style == outermost && depth[r] == 1)) out.push_back(std::move(rings[r]));
  return out;
}

}  // namespace vantage::floor_plan
