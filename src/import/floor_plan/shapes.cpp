// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/shapes.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

namespace vantage::floor_plan {
namespace {

// GEOS catches its own exceptions and passes their texts here.
std::string& last_error() {
  static std::string text;
  return text;
}

GEOSContextHandle_t context() {
  static const GEOSContextHandle_t handle = [] {
    GEOSContextHandle_t made = GEOS_init_r();
    GEOSContext_setErrorMessageHandler_r(
        made, [](const char* text, void*) { last_error() = text; }, nullptr);
    return made;
  }();
  return handle;
}

[[noreturn]] void fail() {
  if (last_error().find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  throw std::runtime_error("its areas cannot be worked out (" + last_error() + "); export the drawing again");
}

Shape check(GEOSGeometry* shape) {
  if (!shape) fail();
  return Shape(shape);
}

void check(int status) {
  if (status == 0) fail();
}

GEOSGeometry* ring_of(std::span<const Point> points, bool close) {
  std::vector<double> xy;
  for (const Point& p : points) xy.push_back(p.x), xy.push_back(p.y);
  if (close) xy.push_back(points.front().x), xy.push_back(points.front().y);
  GEOSCoordSequence* sequence =
      GEOSCoordSeq_copyFromBuffer_r(context(), xy.data(), static_cast<unsigned>(xy.size() / 2), 0, 0);
  if (!sequence) fail();
  return close ? GEOSGeom_createLinearRing_r(context(), sequence) : GEOSGeom_createLineString_r(context(), sequence);
}

Shape collected(int type, std::vector<Shape> shapes) {
  std::vector<GEOSGeometry*> raw;
  for (Shape& shape : shapes) raw.push_back(shape.release());
  return check(GEOSGeom_createCollection_r(context(), type, raw.data(), static_cast<unsigned>(raw.size())));
}

// Calls `visit` for each geometry of a collection, nested ones too.
template <class Visit>
void for_parts(const GEOSGeometry* shape, const Visit& visit) {
  const int count = GEOSGetNumGeometries_r(context(), shape);
  if (GEOSGeomTypeId_r(context(), shape) < GEOS_MULTIPOINT) {
    visit(shape);
    return;
  }
  for (int i = 0; i < count; ++i) for_parts(GEOSGetGeometryN_r(context(), shape, i), visit);
}

std::vector<Point> points_of(const GEOSGeometry* line) {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context(), line);
  unsigned size = 0;
  if (!sequence || GEOSCoordSeq_getSize_r(context(), sequence, &size) == 0) fail();
  std::vector<Point> points(size);
  for (unsigned i = 0; i < size; ++i)
    if (GEOSCoordSeq_getXY_r(context(), sequence, i, &points[i].x, &points[i].y) == 0) fail();
  return points;
}

double signed_area(std::span<const Point> ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    twice += cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
  return twice / 2;
}

Shape multipoint(std::span<const Point> points) {
  std::vector<Shape> shapes;
  for (const Point& p : points) shapes.push_back(check(GEOSGeom_createPointFromXY_r(context(), p.x, p.y)));
  return collected(GEOS_MULTIPOINT, std::move(shapes));
}

constexpr double kMitre = 2;
Shape buffered(const Shape& shape, double by, int cap, double mitre = kMitre) {
  GEOSBufferParams* given = GEOSBufferParams_create_r(context());
  constexpr int kQuarter = 4;
  GEOSBufferParams_setEndCapStyle_r(context(), given, cap);
  GEOSBufferParams_setJoinStyle_r(context(), given, GEOSBUF_JOIN_MITRE);
  GEOSBufferParams_setMitreLimit_r(context(), given, mitre);
  GEOSBufferParams_setQuadrantSegments_r(context(), given, kQuarter);
  GEOSGeometry* out = GEOSBufferWithParams_r(context(), shape.get(), given, by);
  GEOSBufferParams_destroy_r(context(), given);
  return areas(check(out));
}

}  // namespace

void DestroyShape::operator()(GEOSGeometry* shape) const { GEOSGeom_destroy_r(context(), shape); }

Shape areas(Shape shape) {
  const int type = GEOSGeomTypeId_r(context(), shape.get());
  if (type == GEOS_POLYGON || type == GEOS_MULTIPOLYGON) return shape;
  std::vector<Shape> parts;
  for_parts(shape.get(), [&](const GEOSGeometry* part) {
    if (GEOSGeomTypeId_r(context(), part) == GEOS_POLYGON) parts.push_back(check(GEOSGeom_clone_r(context(), part)));
  });
  return collected(GEOS_MULTIPOLYGON, std::move(parts));
}

Shape no_area() { return check(GEOSGeom_createEmptyPolygon_r(context())); }

Shape polygon(std::span<const Point> ring) {
  if (ring.size() < 3) return no_area();
  GEOSGeometry* shell = ring_of(ring, true);
  if (!shell) fail();
  const Shape raw = check(GEOSGeom_createPolygon_r(context(), shell, nullptr, 0));
  return areas(check(GEOSMakeValid_r(context(), raw.get())));
}

Shape disc(Point centre, double radius) {
  constexpr int kCorners = 16;
  std::vector<Point> ring;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    ring.push_back(centre + Point{std::cos(angle), std::sin(angle)} * radius);
  }
  return polygon(ring);
}

