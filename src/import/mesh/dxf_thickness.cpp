// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/dxf_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "import/floor_plan/content.hpp"

namespace vantage::importer {

using floor_plan::Entity, floor_plan::Group, floor_plan::Point;

glm::dmat4 world_from_object(const Entity& entity) {
  glm::dmat4 out(1);
  const floor_plan::Axes axes = floor_plan::object_axes(entity);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[c][r] = axes[static_cast<std::size_t>(c)][static_cast<std::size_t>(r)];
  return out;
}

namespace {

// A corner of a flat polyline: `bulge` is the tangent of a quarter of the angle of the arc that follows.
struct Corner {
  Point at;
  double bulge = 0, begin_width = 0, end_width = 0;
};

class ThickLine {
 public:
  ThickLine(const Entity& entity, double metres) : entity_(entity), metres_(metres) {}

  std::vector<std::vector<glm::dvec3>> faces(const std::vector<Entity>& parts) {
    constexpr int kInSpace = 8;
    if (entity_.number(39) == 0) return {};
    if (entity_.type == "LINE") add_line();
    if (entity_.type == "ARC")
      add_arc(entity_.number(50) * floor_plan::kDegree, entity_.number(51) * floor_plan::kDegree);
    if (entity_.type == "CIRCLE") add_circle();
    if (entity_.type == "LWPOLYLINE") add_polyline(light_corners(), entity_.number(38));
    if (entity_.type == "POLYLINE" && (entity_.integer(70) & kInSpace) == 0)
      add_polyline(corners_of(parts), entity_.number(30));
    return std::move(faces_);
  }

 private:
  glm::dvec3 point(int code) const {
    return {entity_.number(code), entity_.number(code + 10), entity_.number(code + 20)};
  }

  // The ends of a LINE are in world coordinates; only its extrusion is in object coordinates.
  void add_line() {
    const glm::dvec3 a = point(10), b = point(11), up = glm::dvec3(system_[2]) * entity_.number(39);
    faces_.push_back({a, b, b + up, a + up});
  }
  std::vector<Point> arc(double from, double sweep) const {
    const glm::dvec3 c = point(10);
    const Point centre{c.x, c.y}, arm = Point{std::cos(from), std::sin(from)} * std::abs(entity_.number(40));
    return chords({centre, centre + arm, sweep, {}});
  }
  void add_arc(double from, double to) {
    double sweep = std::fmod(to - from, floor_plan::kTurn);
    if (sweep <= 0) sweep += floor_plan::kTurn;
    stand_on(arc(from, sweep), entity_.number(30));
  }
  void add_circle() {
    const std::vector<Point> ring = arc(0, floor_plan::kTurn);
    const double elevation = entity_.number(30);
    stand_on(ring, elevation);
    for (std::size_t k = 1; k + 2 < ring.size(); ++k) add_lids({ring[0], ring[k], ring[k + 1]}, elevation);
  }

  std::vector<Corner> light_corners() const {
    std::vector<Corner> corners;
    const double width = entity_.number(43);
    for (const Group& group : entity_.groups) {
      if (group.code == 10) corners.push_back({{number(group), 0}, 0, width, width});
      if (corners.empty()) continue;
      Corner& last = corners.back();
      if (group.code == 20) last.at.y = number(group);
      if (group.code == 40) last.begin_width = number(group);
      if (group.code == 41) last.end_width = number(group);
      if (group.code == 42) last.bulge = number(group);
    }
    return corners;
  }
  std::vector<Corner> corners_of(const std::vector<Entity>& vertices) const {
    constexpr int kFrame = 16;  // a vertex that only guides the curve
    std::vector<Corner> corners;
    for (const Entity& vertex : vertices)
      if ((vertex.integer(70) & kFrame) == 0)
        corners.push_back({{vertex.number(10), vertex.number(20)},
                           vertex.number(42),
                           vertex.number(40, entity_.number(40)),
                           vertex.number(41, entity_.number(41))});
    return corners;
  }

