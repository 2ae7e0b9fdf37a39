// SPDX-License-Identifier: Apache-2.0
// Draws each type of entity, seen from above.
#include <algorithm>
#include <array>
#include <cmath>

#include "import/floor_plan/content.hpp"
#include "import/floor_plan/labels.hpp"
#include "import/floor_plan/layers.hpp"

namespace vantage::floor_plan {
namespace {

// A vertex of a polyline: `bulge` is the tangent of a quarter of the angle of the arc that follows.
struct Vertex {
  Point at;
  double bulge = 0, width = 0;
};

// A vertex of a multiline: the place of each element along the mitre, and where its dashes begin and end.
struct MultilineVertex {
  Point at, mitre;
  std::vector<std::vector<double>> elements;
};

class Adder {
 public:
  Adder(const Entity& entity, const std::vector<Entity>& parts, Layers& layers, Content& into)
      : entity_(entity), parts_(parts), layers_(layers), into_(into), from_{layers.index(entity.text(8, "0"))} {}

  void add() {
    constexpr std::array<std::string_view, 3> kDrawNothing{"VIEWPORT", "SEQEND", "ENDBLK"};
    if (std::ranges::find(kDrawNothing, entity_.type) != kDrawNothing.end()) return;
    constexpr int kConstant = 2;
    const bool definition = entity_.type == "ATTDEF";  // an ATTDEF's value differs for each insert
    if (definition && (entity_.integer(70) & kConstant) == 0) return;
    Fate fate = Fate::drawn;
    if (entity_.integer(67) != 0)
      fate = Fate::paper_space;
    else if (entity_.integer(60) != 0)
      fate = Fate::invisible;
    else if (!draw())
      fate = Fate::not_read;
    if (entity_.type != "INSERT" || fate != Fate::drawn)
      ++into_.entities[{fate, from_.layer, std::string(entity_.type)}];
  }

 private:
  // Draws the entity; returns false if its type is not read.
  bool draw() {
    const std::string_view type = entity_.type;
    if (type == "LINE" || type == "3DLINE") return add_line(point(10), point(11));
    if (type == "ARC") return add_arc();
    if (type == "CIRCLE") return add_circle(0, kTurn);
    if (type == "ELLIPSE") return add_ellipse();
    if (type == "LWPOLYLINE") return add_light_polyline();
    if (type == "POLYLINE") return add_polyline();
    if (type == "MLINE") return add_multiline();
    if (type == "SPLINE") return add_spline();
    if (type == "SOLID" || type == "TRACE") return add_quad(object_system(entity_.number(30)), {10, 11, 13, 12});
    if (type == "3DFACE") return add_quad({}, {10, 11, 12, 13});
    if (type == "HATCH") return add_hatch();
    if (type == "INSERT") return add_insert();
    if (type == "TEXT") return add_text(73);
    if (type == "ATTDEF") return add_text(74);
    if (type == "MTEXT") return add_paragraph();
    return false;
  }

  Point point(int code) const { return {entity_.number(code), entity_.number(code + 10)}; }

  // Returns the transform from an entity's object coordinates, at some height, to the world seen from above.
  Placement object_system(double height) const {
    const auto [x, y, n] = object_axes(entity_);
    if (n[0] == 0 && n[1] == 0) height = 0;  // it moves nothing, even if it is no number
    return {{x[0], x[1]}, {y[0], y[1]}, {n[0] * height, n[1] * height}};
  }

  bool add_line(Point a, Point b, double width = 0) {
    into_.lines.push_back({a, b, from_, width});
    return true;
  }

