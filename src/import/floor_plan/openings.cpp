// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/openings.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include "core/disjoint_sets.hpp"
#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/walls.hpp"

namespace vantage::floor_plan {
namespace {

// Widths of gaps. Metres.
constexpr double kNarrowestGap = 0.45, kWidestGap = 2.6;  // between two ends that face each other
constexpr double kWidestShown = 12;                       // with a window or swings drawn in it
constexpr double kWidestToWall = 1.35;                    // between an end and the opposite wall
constexpr double kNear = 0.2;                             // by which symbols may miss their gaps

// The short side at which a wall ends. Seen from a towards b, the wall lies to the left.
struct Cap {
  Point a, b;
  Point middle() const { return (a + b) * 0.5; }
  double width() const { return distance(a, b); }
  Point outward() const {
    const Point along = (b - a) * (1 / width());
    return {along.y, -along.x};
  }
};

// Returns a ring without the corners on its straight sides.
std::vector<Point> corners_of(const std::vector<Point>& ring) {
  constexpr double kStraight_m = 5e-4;
  std::vector<Point> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point before = out.empty() ? ring.back() : out.back(), after = ring[(i + 1) % ring.size()];
    const double chord = distance(before, after);
    if (!(chord > 0) || std::abs(cross(ring[i] - before, after - before)) > kStraight_m * chord ||
        dot(ring[i] - before, after - ring[i]) < 0)
      out.push_back(ring[i]);
  }
  return out;
}

// Jambs may have rebates and frames, so that a wall may end in several steps, no deeper than kDeepestJamb.
constexpr std::size_t kMostJambSides = 7;
constexpr double kDeepestJamb = 0.12;

// Returns the cap of a wall whose side ends in ring[i] and resumes at ring[i + sides]; nothing if no wall ends there.
std::optional<Cap> cap_at(const std::vector<Point>& ring, std::size_t i, std::size_t sides) {
  constexpr double kLeastSide = 0.04, kStraight = 0.93;
  const std::size_t n = ring.size();
  const auto corner = [&](std::size_t k) { return ring[(i + n + k) % n]; };
  const Point before = ring[(i + n - 1) % n], a = corner(0), b = corner(sides), after = corner(sides + 1);
  const double left = distance(before, a), right = distance(b, after);
  if (left < kLeastSide || right < kLeastSide) return {};
  const Point in = (a - before) * (1 / left), out = (after - b) * (1 / right);
  const double wide = sides == 1 ? distance(a, b) : cross(in, b - a);
  if (wide < kThinnestWall_m || wide > kThickestWall_m) return {};
  double deepest = std::max(0.0, dot(b - a, in)), shallowest = std::min(0.0, dot(b - a, in));
  if (sides == 1) {
    const Point over = (b - a) * (1 / wide);
    if (cross(in, over) < kStraight || cross(over, out) < kStraight) return {};  // both corners are convex
  } else {
    if (dot(in, out) > -0.98) return {};
    for (std::size_t k = 1; k < sides; ++k) {
      deepest = std::max(deepest, dot(corner(k) - a, in)), shallowest = std::min(shallowest, dot(corner(k) - a, in));
      const double across = cross(in, corner(k) - a);
      if (across < -kDeepestJamb || across > wide + kDeepestJamb) return {};
    }
    if (deepest - shallowest > kDeepestJamb) return {};
  }
  // A column has such short sides all around; a wall continues, or bends where its end begins.
  const Point further = ring[(i + n - 2) % n], last = corner(sides + 2);
  const bool bends = cross(a - before, before - further) > 0 || cross(last - after, after - b) > 0;
  if (!bends && std::max(left, right) < 2 * wide) return {};
  if (sides == 1) return Cap{a, b};
  return Cap{a + in * deepest, b + in * (deepest - dot(b - a, in))};
}

std::vector<Cap> caps_of(const Shape& solid) {
  std::vector<Cap> caps;
  for (const auto& whole : rings(solid)) {
    const auto ring = corners_of(whole);
    std::vector<bool> taken(ring.size());  // sides of caps
    for (std::size_t sides = 1; sides <= kMostJambSides && sides + 3 <= ring.size(); ++sides)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        bool free = true;
        for (std::size_t k = 0; k < sides; ++k) free = free && !taken[(i + k) % ring.size()];
        if (!free) continue;
        const auto cap = cap_at(ring, i, sides);
        if (!cap) continue;
        for (std::size_t k = 0; k < sides; ++k) taken[(i + k) % ring.size()] = true;
        caps.push_back(*cap);
      }
  }
  return caps;
}

