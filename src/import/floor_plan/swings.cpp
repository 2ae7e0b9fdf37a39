// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/swings.hpp"

#include <algorithm>
#include <optional>

#include "import/floor_plan/grid.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kNarrowestLeaf = 0.45, kWidestLeaf = 1.6;  // leaves; narrower ones are cabinets'
constexpr double kLeafThickness = 0.08;

// A leaf is a line from the hinge to an end, open or closed, or its other long side. A line of a wall counts only if it
// is as long as the door.
bool is_leaf(const Line& line, const Swing& swing) {
  constexpr double kExact = 0.03;
  return std::ranges::any_of(swing.ends, [&](const Point& end) {
    if (line.from.kind == Kind::wall) {
      const auto joins = [&](Point a, Point b) {
        return distance(a, swing.hinge) <= kExact && distance(b, end) <= kExact;
      };
      return joins(line.a, line.b) || joins(line.b, line.a);
    }
    const Point along = (end - swing.hinge) * (1 / swing.width);
    const auto beside = [&](Point p) {
      const double at = dot(p - swing.hinge, along);
      return std::abs(cross(along, p - swing.hinge)) <= kLeafThickness && at >= -kLeafThickness &&
             at <= swing.width + kLeafThickness;
    };
    return beside(line.a) && beside(line.b);
  });
}

// Finds the line from the hinge to about the begin or end of an arc: a door that is drawn half open.
class Leaves {
 public:
  explicit Leaves(const std::vector<Line>& lines) : lines_(lines) {
    for (std::size_t l = 0; l < lines.size(); ++l)
      for (const Point& end : {lines[l].a, lines[l].b}) grid_.add(l, end, end);
  }
  std::optional<std::size_t> of(const Arc& arc) const {
    constexpr double kNear = 0.15;
    const auto from_hinge = [&](Point a, Point b) {
      return distance(a, arc.centre) <= kNear && (distance(b, arc.start) <= kNear || distance(b, arc.end()) <= kNear);
    };
    std::optional<std::size_t> leaf;  // the first of several
    const Point reach{kNear, kNear};
    grid_.visit(arc.centre - reach, arc.centre + reach, [&](std::size_t l) {
      const Line& line = lines_[l];
      if ((!leaf || l < *leaf) && (from_hinge(line.a, line.b) || from_hinge(line.b, line.a))) leaf = l;
    });
    return leaf;
  }

 private:
  const std::vector<Line>& lines_;
  Grid grid_{0.5};
};

}  // namespace

bool may_swing(const Arc& arc) {
  const double sweep = std::abs(arc.sweep);
  return sweep >= 55 * kDegree && sweep <= 100 * kDegree;
}

std::vector<Swing> take_swings(Drawing& drawing) {
  std::optional<Leaves> leaves;  // few drawings need them
  std::vector<Swing> swings;
  std::vector<bool> is_taken(drawing.lines.size());
  std::erase_if(drawing.arcs, [&](const Arc& arc) {
    const double radius = arc.radius(), sweep = std::abs(arc.sweep);
    const Kind kind = arc.from.kind;
    if (radius < kNarrowestLeaf || radius > kWidestLeaf || kind == Kind::furniture || kind == Kind::annotation ||
        kind == Kind::stair)
      return false;
    if (!may_swing(arc)) {
      if (sweep < 10 * kDegree || sweep > 55 * kDegree) return false;
      if (!leaves) leaves.emplace(drawing.lines);
      const auto leaf = leaves->of(arc);
      if (!leaf) return false;
      is_taken[*leaf] = true;
    }
    swings.push_back({arc.centre, {arc.start, arc.end()}, radius, arc.from.layer});
    return true;
  });
  Grid grid(1.0);
  for (std::size_t s = 0; s < swings.size(); ++s) {
    const Point reach{swings[s].width + kLeafThickness, swings[s].width + kLeafThickness};
    grid.add(s, swings[s].hinge - reach, swings[s].hinge + reach);
  }
  std::size_t next = 0;
  std::erase_if(drawing.lines, [&](const Line& line) {
    bool leaf = is_taken[next++];
    grid.visit(line.a, line.a, [&](std::size_t s) { leaf = leaf || is_leaf(line, swings[s]); });
    return leaf;
  });
  return swings;
}

}  // namespace vantage::floor_plan