  bool add_circle(double from, double sweep) {
    const double radius = entity_.number(40);
    const Placement circle{{radius, 0}, {0, radius}, point(10)};
    if (radius != 0)
      floor_plan::add_arc(object_system(entity_.number(30)) * circle, from, sweep, from_, into_.arcs, into_.curves);
    return true;
  }
  bool add_arc() {
    const double from = entity_.number(50) * kDegree;
    double sweep = std::fmod(entity_.number(51) * kDegree - from, kTurn);
    if (sweep <= 0) sweep += kTurn;
    return add_circle(from, sweep);
  }
  bool add_ellipse() {
    const std::array major{entity_.number(11), entity_.number(21), entity_.number(31)};
    const std::array n{entity_.number(210), entity_.number(220), entity_.number(230, 1)};
    const double size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), ratio = entity_.number(40, 1);
    const double from = entity_.number(41);
    double sweep = std::fmod(entity_.number(42, kTurn) - from, kTurn);
    if (sweep <= 1e-9) sweep += kTurn;
    if (!(size > 0)) return false;
    const Point minor{(n[1] * major[2] - n[2] * major[1]) * ratio / size,
                      (n[2] * major[0] - n[0] * major[2]) * ratio / size};
    floor_plan::add_arc({{major[0], major[1]}, minor, point(10)}, from, sweep, from_, into_.arcs, into_.curves);
    return true;
  }

  bool add_light_polyline() {
    std::vector<Vertex> vertices;
    const double width = entity_.number(43);
    double widest = width, narrowest = width;  // widths of the current segment
    for (const Group& group : entity_.groups) {
      if (group.code == 10) {
        vertices.push_back({{number(group), 0}, 0, width});
        widest = narrowest = width;
      }
      if (vertices.empty()) continue;
      Vertex& last = vertices.back();
      if (group.code == 20) last.at.y = number(group);
      if (group.code == 42) last.bulge = number(group);
      if (group.code == 40) widest = number(group);
      if (group.code == 41) narrowest = number(group);
      last.width = std::min(widest, narrowest);
    }
    return add_vertices(vertices, (entity_.integer(70) & 1) != 0, object_system(entity_.number(38)));
  }

  bool add_polyline() {
    enum { closed = 1, in_space = 8, polygon_mesh = 16, faces = 64 };
    constexpr int kFrame = 16;  // a vertex that only guides the curve
    const int flags = entity_.integer(70);
    if ((flags & polygon_mesh) != 0) return false;
    if ((flags & faces) != 0) return add_faces();
    std::vector<Vertex> vertices;
    for (const Entity& part : parts_) {
      if (part.type != "VERTEX" || (part.integer(70) & kFrame) != 0) continue;
      const double width = std::min(part.number(40, entity_.number(40)), part.number(41, entity_.number(41)));
      const bool flat = (flags & in_space) == 0;
      vertices.push_back({{part.number(10), part.number(20)}, flat ? part.number(42) : 0, flat ? width : 0});
    }
    return add_vertices(vertices, (flags & closed) != 0,
                        (flags & in_space) != 0 ? Placement{} : object_system(entity_.number(30)));
  }
  // Reads vertices first, then faces as vertex numbers; a negative number begins an edge that does not show.
  bool add_faces() {
    constexpr int kVertex = 64;
    std::vector<Point> corners;
    for (const Entity& part : parts_) {
      if (part.type != "VERTEX") continue;
      if ((part.integer(70) & kVertex) != 0) {
        corners.push_back({part.number(10), part.number(20)});
        continue;
      }
      std::vector<Point> ring;
      for (const int code : {71, 72, 73, 74}) {
        const auto corner = static_cast<std::size_t>(std::abs(static_cast<long>(part.integer(code))));
        if (corner > 0 && corner <= corners.size()) ring.push_back(corners[corner - 1]);
      }
      if (ring.size() >= 3) into_.areas.push_back({{std::move(ring)}, from_});
    }
    return true;
  }

  bool add_vertices(const std::vector<Vertex>& vertices, bool closed, const Placement& system) {
    const std::size_t edges = vertices.size() < 2 ? 0 : vertices.size() - (closed ? 0 : 1);
    for (std::size_t i = 0; i < edges; ++i) {
      const Vertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
      if (std::abs(a.bulge) <= kStraightBulge || !(distance(a.at, b.at) > 0)) {
        add_line(system(a.at), system(b.at), a.width);
        continue;
      }
      const Placement circle = system * bulge_circle(a.at, b.at, a.bulge);
      const double sweep = 4 * std::atan(a.bulge);
      if (!(a.width > 0)) {
        floor_plan::add_arc(circle, 0, sweep, from_, into_.arcs, into_.curves);
        continue;
      }
      const auto points = ellipse_points(circle, 0, sweep);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) add_line(points[k], points[k + 1], a.width);
    }
    return true;
  }