Shape lines(std::span<const Line> lines) {
  std::vector<Shape> shapes;
  for (const Line& line : lines) {
    const std::array ends{line.a, line.b};
    shapes.push_back(check(ring_of(ends, false)));
  }
  // Shuffles them, since the tree of points in GEOS degenerates to a list for sorted ones.
  std::ranges::shuffle(shapes, std::mt19937());
  return collected(GEOS_MULTILINESTRING, std::move(shapes));
}

Shape united(std::vector<Shape> shapes) {
  const Shape all = collected(GEOS_GEOMETRYCOLLECTION, std::move(shapes));
  return check(GEOSUnaryUnionPrec_r(context(), all.get(), kGrid));
}

Shape united(const Shape& a, const Shape& b) {
  return areas(check(GEOSUnionPrec_r(context(), a.get(), b.get(), kGrid)));
}
Shape common(const Shape& a, const Shape& b) {
  return areas(check(GEOSIntersectionPrec_r(context(), a.get(), b.get(), kGrid)));
}
Shape without(const Shape& a, const Shape& b) {
  return check(GEOSDifferencePrec_r(context(), a.get(), b.get(), kGrid));
}
Shape odd(std::span<const Shape> shapes) {
  if (shapes.empty()) return no_area();
  if (shapes.size() == 1) return clone(shapes[0]);
  const std::size_t half = shapes.size() / 2;
  return areas(
      check(GEOSSymDifferencePrec_r(context(), odd(shapes.first(half)).get(), odd(shapes.subspan(half)).get(), kGrid)));
}
Shape grown(const Shape& shape, double by) { return buffered(shape, by, GEOSBUF_CAP_SQUARE); }
Shape closed(const Shape& shape, double gap) {
  constexpr double kSharpest = 10;  // keeps corners of rooms from being filled
  const Shape wider = buffered(shape, gap / 2, GEOSBUF_CAP_SQUARE, kSharpest);
  return buffered(wider, -gap / 2, GEOSBUF_CAP_SQUARE, kSharpest);
}
Shape straightened(const Shape& shape, double error) {
  return areas(check(GEOSTopologyPreserveSimplify_r(context(), shape.get(), error)));
}
Shape chained(const Shape& lines) { return check(GEOSLineMerge_r(context(), lines.get())); }
// Widens line by line, since GEOS widens many overlapping ones in quadratic time.
Shape strip(const Shape& lines, double half_width) {
  std::vector<Shape> parts;
  for_parts(lines.get(), [&](const GEOSGeometry* line) {
    parts.push_back(buffered(check(GEOSGeom_clone_r(context(), line)), half_width, GEOSBUF_CAP_FLAT));
  });
  return straightened(areas(united(std::move(parts))));
}
Shape around(std::span<const Point> points) {
  return check(GEOSMinimumRotatedRectangle_r(context(), multipoint(points).get()));
}
Shape hull(std::span<const Point> points) {
  return areas(check(GEOSConvexHull_r(context(), multipoint(points).get())));
}
Shape clone(const Shape& shape) { return check(GEOSGeom_clone_r(context(), shape.get())); }

std::vector<Shape> faces(const Shape& cut_lines) {
  const GEOSGeometry* raw = cut_lines.get();
  return polygons(check(GEOSPolygonize_r(context(), &raw, 1)));
}

std::vector<Shape> polygons(const Shape& shape) {
  std::vector<Shape> out;
  for_parts(shape.get(), [&](const GEOSGeometry* part) {
    if (GEOSGeomTypeId_r(context(), part) == GEOS_POLYGON && GEOSisEmpty_r(context(), part) == 0)
      out.push_back(check(GEOSGeom_clone_r(context(), part)));
  });
  return out;
}

std::vector<Line> pieces(const Shape& shape) {
  std::vector<Line> out;
  for_parts(shape.get(), [&](const GEOSGeometry* part) {
    const int type = GEOSGeomTypeId_r(context(), part);
    if (type != GEOS_LINESTRING && type != GEOS_LINEARRING) return;
    const auto points = points_of(part);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) out.push_back({points[i], points[i + 1], {}});
  });
  return out;
}