class Finder {
 public:
  Finder(const Shape& solid, const Drawing& drawing, const std::vector<Swing>& swings)
      : solid_(clone(solid)), drawing_(drawing), swings_(swings), swing_used_(swings.size()) {
    for (const auto& ring : rings(solid))
      for (std::size_t i = 0; i < ring.size(); ++i) edges_.push_back({ring[i], ring[(i + 1) % ring.size()], {}});
    for (std::size_t e = 0; e < edges_.size(); ++e) edge_grid_.add_line(e, edges_[e].a, edges_[e].b, 0);
    for (std::size_t s = 0; s < swings.size(); ++s) {
      const Point reach{swings[s].width, swings[s].width};
      swing_grid_.add(s, swings[s].hinge - reach, swings[s].hinge + reach);
    }
    collect_symbols();
  }

  std::vector<Opening> find() {
    between_caps();
    by_swings();
    by_symbols();
    return std::move(openings_);
  }

 private:
  // Points of one symbol or of a cluster of loose lines.
  struct Group {
    Kind kind;
    std::vector<Point> points;
    bool used = false;
  };

  // A ray's distance to the nearest edge of a wall, if within `far`.
  struct Hit {
    double at = std::numeric_limits<double>::infinity();
    std::size_t edge = 0;
  };
  Hit look(Point from, Point way, double far) const {
    Hit hit;
    const Point to = from + way * far;
    edge_grid_.visit(lowest(from, to), highest(from, to), [&](std::size_t e) {
      const Line& edge = edges_[e];
      const Point along = edge.b - edge.a;
      const double turn = cross(way, along);
      if (std::abs(turn) < 1e-9) return;
      const double at = cross(edge.a - from, along) / turn, on = cross(edge.a - from, way) / turn;
      if (at > 1e-3 && at <= far && on >= -1e-9 && on <= 1 + 1e-9 && at < hit.at) hit = {at, e};
    });
    return hit;
  }

  void between_caps() {
    const auto caps = caps_of(solid_);
    Grid grid(2.0);
    for (std::size_t c = 0; c < caps.size(); ++c) grid.add(c, caps[c].middle(), caps[c].middle());
    std::vector<bool> taken(caps.size());
    for (std::size_t c = 0; c < caps.size(); ++c) {
      if (taken[c]) continue;
      const Cap& cap = caps[c];
      const Point from = cap.middle(), way = cap.outward();
      const Hit hit = look(from, way, kWidestShown);
      if (!(hit.at >= kNarrowestGap && hit.at <= kWidestShown)) continue;
      const Point far = from + way * hit.at;
      std::optional<std::size_t> partner;
      grid.visit(far - Point{0.7, 0.7}, far + Point{0.7, 0.7}, [&](std::size_t d) {
        if (d == c || taken[d] || dot(caps[d].outward(), way) > -0.97) return;
        const Point to = caps[d].middle() - from;
        if (std::abs(dot(to, way) - hit.at) <= kDeepestJamb &&
            std::abs(cross(way, to)) <= std::max(cap.width(), caps[d].width()) / 2)
          partner = d;
      });
      std::vector<Point> corners{cap.a, cap.b};
      if (partner) {
        corners.push_back(caps[*partner].a), corners.push_back(caps[*partner].b);
      } else {
        const Line& edge = edges_[hit.edge];
        const Point along = (edge.b - edge.a) * (1 / distance(edge.a, edge.b));
        if (std::abs(dot(along, way)) > 0.2) continue;
        // Both sides of the wall's end must meet the same wall.
        const Hit left = look(cap.a + (cap.middle() - cap.a) * 0.02, way, kWidestShown),
                  right = look(cap.b + (cap.middle() - cap.b) * 0.02, way, kWidestShown);
        if (std::abs(left.at - hit.at) > 0.1 || std::abs(right.at - hit.at) > 0.1) continue;
        corners.push_back(cap.a + way * left.at), corners.push_back(cap.b + way * right.at);
      }
      Shape gap = hull(corners);
      const bool swings = takes_swings(gap, hit.at), window = !swings && takes_windows(gap, hit.at);
      const double widest = swings || window ? kWidestShown : partner ? kWidestGap : kWidestToWall;
      if (hit.at > widest) continue;
      taken[c] = true;
      if (partner) taken[*partner] = true;
      openings_.push_back({swings ? Opening::door : window ? Opening::window : Opening::passage, std::move(gap)});
    }
  }