  bool add_multiline() {
    constexpr int kClosed = 2;
    std::vector<MultilineVertex> vertices;
    for (const Group& group : entity_.groups) {
      if (group.code == 11) vertices.push_back({{number(group), 0}, {}, {}});
      if (vertices.empty()) continue;
      MultilineVertex& last = vertices.back();
      if (group.code == 21) last.at.y = number(group);
      if (group.code == 13) last.mitre.x = number(group);
      if (group.code == 23) last.mitre.y = number(group);
      if (group.code == 74) last.elements.emplace_back();
      if (group.code == 41 && !last.elements.empty()) last.elements.back().push_back(number(group));
    }
    const bool closed = (entity_.integer(71) & kClosed) != 0;
    const std::size_t edges = vertices.size() < 2 ? 0 : vertices.size() - (closed ? 0 : 1);
    for (std::size_t k = 0; k < edges; ++k) {
      const MultilineVertex &a = vertices[k], &b = vertices[(k + 1) % vertices.size()];
      for (std::size_t e = 0; e < std::min(a.elements.size(), b.elements.size()); ++e) {
        const std::vector<double>&dashes = a.elements[e], &next = b.elements[e];
        if (dashes.empty() || next.empty()) continue;
        const Point from = a.at + a.mitre * dashes[0], to = b.at + b.mitre * next[0];
        const double size = distance(from, to);
        if (!(size > 0)) continue;
        const auto at = [&](double along) { return from + (to - from) * std::clamp(along / size, 0.0, 1.0); };
        if (dashes.size() < 3) add_line(from, to);
        // Dashes begin and end by turns; the last one goes on to the next vertex.
        for (std::size_t d = 1; dashes.size() >= 3 && d < dashes.size(); d += 2)
          add_line(at(dashes[d]), d + 1 < dashes.size() ? at(dashes[d + 1]) : to);
      }
    }
    return true;
  }

  bool add_spline() {
    constexpr int kClosed = 1;
    Spline spline;
    spline.degree = entity_.integer(71, 3);
    const auto add_y = [](std::vector<Point>& points, double y) {
      if (!points.empty()) points.back().y = y;
    };
    for (const Group& group : entity_.groups) {
      if (group.code == 40) spline.knots.push_back(number(group));
      if (group.code == 41) spline.weights.push_back(number(group));
      if (group.code == 10) spline.control.push_back({number(group), 0});
      if (group.code == 20) add_y(spline.control, number(group));
      if (group.code == 11) spline.fit.push_back({number(group), 0});
      if (group.code == 21) add_y(spline.fit, number(group));
    }
    if (spline.control.empty() && (entity_.integer(70) & kClosed) != 0) return false;
    auto points = spline_points(spline);
    if (points.empty()) return false;
    into_.curves.push_back({std::move(points), from_});
    return true;
  }

  // A missing corner repeats the one before it.
  bool add_quad(const Placement& system, const std::array<int, 4>& codes) {
    std::vector<Point> ring;
    for (const int code : codes)
      if (entity_.has(code)) ring.push_back(system(point(code)));
    into_.areas.push_back({{std::move(ring)}, from_});
    return true;
  }

  bool add_hatch() {
    Area area{hatch_rings(entity_), from_};
    const Placement system = object_system(entity_.number(30));
    for (auto& ring : area.rings)
      for (Point& p : ring) p = system(p);
    if (area.rings.empty()) return false;
    into_.areas.push_back(std::move(area));
    return true;
  }

