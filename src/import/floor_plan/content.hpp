// SPDX-License-Identifier: Apache-2.0
// Entities of a DXF in the coordinates of their block, before blocks are placed.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/dxf.hpp"

namespace vantage::floor_plan {

// Transform from source to target, seen from above: x and y are the images of the source's axes.
struct Placement {
  Point x{1, 0}, y{0, 1}, origin;

  Point operator()(Point p) const { return origin + x * p.x + y * p.y; }
  Placement operator*(const Placement& inner) const {
    const auto turned = [&](Point p) { return x * p.x + y * p.y; };
    return {turned(inner.x), turned(inner.y), (*this)(inner.origin)};
  }
  // Returns true if circles stay circles.
  bool keeps_shape() const {
    const double scale = length(x);
    return scale > 0 && std::abs(dot(x, y)) <= 1e-6 * scale * scale && std::abs(length(y) - scale) <= 1e-6 * scale;
  }
  bool mirrors() const { return cross(x, y) < 0; }
};

struct Insert {
  std::string block;    // as Layers::block_key writes it
  Placement placement;  // without the block's base
  int columns = 1, rows = 1;
  Point column_step, row_step;
  int layer = 0;
};

// Content of a block or of the model space. Origins have neither kind nor symbol yet.
struct Content {
  Point base;
  std::string name;
  bool external = false;  // a reference to another file
  std::vector<Line> lines;
  std::vector<Arc> arcs;
  std::vector<Curve> curves;
  std::vector<Area> areas;
  std::vector<Text> texts;
  std::vector<Insert> inserts;
  std::map<std::tuple<Fate, int, std::string>, std::size_t> entities;  // by fate, layer and type
};

// Names of layers and blocks, which ignore case.
class Layers {
 public:
  enum State { shown, off, frozen };  // blocks on a layer that is off may show, but not on a frozen one

  explicit Layers(Drawing& drawing) : drawing_(drawing) {}
  int index(std::string_view raw);  // in Drawing::layers
  void set(int layer, State state, bool plotted);
  std::string block_key(std::string_view name) const;
  State state(int layer) const { return layer < static_cast<int>(states_.size()) ? states_[layer_of(layer)] : shown; }

  std::string code_page;

 private:
  static std::size_t layer_of(int layer) { return static_cast<std::size_t>(layer); }
  Drawing& drawing_;
  std::map<std::string, int, std::less<>> by_raw_;
  std::map<std::string, int> by_name_;
  std::vector<State> states_;
};

// Adds an entity to a content. `parts`: the vertices and attributes that follow it.
void add_entity(const Entity& entity, const std::vector<Entity>& parts, Layers& layers, Content& into);

// Adds a placed arc of the unit circle: as an arc, or as a curve if it is elliptical.
void add_arc(const Placement& placement, double from, double sweep, const Origin& origin, std::vector<Arc>& arcs,
             std::vector<Curve>& curves);

// Returns the placement of the unit circle that puts it on the arc of an edge from a to b, its x axis towards a.
// `bulge`: the tangent of a quarter of the arc's angle; REQUIRES: its size is above kStraightBulge.
inline constexpr double kStraightBulge = 1e-6;
Placement bulge_circle(Point a, Point b, double bulge);

// Returns the area of a HATCH in its own coordinates: rings, of which those within others are holes. Seed points and
// rings around texts do not count.
std::vector<std::vector<Point>> hatch_rings(const Entity& hatch);

// Returns chains of points within 1/20 000 of their extent of the curves.
std::vector<Point> ellipse_points(const Placement& unit_circle, double from, double sweep);
// Control points with their weights, or points that the curve passes through if there are no control points. Empty if
// the spline is not valid.
struct Spline {
  int degree = 3;
  std::vector<double> knots, weights;
  std::vector<Point> control, fit;
};
std::vector<Point> spline_points(const Spline& spline);

}  // namespace vantage::floor_plan