std::vector<std::vector<Point>> rings(const Shape& shape) {
  std::vector<std::vector<Point>> out;
  const auto add = [&](const GEOSGeometry* ring, bool outer) {
    auto points = points_of(ring);
    if (points.size() < 4) return;
    points.pop_back();
    if ((signed_area(points) > 0) != outer) std::ranges::reverse(points);
    out.push_back(std::move(points));
  };
  for_parts(shape.get(), [&](const GEOSGeometry* part) {
    if (GEOSGeomTypeId_r(context(), part) != GEOS_POLYGON || GEOSisEmpty_r(context(), part) != 0) return;
    add(GEOSGetExteriorRing_r(context(), part), true);
    for (int i = 0; i < GEOSGetNumInteriorRings_r(context(), part); ++i)
      add(GEOSGetInteriorRingN_r(context(), part, i), false);
  });
  return out;
}

std::vector<Point> outer_ring(const Shape& polygon) {
  auto all = rings(polygon);
  return all.empty() ? std::vector<Point>() : std::move(all.front());
}

Shape filled(const Shape& shape) { return polygon(outer_ring(shape)); }

namespace {

// GEOS clips ears, and finds none in some areas with holes that nearly touch. Halves of these are easier.
void add_triangles(const Shape& polygon_in, int halvings, std::vector<std::array<Point, 3>>& out) {
  constexpr int kMostHalvings = 16;
  if (const Shape cut{GEOSConstrainedDelaunayTriangulation_r(context(), polygon_in.get())}) {
    for (const Shape& triangle : polygons(cut))
      if (const auto ring = outer_ring(triangle); ring.size() == 3) out.push_back({ring[0], ring[1], ring[2]});
    return;
  }
  if (halvings == kMostHalvings || last_error().find("bad_alloc") != std::string::npos) fail();
  const auto [low, high] = bounds(polygon_in);
  const bool wide = high.x - low.x > high.y - low.y;
  // Cuts beside the middle, since drawings are symmetric about it.
  constexpr double kPart = 0.47;
  const Point cut =
      wide ? Point{low.x + kPart * (high.x - low.x), high.y} : Point{high.x, low.y + kPart * (high.y - low.y)};
  const Point from = wide ? Point{cut.x, low.y} : Point{low.x, cut.y};
  for (const auto& [a, b] : {std::pair(low, cut), std::pair(from, high)}) {
    const Point corners[]{a, {b.x, a.y}, b, {a.x, b.y}};
    for (const Shape& half : polygons(common(polygon_in, polygon(corners)))) add_triangles(half, halvings + 1, out);
  }
}

}  // namespace

std::vector<std::array<Point, 3>> triangles(const Shape& shape) {
  std::vector<std::array<Point, 3>> out;
  for (const Shape& part : polygons(shape)) add_triangles(part, 0, out);
  return out;
}

double area(const Shape& shape) {
  double value = 0;
  check(GEOSArea_r(context(), shape.get(), &value));
  return value;
}
double perimeter(const Shape& shape) {
  double value = 0;
  check(GEOSLength_r(context(), shape.get(), &value));
  return value;
}
bool is_empty(const Shape& shape) { return GEOSisEmpty_r(context(), shape.get()) != 0; }
double gap(const Shape& a, const Shape& b) {
  double value = 0;
  check(GEOSDistance_r(context(), a.get(), b.get(), &value));
  return value;
}
Bounds bounds(const Shape& shape) {
  Bounds out;
  if (is_empty(shape)) return out;
  const bool sound = GEOSGeom_getXMin_r(context(), shape.get(), &out.low.x) != 0 &&
                     GEOSGeom_getYMin_r(context(), shape.get(), &out.low.y) != 0 &&
                     GEOSGeom_getXMax_r(context(), shape.get(), &out.high.x) != 0 &&
                     GEOSGeom_getYMax_r(context(), shape.get(), &out.high.y) != 0;
  if (!sound) fail();
  return out;
}

Region::Region(Shape shape) : shape_(std::move(shape)), prepared_(GEOSPrepare_r(context(), shape_.get())) {}

void Region::Destroy::operator()(const GEOSPreparedGeometry* prepared) const {
  GEOSPreparedGeom_destroy_r(context(), prepared);
}

bool Region::holds(Point p) const {
  const Shape point = check(GEOSGeom_createPointFromXY_r(context(), p.x, p.y));
  return GEOSPreparedIntersects_r(context(), prepared_.get(), point.get()) == 1;
}

bool Region::meets(Point a, Point b) const {
  const std::array ends{a, b};
  const Shape line = check(ring_of(ends, false));
  return GEOSPreparedIntersects_r(context(), prepared_.get(), line.get()) == 1;
}

}  // namespace vantage::floor_plan