  // A polyline of changing width is read with its least width.
  void add_polyline(const std::vector<Corner>& corners, double elevation) {
    const bool closed = (entity_.integer(70) & 1) != 0;
    const std::size_t edges = corners.size() < 2 ? 0 : corners.size() - (closed ? 0 : 1);
    std::vector<Point> line;
    double width = std::numeric_limits<double>::max();
    const auto add = [&](Point p) {
      if (line.empty() || !(line.back() == p)) line.push_back(p);
    };
    for (std::size_t k = 0; k < edges; ++k) {
      const Corner &a = corners[k], &b = corners[(k + 1) % corners.size()];
      width = std::min({width, a.begin_width, a.end_width});
      add(a.at);
      if (std::abs(a.bulge) > floor_plan::kStraightBulge && !(a.at == b.at))
        for (const Point& p :
             chords({floor_plan::bulge_circle(a.at, b.at, a.bulge).origin, a.at, 4 * std::atan(a.bulge), {}}))
          add(p);
      add(b.at);
    }
    if (line.size() < 2) return;
    if (width > 0)
      stand_on_band(line, closed && line.size() > 3, width / 2, elevation);
    else
      stand_on(line, elevation);
  }

  // Keeps chords within 5 mm and 1/50 of the radius of an arc, or within 1/1000 if the unit is not known.
  std::vector<Point> chords(const floor_plan::Arc& arc) const {
    const double radius = arc.radius();
    return floor_plan::chain(arc, metres_ > 0 ? std::min(floor_plan::kCurve_m / metres_, radius / 50) : radius / 1000);
  }

  glm::dvec3 world(Point p, double height) const { return glm::dvec3(system_ * glm::dvec4(p.x, p.y, height, 1)); }

  void add_side(Point a, Point b, double elevation) {
    faces_.push_back({world(a, elevation + low_), world(b, elevation + low_), world(b, elevation + high_),
                      world(a, elevation + high_)});
  }
  void stand_on(const std::vector<Point>& line, double elevation) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) add_side(line[k], line[k + 1], elevation);
  }
  // Adds both lids of a counter-clockwise ring; the upper one faces up, the lower one down.
  void add_lids(const std::vector<Point>& ring, double elevation) {
    std::vector<glm::dvec3> upper, lower;
    for (const Point& p : ring)
      upper.push_back(world(p, elevation + high_)), lower.push_back(world(p, elevation + low_));
    std::ranges::reverse(lower);
    faces_.push_back(std::move(upper)), faces_.push_back(std::move(lower));
  }
  // Adds a body that reaches `half` to each side of a line, with mitred corners. A closed line ends where it begins.
  void stand_on_band(const std::vector<Point>& line, bool closed, double half, double elevation) {
    const std::size_t edges = line.size() - 1;
    const auto across = [&](std::size_t k) {  // the k-th edge
      const Point along = line[k + 1] - line[k];
      return Point{-along.y, along.x} * (1 / floor_plan::length(along));
    };
    std::vector<Point> left, right;
    for (std::size_t k = 0; k <= edges; ++k) {
      const Point before = across(k > 0 ? k - 1 : closed ? edges - 1 : 0);
      const Point after = across(k < edges ? k : closed ? 0 : edges - 1);
      constexpr double kSharpest = 0.2;  // no mitre is longer than five widths
      const Point mitre = (before + after) * (half / std::max(1 + dot(before, after), kSharpest));
      left.push_back(line[k] + mitre), right.push_back(line[k] - mitre);
    }
    for (std::size_t k = 0; k < edges; ++k) {
      add_side(right[k], right[k + 1], elevation), add_side(left[k + 1], left[k], elevation);
      add_lids({right[k], right[k + 1], left[k + 1], left[k]}, elevation);
    }
    if (!closed) add_side(left.front(), right.front(), elevation), add_side(right.back(), left.back(), elevation);
  }

  const Entity& entity_;
  double metres_ = 0;
  glm::dmat4 system_ = world_from_object(entity_);
  double low_ = std::min(entity_.number(39), 0.0), high_ = std::max(entity_.number(39), 0.0);
  std::vector<std::vector<glm::dvec3>> faces_;
};

}  // namespace

std::vector<std::vector<glm::dvec3>> faces_of_thick_line(const Entity& entity, const std::vector<Entity>& parts,
                                                         double metres) {
  return ThickLine(entity, metres).faces(parts);
}

}  // namespace vantage::importer