  bool add_insert() {
    const double angle = entity_.number(50) * kDegree;
    const Point along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    const Placement system = object_system(entity_.number(30));
    const Placement turned{system.x * along.x + system.y * along.y, system.x * across.x + system.y * across.y, {}};
    Insert insert{.block = layers_.block_key(entity_.text(2)),
                  .placement = {turned.x * entity_.number(41, 1), turned.y * entity_.number(42, 1), system(point(10))},
                  .columns = std::max(entity_.integer(70, 1), 1),
                  .rows = std::max(entity_.integer(71, 1), 1),
                  .column_step = turned.x * entity_.number(44),
                  .row_step = turned.y * entity_.number(45),
                  .layer = from_.layer};
    into_.inserts.push_back(std::move(insert));
    for (const Entity& part : parts_)
      if (part.type == "ATTRIB") Adder(part, {}, layers_, into_).add_attribute();
    return true;
  }
  void add_attribute() {
    constexpr int kInvisible = 1;
    const bool invisible = (entity_.integer(70) & kInvisible) != 0 || entity_.integer(60) != 0;
    if (!invisible) add_text(74);
  }

  bool add_text(int vertical_code) {
    const std::string text = plain_text(std::string(entity_.text(1)), layers_.code_page);
    const double height = entity_.number(40), wide = 0.7 * height * static_cast<double>(text.size());
    const int horizontal = entity_.integer(72), vertical = entity_.integer(vertical_code);
    const bool aligned = (horizontal != 0 || vertical != 0) && entity_.has(11);
    const double across = horizontal == 2 ? -0.5 : horizontal == 0 ? 0.5 : 0.0;
    const double upward = vertical == 3 ? -0.5 : vertical == 2 ? 0.0 : 0.5;
    place_text(object_system(entity_.number(30)), point(aligned ? 11 : 10), {across * wide, upward * height},
               entity_.number(50) * kDegree, height, text);
    return true;
  }
  bool add_paragraph() {
    std::string raw;
    for (const Group& group : entity_.groups)
      if (group.code == 3 || group.code == 1) raw += group.value;
    const std::string text = plain_text(raw, layers_.code_page);
    // The attachment point counts from 1, the top left corner, by rows of three.
    const int attachment = std::clamp(entity_.integer(71, 1), 1, 9) - 1;
    const double height = entity_.number(40), given = entity_.number(41);
    const double all = 0.7 * height * static_cast<double>(text.size()), wide = given > 0 ? std::min(given, all) : all;
    // Position and direction are in world coordinates.
    const Placement system = object_system(0);
    const double turn = entity_.number(50) * kDegree, upward = system.mirrors() ? -1 : 1;
    const Point along = entity_.has(11) ? point(11) : system.x * std::cos(turn) + system.y * std::sin(turn);
    place_text({}, point(10), {0.5 * (1 - attachment % 3) * wide, upward * (attachment / 3 - 1) * height},
               std::atan2(along.y, along.x), height, text);
    return true;
  }
  void place_text(const Placement& system, Point at, Point to_middle, double angle, double height,
                  const std::string& text) {
    if (text.empty()) return;
    const Point along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    into_.texts.push_back({system(at + along * to_middle.x + across * to_middle.y), system(at), height, text, from_});
  }

  const Entity& entity_;
  const std::vector<Entity>& parts_;
  Layers& layers_;
  Content& into_;
  Origin from_;
};

}  // namespace

int Layers::index(std::string_view raw) {
  if (const auto known = by_raw_.find(raw); known != by_raw_.end()) return known->second;
  const std::string name = plain_name(std::string(raw), code_page);
  const auto [found, is_new] = by_name_.try_emplace(lower_case(name), static_cast<int>(drawing_.layers.size()));
  if (is_new) {
    drawing_.layers.push_back(name);
    drawing_.plotted.push_back(true);
  }
  by_raw_.emplace(raw, found->second);
  return found->second;
}

void Layers::set(int layer, State state, bool plotted) {
  states_.resize(std::max(states_.size(), layer_of(layer) + 1), shown);
  states_[layer_of(layer)] = state;
  drawing_.plotted[layer_of(layer)] = plotted;
}

std::string Layers::block_key(std::string_view name) const {
  return lower_case(plain_name(std::string(name), code_page));
}

void add_entity(const Entity& entity, const std::vector<Entity>& parts, Layers& layers, Content& into) {
  Adder(entity, parts, layers, into).add();
}

}  // namespace vantage::floor_plan
