// SPDX-License-Identifier: Apache-2.0
// Content of a floor plan's drawing, with blocks placed and curves as arcs.
#pragma once

#include <cmath>
#include <compare>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace vantage::floor_plan {

inline constexpr double kTurn = 2 * std::numbers::pi, kDegree = kTurn / 360;
inline constexpr double kCurve_m = 0.005;  // largest distance of chords from curves

struct Point {
  double x = 0, y = 0;
  friend Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
  friend Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
  friend Point operator*(Point a, double by) { return {a.x * by, a.y * by}; }
  friend bool operator==(const Point&, const Point&) = default;
};
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
inline double length(Point a) { return std::hypot(a.x, a.y); }
inline double distance(Point a, Point b) { return length(b - a); }

// Kind of a layer or a block, recognised by its name.
enum class Kind { other, wall, door, window, furniture, stair, annotation };

// Origin of a piece of the drawing.
struct Origin {
  int layer = 0;  // in Drawing::layers
  Kind kind = Kind::other;
  int symbol = -1;  // the innermost placed block, in Drawing::symbols; -1: none
};

struct Line {
  Point a, b;
  Origin from;
  double width = 0;  // of a wide polyline
};

// An arc from `start` around `centre` by `sweep` radians, counter-clockwise if positive.
struct Arc {
  Point centre, start;
  double sweep = 0;
  Origin from;
  double radius() const { return distance(centre, start); }
  Point at(double share) const;
  Point end() const { return at(1); }
};

// A dense chain of points for a curve that is neither straight nor an arc.
struct Curve {
  std::vector<Point> points;
  Origin from;
};

// A filled area: rings of a hatch or a solid; rings within rings are holes.
struct Area {
  std::vector<std::vector<Point>> rings;
  Origin from;
};

struct Text {
  Point at;         // its middle, as far as can be told
  Point insertion;  // and the point that the file gives
  double height = 0;
  std::string text;
  Origin from;
};

// A placed block.
struct Symbol {
  std::string name;
  Kind kind = Kind::other;
  int parent = -1;  // the block that it is in
};

// Outcome of reading an entity.
enum class Fate { drawn, not_read, invisible, hidden_layer, missing_block, paper_space };

// Entities of one type, as DXF names it, that share their fate and layer.
struct EntityKey {
  Fate fate = Fate::drawn;
  int layer = 0;
  Kind kind = Kind::other;
  bool in_symbol = false;
  std::string type;
  friend auto operator<=>(const EntityKey&, const EntityKey&) = default;
};

struct Drawing {
  std::vector<std::string> layers;
  std::vector<bool> plotted;  // by layer
  std::vector<Kind> layer_kinds;
  std::vector<Symbol> symbols;
  std::vector<Line> lines;
  std::vector<Arc> arcs;
  std::vector<Curve> curves;
  std::vector<Area> areas;
  std::vector<Text> texts;
  int unit_code = 0;                          // $INSUNITS
  bool in_inches = false;                     // lengths are shown in feet and inches ($LUNITS)
  std::map<EntityKey, std::size_t> entities;  // all that the file holds, counted as often as placed
  std::map<double, std::size_t> thicknesses;  // heights that entities state, and how many state each
};

// Reads the model space of a DXF; coordinates are the file's. Layers that match `wall_layers` (shell patterns; case is
// ignored), if there are any, are the walls, whatever other names say. Throws Refused.
Drawing read_drawing(const std::filesystem::path& file, const std::vector<std::string>& wall_layers);

// Removes points as long as the chain strays by at most `error`.
std::vector<Point> simplified(const std::vector<Point>& points, double error);

// Returns an arc as a chain of points within `error` of it.
std::vector<Point> chain(const Arc& arc, double error);

}  // namespace vantage::floor_plan
