// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/join_ends.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/walls.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kSame = 1e-3;    // lines are longer; joins of at least half of it are reported
constexpr double kJoined = 1e-6;  // ends closer than this count as joined

Point nearest_on(const Line& line, Point p) {
  const Point along = line.b - line.a;
  const double t = std::clamp(dot(p - line.a, along) / dot(along, along), 0.0, 1.0);
  return line.a + along * t;
}

// Returns where the extended line would meet the other.
std::optional<Point> crossing(const Line& line, const Line& other) {
  const Point a = line.b - line.a, b = other.b - other.a;
  const double turn = cross(a, b);
  if (std::abs(turn) <= 1e-3 * length(a) * length(b)) return std::nullopt;
  return line.a + a * (cross(other.a - line.a, b) / turn);
}

class Ends {
 public:
  explicit Ends(std::vector<Line> lines) : lines_(std::move(lines)) {
    Grid grid(0.25);
    for (std::size_t l = 0; l < lines_.size(); ++l) grid.add_line(l, lines_[l].a, lines_[l].b, kTolerance_m);
    is_loose_.resize(2 * lines_.size());
    for (std::size_t e = 0; e < 2 * lines_.size(); ++e)
      if (loose(e, grid)) loose_.push_back(e), is_loose_[e] = true;
    find_moves(grid);
  }

  Joined join() {
    std::ranges::sort(moves_, {}, &Move::by);
    std::vector<bool> done(2 * lines_.size());
    Joined out;
    const auto move_to = [&](std::size_t end, Point target) {
      const double by = distance(at(end), target);
      if (distance(target, other(end)) < kSame) return;  // would shrink the line to a point
      at(end) = target;
      if (by < kSame / 2) return;
      ++out.ends;
      out.farthest_m = std::max(out.farthest_m, by);
    };
    for (const Move& move : moves_) {
      if (done[move.end]) continue;
      done[move.end] = true;
      Point target = move.onto ? at(*move.onto) : move.to;
      if (move.onto && !done[*move.onto]) {
        // Both lines extend to their crossing if it is near; else the other line stays.
        const auto corner = crossing(lines_[move.end / 2], lines_[*move.onto / 2]);
        const bool near = corner && is_loose_[*move.onto] && distance(*corner, at(move.end)) <= kTolerance_m &&
                          distance(*corner, at(*move.onto)) <= kTolerance_m;
        if (near) move_to(*move.onto, target = *corner);
        done[*move.onto] = true;
      }
      move_to(move.end, target);
    }
    close_walls(done);
    out.lines = std::move(lines_);
    return out;
  }

 private:
  struct Move {
    std::size_t end;
    std::optional<std::size_t> onto;  // another end
    Point to;
    double by;
  };

  Point& at(std::size_t end) { return end % 2 == 0 ? lines_[end / 2].a : lines_[end / 2].b; }
  Point other(std::size_t end) { return at(end ^ 1U); }

  bool wide(std::size_t line) const { return lines_[line].width >= kThinnestWall_m; }
  // A wide line is a wall of its own: lines of other walls end at its faces, not at its middle.
  bool may_join(std::size_t end, std::size_t line) const { return line != end / 2 && wide(line) == wide(end / 2); }

  bool loose(std::size_t end, const Grid& grid) {
    const Point p = at(end);
    bool meets = false;
    grid.visit(p, p, [&](std::size_t l) {
      meets = meets || (may_join(end, l) && distance(nearest_on(lines_[l], p), p) <= kJoined);
    });
    return !meets;
  }

  void find_moves(const Grid& grid) {
    for (const std::size_t end : loose_) {
      const Point p = at(end);
      std::optional<Move> to_end, to_line;
      const auto better = [](std::optional<Move>& best, const Move& move) {
        if (!best || move.by < best->by) best = move;
      };
      grid.visit(p, p, [&](std::size_t l) {
        if (!may_join(end, l)) return;
        for (const std::size_t e : {2 * l, 2 * l + 1})
          if (const double by = distance(at(e), p); by <= kTolerance_m) better(to_end, {end, e, at(e), by});
        if (distance(nearest_on(lines_[l], p), p) > kTolerance_m) return;
        const auto meeting = crossing(lines_[end / 2], lines_[l]);
        const bool straight_on = meeting && distance(*meeting, p) <= kTolerance_m &&
                                 distance(nearest_on(lines_[l], *meeting), *meeting) <= kSame;
        const Point to = straight_on ? *meeting : nearest_on(lines_[l], p);
        better(to_line, {end, std::nullopt, to, distance(to, p)});
      });
      const bool on_line = to_line && to_line->by < kSame && !(to_end && to_end->by < kSame);
      if (to_end && !on_line)
        moves_.push_back(*to_end);
      else if (to_line)
        moves_.push_back(*to_line);
    }
  }

  void close_walls(const std::vector<bool>& done) {
    Grid grid(1.0);
    for (const std::size_t end : loose_)
      if (!done[end]) grid.add(end, at(end), at(end));
    std::vector<bool> closed(2 * lines_.size());
    for (const std::size_t end : loose_) {
      if (done[end] || closed[end] || wide(end / 2)) continue;
      const Point p = at(end), outward = (p - other(end)) * (1 / distance(p, other(end)));
      std::optional<std::size_t> best;
      const Point reach{kThickestWall_m, kThickestWall_m};
      grid.visit(p - reach, p + reach, [&](std::size_t e) {
        if (e / 2 == end / 2 || closed[e] || done[e] || wide(e / 2)) return;
        const Point to = at(e) - p, way = (at(e) - other(e)) * (1 / distance(at(e), other(e)));
        const double wide = length(to);
        const bool side_by_side = wide >= kThinnestWall_m && wide <= kThickestWall_m && dot(way, outward) > 0.98 &&
                                  std::abs(dot(to, outward)) <= 0.35 * wide;
        if (side_by_side && (!best || wide < distance(at(*best), p))) best = e;
      });
      if (!best) continue;
      closed[end] = closed[*best] = true;
      lines_.push_back({p, at(*best), lines_[end / 2].from});
    }
  }

  std::vector<Line> lines_;
  std::vector<std::size_t> loose_;  // ends that meet nothing: 2 l is the first of line l, 2 l + 1 the second
  std::vector<bool> is_loose_;      // of all ends
  std::vector<Move> moves_;
};

}  // namespace

Joined join_ends(std::vector<Line> lines) {
  std::erase_if(lines, [](const Line& line) { return distance(line.a, line.b) < kSame; });
  return Ends(std::move(lines)).join();
}

}  // namespace vantage::floor_plan