  // Returns true if the leaves of doors close this gap; marks their swings as used.
  bool takes_swings(const Shape& gap_area, double width) {
    const Bounds box = bounds(gap_area);
    const Region region(grown(gap_area, kNear));
    std::vector<std::size_t> in_gap;
    swing_grid_.visit(box.low, box.high, [&](std::size_t s) {
      const Swing& swing = swings_[s];
      const bool closes = region.holds(swing.hinge) && (region.holds(swing.ends[0]) || region.holds(swing.ends[1]));
      if (closes && std::ranges::find(in_gap, s) == in_gap.end()) in_gap.push_back(s);
    });
    double leaves = 0;
    for (const std::size_t s : in_gap) leaves += swings_[s].width;
    constexpr double kFrames = 0.3;
    if (width > 1.2 * leaves + kFrames) return false;
    for (const std::size_t s : in_gap) swing_used_[s] = true;
    return !in_gap.empty();
  }

  // Returns true if part of a window lies in this gap and spans half of it; marks such groups as used.
  bool takes_windows(const Shape& gap_area, double width) {
    const Region region(grown(gap_area, kNear));
    const Bounds box = bounds(region.shape());
    bool any = false;
    group_grid_.visit(box.low, box.high, [&](std::size_t g) {
      Group& group = groups_[g];
      std::vector<Point> within;
      for (const Point& p : group.points)
        if (region.holds(p)) within.push_back(p);
      if (within.size() < 2) return;
      double span = 0;
      for (const Point& p : within) span = std::max(span, distance(p, within.front()));
      if (group.kind != Kind::window || span < width / 2) {
        group.used = group.used || group.kind == Kind::door;  // a threshold
        return;
      }
      group.used = any = true;
    });
    return any;
  }

  // Adds doors whose wall is drawn through, or whose ends no gap between caps shows.
  void by_swings() {
    for (std::size_t s = 0; s < swings_.size(); ++s) {
      if (swing_used_[s]) continue;
      const Swing& swing = swings_[s];
      std::optional<Line> closed;
      double best = 0.3;  // largest distance of both ends from walls, summed
      for (const Point& end : swing.ends) {
        const Point along = (end - swing.hinge) * (1 / swing.width);
        const double miss = to_wall(swing.hinge - along * 0.05) + to_wall(end + along * 0.05);
        if (miss < best) best = miss, closed = Line{swing.hinge, end, {}};
      }
      if (!closed) continue;
      const Point along = (closed->b - closed->a) * (1 / swing.width), across{-along.y, along.x};
      // A band along the leaf, as wide as walls may be, cuts the opening out of the walls.
      const std::array<Point, 4> band{closed->a - across * kThickestWall_m, closed->b - across * kThickestWall_m,
                                      closed->b + across * kThickestWall_m, closed->a + across * kThickestWall_m};
      const std::array<Point, 4> leaf{closed->a - across * 0.06, closed->b - across * 0.06, closed->b + across * 0.06,
                                      closed->a + across * 0.06};
      Shape cut = touching(common(solid_, polygon(band)), polygon(leaf));
      const bool through = area(cut) >= 0.6 * swing.width * kThinnestWall_m;
      openings_.push_back({Opening::door, through ? std::move(cut) : polygon(leaf)});
    }
  }

  void by_symbols() {
    for (Group& group : groups_) {
      if (group.used || group.points.size() < 2) continue;
      const Shape box = around(group.points);
      const auto corners = outer_ring(box);
      double wide = 0, deep = 0;
      Point along{1, 0}, middle = group.points.front();
      if (corners.size() == 4) {
        wide = distance(corners[0], corners[1]), deep = distance(corners[1], corners[2]);
        along = corners[1] - corners[0];
        if (deep > wide) std::swap(wide, deep), along = corners[2] - corners[1];
        middle = (corners[0] + corners[2]) * 0.5;
      } else {  // collinear
        for (const Point& p : group.points)
          for (const Point& q : group.points)
            if (distance(p, q) > wide) wide = distance(p, q), along = p - q, middle = (p + q) * 0.5;
      }
      constexpr double kDeepestSymbol = 0.9;
      if (wide < kNarrowestGap || wide > kWidestShown || deep > kDeepestSymbol || deep > wide) continue;
      along = along * (1 / length(along));
      const Point across{-along.y, along.x}, half = along * (wide / 2);
      const auto band = [&](double to) {
        const std::array<Point, 4> ring{middle - half - across * to, middle + half - across * to,
                                        middle + half + across * to, middle - half + across * to};
        return polygon(ring);
      };
      const Shape symbol = band(std::max(deep / 2, 0.02));
      Shape cut = touching(common(solid_, band(deep / 2 + kThickestWall_m / 2)), symbol);
      const Opening::Kind kind = group.kind == Kind::window ? Opening::window : Opening::door;
      if (area(cut) >= 0.5 * wide * kThinnestWall_m)
        openings_.push_back({kind, std::move(cut)});
      else if (to_wall(middle - half) + to_wall(middle + half) <= 2 * kNear)
        openings_.push_back({kind, clone(symbol)});
    }
  }

