// SPDX-License-Identifier: Apache-2.0
// Areas of a plan, in metres, and operations of GEOS on them. Each function throws std::bad_alloc, or
// std::runtime_error with GEOS's reason.
#pragma once

#include <geos_c.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

struct DestroyShape {
  void operator()(GEOSGeometry* shape) const;
};
using Shape = std::unique_ptr<GEOSGeometry, DestroyShape>;

// Grid to which coordinates are rounded when shapes are combined, so that near coincidences do no harm.
inline constexpr double kGrid = 1e-4;

Shape no_area();
Shape polygon(std::span<const Point> ring);  // empty for fewer than three points
Shape disc(Point centre, double radius);     // sixteen corners on the circle
Shape lines(std::span<const Line> lines);    // each as a line string
Shape united(std::vector<Shape> shapes);     // lines are cut where they meet
Shape united(const Shape& a, const Shape& b);
Shape common(const Shape& a, const Shape& b);
Shape without(const Shape& a, const Shape& b);
Shape odd(std::span<const Shape> shapes);                      // areas that an odd number of them covers
Shape grown(const Shape& shape, double by);                    // shrunk if negative; corners stay sharp
Shape closed(const Shape& shape, double gap);                  // with gaps of up to this width filled
Shape straightened(const Shape& shape, double error = kGrid);  // without corners on its straight sides
Shape chained(const Shape& lines);                             // joined where two ends meet
Shape strip(const Shape& lines, double half_width);            // ends are cut off flat
Shape around(std::span<const Point> points);                   // the smallest rectangle, in any direction
Shape hull(std::span<const Point> points);
Shape clone(const Shape& shape);
std::vector<Shape> faces(const Shape& cut_lines);  // areas that lines enclose
Shape areas(Shape shape);                          // its polygons alone
std::vector<Shape> polygons(const Shape& shape);
std::vector<Line> pieces(const Shape& lines);  // straight pieces of lines or of boundaries
// Returns the rings of one or several polygons; their inside lies to the left.
std::vector<std::vector<Point>> rings(const Shape& shape);
std::vector<Point> outer_ring(const Shape& polygon);
Shape filled(const Shape& polygon);  // without its holes
std::vector<std::array<Point, 3>> triangles(const Shape& shape);

double area(const Shape& shape);
double perimeter(const Shape& shape);
bool is_empty(const Shape& shape);
double gap(const Shape& a, const Shape& b);  // the distance between them
struct Bounds {
  Point low, high;
};
Bounds bounds(const Shape& shape);

// A shape prepared for fast queries of many points.
class Region {
 public:
  explicit Region(Shape shape);
  bool holds(Point p) const;  // the boundary counts
  bool meets(Point a, Point b) const;
  const Shape& shape() const { return shape_; }

 private:
  struct Destroy {
    void operator()(const GEOSPreparedGeometry* prepared) const;
  };
  Shape shape_;
  std::unique_ptr<const GEOSPreparedGeometry, Destroy> prepared_;
};

}  // namespace vantage::floor_plan