  // Returns the parts of a shape that meet another.
  static Shape touching(const Shape& shape, const Shape& other) {
    std::vector<Shape> parts;
    for (Shape& part : polygons(shape))
      if (gap(part, other) <= 0.01) parts.push_back(std::move(part));
    return areas(united(std::move(parts)));
  }

  double to_wall(Point p) const {
    const Point reach{0.4, 0.4};
    double best = std::numeric_limits<double>::infinity();
    edge_grid_.visit(p - reach, p + reach, [&](std::size_t e) {
      const Line& edge = edges_[e];
      const Point along = edge.b - edge.a;
      const double t = std::clamp(dot(p - edge.a, along) / dot(along, along), 0.0, 1.0);
      best = std::min(best, distance(edge.a + along * t, p));
    });
    return inside_.holds(p) ? 0 : best;
  }

  // Collects symbols of doors and windows, and connected components of loose lines on their layers.
  void collect_symbols() {
    std::map<int, std::size_t> by_symbol;
    std::vector<std::pair<Point, Point>> loose;
    std::vector<Kind> loose_kinds;
    const auto take = [&](const Origin& from, const std::vector<Point>& points) {
      if (from.kind != Kind::window && from.kind != Kind::door) return;
      if (from.symbol >= 0) {
        const auto [found, is_new] = by_symbol.try_emplace(from.symbol, groups_.size());
        if (is_new) groups_.push_back({from.kind, {}});
        auto& all = groups_[found->second].points;
        all.insert(all.end(), points.begin(), points.end());
        return;
      }
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        loose.emplace_back(points[i], points[i + 1]);
        loose_kinds.push_back(from.kind);
      }
    };
    for (const Line& line : drawing_.lines) take(line.from, {line.a, line.b});
    for (const Arc& arc : drawing_.arcs) take(arc.from, chain(arc, 0.02));
    cluster(loose, loose_kinds);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Point low = groups_[g].points.front(), high = low;
      for (const Point& p : groups_[g].points) low = lowest(low, p), high = highest(high, p);
      group_grid_.add(g, low, high);
    }
  }

  void cluster(const std::vector<std::pair<Point, Point>>& loose, const std::vector<Kind>& kinds) {
    // Lines of one window touch, or lie side by side, at most a wall's thickness apart.
    DisjointSets windows(loose.size());
    const auto to_line = [](Point p, const std::pair<Point, Point>& line) {
      const Point along = line.second - line.first;
      const double t = std::clamp(dot(p - line.first, along) / std::max(dot(along, along), 1e-12), 0.0, 1.0);
      return distance(line.first + along * t, p);
    };
    // True if the middle of one lies abreast of the other.
    const auto abreast = [&](const std::pair<Point, Point>& a, const std::pair<Point, Point>& b) {
      const Point u = a.second - a.first, v = b.second - b.first, middle = (a.first + a.second) * 0.5;
      const double at = dot(middle - b.first, v) / std::max(dot(v, v), 1e-12);
      return std::abs(cross(u, v)) <= 0.05 * length(u) * length(v) && at >= 0 && at <= 1 &&
             to_line(middle, b) <= kThickestWall_m;
    };
    constexpr double kTouch = 0.03;
    Grid grid(1.0);
    for (std::size_t i = 0; i < loose.size(); ++i) grid.add_line(i, loose[i].first, loose[i].second, kThickestWall_m);
    for (std::size_t i = 0; i < loose.size(); ++i)
      for (const Point& p : {loose[i].first, loose[i].second, (loose[i].first + loose[i].second) * 0.5})
        grid.visit(p, p, [&](std::size_t j) {
          if (kinds[j] == kinds[i] && (to_line(p, loose[j]) <= kTouch || abreast(loose[i], loose[j])))
            windows.join(i, j);
        });
    std::map<std::size_t, std::size_t> groups;
    for (std::size_t i = 0; i < loose.size(); ++i) {
      const auto [found, is_new] = groups.try_emplace(windows.find(i), groups_.size());
      if (is_new) groups_.push_back({kinds[i], {}});
      groups_[found->second].points.push_back(loose[i].first);
      groups_[found->second].points.push_back(loose[i].second);
    }
  }

  Shape solid_;
  const Drawing& drawing_;
  const std::vector<Swing>& swings_;
  std::vector<bool> swing_used_;
  std::vector<Line> edges_;
  Grid edge_grid_{1.0}, swing_grid_{1.0}, group_grid_{1.0};
  std::vector<Group> groups_;
  std::vector<Opening> openings_;
  Region inside_{clone(solid_)};
};

}  // namespace

std::vector<Opening> find_openings(const Shape& solid, const Drawing& drawing, const std::vector<Swing>& swings) {
  return Finder(solid, drawing, swings).find();
}

}  // namespace vantage::floor_plan
