// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/x3d_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "import/mesh/polygon.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

using std::numbers::pi;
using Corners = std::vector<std::uint32_t>;

constexpr double kChordError_m = 0.005;

const std::string* attribute_of(const XmlElement& element, const char* name) {
  const auto found = element.attributes.find(name);
  return found == element.attributes.end() ? nullptr : &found->second;
}

std::string label(const XmlElement& element, const char* name) {
  return "the " + std::string(name) + " of a node " + element.name;
}

std::vector<std::int64_t> whole_numbers(const XmlElement& element, const char* name) {
  const std::string* text = attribute_of(element, name);
  return text ? values_of<std::int64_t>(*text, label(element, name)) : std::vector<std::int64_t>();
}

class Surface {
 public:
  Surface(const XmlElement& geometry, const X3dResolver& resolve, const X3dUnits& units)
      : node_(geometry), resolve_(resolve), units_(units) {}

  Part run() {
    const std::string& name = node_.name;
    read_points();
    read_colours();
    if (name == "IndexedFaceSet") indexed_faces();
    if (name == "TriangleSet") runs_of(3, &Surface::polygon);
    if (name == "QuadSet") runs_of(4, &Surface::polygon);
    if (name == "IndexedTriangleSet") indexed_runs(3);
    if (name == "IndexedQuadSet") indexed_runs(4);
    if (name == "TriangleStripSet") counted("stripCount", &Surface::strip);
    if (name == "TriangleFanSet") counted("fanCount", &Surface::fan);
    if (name == "IndexedTriangleStripSet") separated("index", &Surface::strip);
    if (name == "IndexedTriangleFanSet") separated("index", &Surface::fan);
    if (name == "Box") box();
    if (name == "Sphere") sphere();
    if (name == "Cylinder") cylinder();
    if (name == "Cone") cone();
    if (name == "ElevationGrid") elevation_grid();
    if (name == "Extrusion") extrusion();
    if (name == "Rectangle2D") rectangle();
    if (name == "Disk2D") disk();
    if (name == "TriangleSet2D") triangles_2d();
    if (!x3d_truth(node_, "ccw", true))
      for (std::size_t i = 0; i + 2 < part_.indices.size(); i += 3)
        std::swap(part_.indices[i + 1], part_.indices[i + 2]);
    return std::move(part_);
  }

 private:
  using Make = void (Surface::*)(const Corners&);

  const XmlElement* part_node(std::initializer_list<std::string_view> names) const {
    for (const XmlElement& child : node_.children)
      if (std::ranges::find(names, child.name) != names.end()) return &resolve_(child);
    return nullptr;
  }

  void read_points() {
    const XmlElement* coordinate = part_node({"Coordinate", "CoordinateDouble"});
    if (!coordinate) return;
    const std::vector<double> values = x3d_numbers(*coordinate, "point", {});
    for (std::size_t k = 0; k + 2 < values.size(); k += 3)
      points_.emplace_back(values[k], values[k + 1], values[k + 2]);
  }

  void read_colours() {
    const XmlElement* colour = part_node({"Color", "ColorRGBA"});
    if (!colour) return;
    const std::size_t channels = colour->name == "Color" ? 3 : 4;
    const std::vector<double> values = x3d_numbers(*colour, "color", {});
    for (std::size_t k = 0; k + channels <= values.size(); k += channels) {
      Rgba rgba{0, 0, 0, 255};
      for (std::size_t c = 0; c < channels; ++c)
        rgba[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(values[k + c], 0.0, 1.0)));
      colours_.push_back(rgba);
    }
  }

  std::uint32_t point_number(std::int64_t index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= points_.size())
      throw Refused("a node " + node_.name + " names point " + std::to_string(index) + "; there are " +
                    std::to_string(points_.size()));
    return static_cast<std::uint32_t>(index);
  }

  std::uint32_t add_corner(const glm::dvec3& p, std::optional<Rgba> colour = {}) {
    part_.positions.push_back(p);
    if (!colours_.empty()) part_.colours.push_back(colour.value_or(Rgba{255, 255, 255, 255}));
    return static_cast<std::uint32_t>(part_.positions.size() - 1);
  }
  // Adds a point of the file, with its own colour if it has one.
  std::uint32_t add_point(std::uint32_t point) {
    return add_corner(points_[point], point < colours_.size() ? std::optional(colours_[point]) : std::nullopt);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    part_.indices.insert(part_.indices.end(), {a, b, c});
  }
  // Adds a triangle and its three corners.
  void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const std::uint32_t first = add_corner(a);
    add_corner(b), add_corner(c);
    triangle(first, first + 1, first + 2);
  }
  void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    triangle(a, b, c), triangle(a, c, d);
  }
  // Adds a flat face and its corners; `turned` reverses its winding.
  void face(std::vector<glm::dvec3> corners, bool turned = false) {
    if (turned) std::ranges::reverse(corners);
    Corners cut;
    const std::size_t size = corners.size();
    cut_into_triangles(corners, {&size, 1}, cut);
    const auto first = static_cast<std::uint32_t>(part_.positions.size());
    for (const glm::dvec3& p : corners) add_corner(p);
    for (const std::uint32_t c : cut) part_.indices.push_back(first + c);
  }

  // Three ways to make triangles of corners that are in the part.
  void polygon(const Corners& corners) {
    std::vector<glm::dvec3> points;
    for (const std::uint32_t c : corners) points.push_back(part_.positions[c]);
    Corners cut;
    const std::size_t size = points.size();
    cut_into_triangles(points, {&size, 1}, cut);
    for (const std::uint32_t c : cut) part_.indices.push_back(corners[c]);
  }
  void strip(const Corners& c) {
    for (std::size_t k = 0; k + 2 < c.size(); ++k)
      k % 2 == 0 ? triangle(c[k], c[k + 1], c[k + 2]) : triangle(c[k + 1], c[k], c[k + 2]);
  }
  void fan(const Corners& c) {
    for (std::size_t k = 1; k + 1 < c.size(); ++k) triangle(c[0], c[k], c[k + 1]);
  }

  void indexed_faces() {
    const bool by_vertex = x3d_truth(node_, "colorPerVertex", true);
    const std::vector<std::int64_t> indices = whole_numbers(node_, "coordIndex"),
                                    colours = whole_numbers(node_, "colorIndex");
    const auto colour = [&](std::size_t place, std::int64_t otherwise) -> std::optional<Rgba> {
      const std::int64_t k = colours.empty() ? otherwise : place < colours.size() ? colours[place] : -1;
      return k >= 0 && static_cast<std::size_t>(k) < colours_.size()
                 ? std::optional(colours_[static_cast<std::size_t>(k)])
                 : std::nullopt;
    };
    Corners corners;
    std::size_t faces = 0;
    for (std::size_t k = 0; k <= indices.size(); ++k) {
      if (k < indices.size() && indices[k] >= 0) {
        const std::uint32_t p = point_number(indices[k]);
        corners.push_back(
            add_corner(points_[p], by_vertex ? colour(k, p) : colour(faces, static_cast<std::int64_t>(faces))));
        continue;
      }
      if (!corners.empty()) ++faces;
      polygon(corners);
      corners.clear();
    }
  }

  void runs_of(std::size_t size, Make make) {
    for (std::uint32_t first = 0; first + size <= points_.size(); first += static_cast<std::uint32_t>(size)) {
      Corners corners;
      for (std::uint32_t k = 0; k < size; ++k) corners.push_back(add_point(first + k));
      (this->*make)(corners);
    }
  }
  void indexed_runs(std::size_t size) {
    Corners corners;
    for (const std::int64_t index : whole_numbers(node_, "index")) {
      if (index < 0) continue;
      corners.push_back(add_point(point_number(index)));
      if (corners.size() < size) continue;
      polygon(corners);
      corners.clear();
    }
  }
  void counted(const char* counts, Make make) {
    std::size_t first = 0;
    for (const std::int64_t count : whole_numbers(node_, counts)) {
      if (count < 0 || static_cast<std::size_t>(count) > points_.size() - first)
        throw Refused(label(node_, counts) + " adds up to more than its " + std::to_string(points_.size()) + " points");
      Corners corners;
      for (std::int64_t k = 0; k < count; ++k) corners.push_back(add_point(static_cast<std::uint32_t>(first++)));
      (this->*make)(corners);
    }
  }
  void separated(const char* name, Make make) {
    Corners corners;
    std::vector<std::int64_t> indices = whole_numbers(node_, name);
    indices.push_back(-1);
    for (const std::int64_t index : indices) {
      if (index >= 0) {
        corners.push_back(add_point(point_number(index)));
        continue;
      }
      (this->*make)(corners);
      corners.clear();
    }
  }

  void box() {
    const std::vector<double> size = x3d_numbers(node_, "size", {2, 2, 2});
    if (size.size() < 3) throw Refused(label(node_, "size") + " is not three numbers");
    const glm::dvec3 h = 0.5 * glm::dvec3(size[0], size[1], size[2]);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::vector<glm::dvec3> corners;
        for (const auto& [a, b] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
          glm::dvec3 p;
          p[axis] = side * h[axis], p[u] = a * h[u], p[v] = b * h[v];
          corners.push_back(p);
        }
        face(std::move(corners), side < 0);
      }
  }

  // Returns the number of corners of a circle, by the error of its chords, kChordError_m: from 16 to 256.
  int segments(double radius) const {
    const double share = kChordError_m / (std::abs(radius) * units_.metres);
    const double n = share < 1 ? pi / std::acos(1 - share) : 0;
    return static_cast<int>(std::clamp(std::ceil(n / 4) * 4, 16.0, 256.0));
  }
  // Returns corner k of n on a level circle, counterclockwise seen from above.
  static glm::dvec3 on_circle(double radius, double height, int k, int n) {
    const double angle = 2 * pi * (k % n) / n;
    return {radius * std::sin(angle), height, radius * std::cos(angle)};
  }
  std::vector<glm::dvec3> circle(double radius, double height) const {
    const int n = segments(radius);
    std::vector<glm::dvec3> corners;
    for (int k = 0; k < n; ++k) corners.push_back(on_circle(radius, height, k, n));
    return corners;
  }

  void sphere() {
    const double radius = x3d_number(node_, "radius", 1);
    const int n = segments(radius), rings = n / 2;
    const auto at = [&](int ring, int k) {
      const double angle = pi * ring / rings;
      return on_circle(ring % rings == 0 ? 0 : radius * std::sin(angle), radius * std::cos(angle), k, n);
    };
    for (int ring = 0; ring < rings; ++ring)
      for (int k = 0; k < n; ++k) {
        if (ring > 0) triangle(at(ring, k), at(ring + 1, k), at(ring, k + 1));
        if (ring + 1 < rings) triangle(at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1));
      }
  }
  void cylinder() {
    const double radius = x3d_number(node_, "radius", 1), h = 0.5 * x3d_number(node_, "height", 2);
    const int n = segments(radius);
    if (x3d_truth(node_, "side", true))
      for (int k = 0; k < n; ++k)
        quad(on_circle(radius, -h, k, n), on_circle(radius, -h, k + 1, n), on_circle(radius, h, k + 1, n),
             on_circle(radius, h, k, n));
    if (x3d_truth(node_, "top", true)) face(circle(radius, h));
    if (x3d_truth(node_, "bottom", true)) face(circle(radius, -h), true);
  }
  void cone() {
    const double radius = x3d_number(node_, "bottomRadius", 1), h = 0.5 * x3d_number(node_, "height", 2);
    const int n = segments(radius);
    if (x3d_truth(node_, "side", true))
      for (int k = 0; k < n; ++k) triangle(on_circle(radius, -h, k, n), on_circle(radius, -h, k + 1, n), {0, h, 0});
    if (x3d_truth(node_, "bottom", true)) face(circle(radius, -h), true);
  }

  void elevation_grid() {
    const auto nx = static_cast<std::size_t>(std::max(0.0, x3d_number(node_, "xDimension", 0))),
               nz = static_cast<std::size_t>(std::max(0.0, x3d_number(node_, "zDimension", 0)));
    const double dx = x3d_number(node_, "xSpacing", 1), dz = x3d_number(node_, "zSpacing", 1);
    const std::vector<double> heights = x3d_numbers(node_, "height", {});
    if (nx > heights.size() || nz > heights.size() || nx * nz > heights.size())
      throw Refused("an ElevationGrid has " + std::to_string(heights.size()) +
                    " heights; fewer than its dimensions say");
    const bool by_vertex = x3d_truth(node_, "colorPerVertex", true);
    const auto corner = [&](std::size_t x, std::size_t z, std::size_t square) {
      const std::size_t k = by_vertex ? z * nx + x : square;
      return add_corner({dx * static_cast<double>(x), heights[z * nx + x], dz * static_cast<double>(z)},
                        k < colours_.size() ? std::optional(colours_[k]) : std::nullopt);
    };
    for (std::size_t z = 0; z + 1 < nz; ++z)
      for (std::size_t x = 0; x + 1 < nx; ++x) {
        const std::size_t square = z * (nx - 1) + x;
        const std::uint32_t a = corner(x, z, square), b = corner(x, z + 1, square), c = corner(x + 1, z + 1, square),
                            d = corner(x + 1, z, square);
        triangle(a, b, c), triangle(a, c, d);
      }
  }

  // Adds cross-sections along a spine, each in the plane given by the spine's neighbours (ISO/IEC 19775-1, 13.3.5).
  void extrusion() {
    const auto pairs = [](const std::vector<double>& values) {
      std::vector<glm::dvec2> out;
      for (std::size_t k = 0; k + 1 < values.size(); k += 2) out.emplace_back(values[k], values[k + 1]);
      return out;
    };
    const std::vector<glm::dvec2> section =
                                      pairs(x3d_numbers(node_, "crossSection", {1, 1, 1, -1, -1, -1, -1, 1, 1, 1})),
                                  scales = pairs(x3d_numbers(node_, "scale", {1, 1}));
    const std::vector<double> way = x3d_numbers(node_, "spine", {0, 0, 0, 0, 1, 0}),
                              turns = x3d_numbers(node_, "orientation", {0, 0, 1, 0});
    std::vector<glm::dvec3> spine;
    for (std::size_t k = 0; k + 2 < way.size(); k += 3) spine.emplace_back(way[k], way[k + 1], way[k + 2]);
    if (section.size() < 2 || spine.size() < 2 || scales.empty() || turns.size() < 4) return;
    const std::vector<glm::dmat3> planes = planes_along(spine);
    std::vector<std::vector<glm::dvec3>> rings;
    for (std::size_t k = 0; k < spine.size(); ++k) {
      const glm::dvec2 scale = scales[std::min(k, scales.size() - 1)];
      const std::size_t turn = 4 * std::min(k, turns.size() / 4 - 1);
      const glm::dvec3 axis(turns[turn], turns[turn + 1], turns[turn + 2]);
      const glm::dquat rotation =
          length(axis) > 0 ? glm::angleAxis(turns[turn + 3] * units_.radians, normalize(axis)) : glm::dquat(1, 0, 0, 0);
      std::vector<glm::dvec3>& ring = rings.emplace_back();
      for (const glm::dvec2& c : section)
        ring.push_back(spine[k] + planes[k] * (rotation * glm::dvec3(c.x * scale.x, 0, c.y * scale.y)));
    }
    for (std::size_t k = 0; k + 1 < rings.size(); ++k)
      for (std::size_t c = 0; c + 1 < section.size(); ++c)
        quad(rings[k][c], rings[k][c + 1], rings[k + 1][c + 1], rings[k + 1][c]);
    const bool closed = spine.front() == spine.back();
    // A closed section names its first corner twice.
    const auto cap = [&](std::vector<glm::dvec3> ring, bool turned) {
      if (section.front() == section.back()) ring.pop_back();
      face(std::move(ring), turned);
    };
    if (!closed && x3d_truth(node_, "beginCap", true)) cap(rings.front(), true);
    if (!closed && x3d_truth(node_, "endCap", true)) cap(rings.back(), false);
  }

  static std::vector<glm::dmat3> planes_along(const std::vector<glm::dvec3>& spine) {
    const std::size_t n = spine.size();
    const bool closed = spine.front() == spine.back();
    std::vector<glm::dvec3> ys(n, glm::dvec3(0)), zs(n, glm::dvec3(0));
    for (std::size_t k = 0; k < n; ++k) {
      const bool first = k == 0, last = k + 1 == n;
      const glm::dvec3 before = first ? (closed ? spine[n - 2] : spine[0]) : spine[k - 1],
                       after = last ? (closed ? spine[1] : spine[n - 1]) : spine[k + 1];
      ys[k] = after - before;
      if ((!first && !last) || closed) zs[k] = cross(after - spine[k], before - spine[k]);
    }
    const auto some = [](const glm::dvec3& v) { return length(v) > 1e-12; };
    // A straight part of the spine takes over the plane of its neighbours.
    for (std::size_t k = 1; k < n; ++k) {
      if (!some(ys[k])) ys[k] = ys[k - 1];
      if (!some(zs[k])) zs[k] = zs[k - 1];
    }
    for (std::size_t k = n - 1; k-- > 0;) {
      if (!some(ys[k])) ys[k] = ys[k + 1];
      if (!some(zs[k])) zs[k] = zs[k + 1];
    }
    std::vector<glm::dmat3> planes;
    for (std::size_t k = 0; k < n; ++k) {
      const glm::dvec3 y = some(ys[k]) ? normalize(ys[k]) : glm::dvec3(0, 1, 0);
      if (!some(zs[0])) {  // all of it is straight: turned from the y axis
        const glm::dvec3 axis = cross(glm::dvec3(0, 1, 0), y);
        const glm::dquat turn = some(axis) ? glm::angleAxis(std::acos(std::clamp(y.y, -1.0, 1.0)), normalize(axis))
                                : y.y < 0  ? glm::angleAxis(pi, glm::dvec3(1, 0, 0))
                                           : glm::dquat(1, 0, 0, 0);
        planes.emplace_back(turn * glm::dvec3(1, 0, 0), y, turn * glm::dvec3(0, 0, 1));
        continue;
      }
      if (k > 0 && dot(zs[k], zs[k - 1]) < 0) zs[k] = -zs[k];
      const glm::dvec3 x = normalize(cross(y, zs[k]));
      planes.emplace_back(x, y, cross(x, y));
    }
    return planes;
  }

  void rectangle() {
    const std::vector<double> size = x3d_numbers(node_, "size", {2, 2});
    if (size.size() < 2) throw Refused(label(node_, "size") + " is not two numbers");
    const double x = 0.5 * size[0], y = 0.5 * size[1];
    quad({-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0});
  }
  void disk() {
    const double outer = x3d_number(node_, "outerRadius", 1), inner = x3d_number(node_, "innerRadius", 0);
    const int n = segments(outer);
    const auto at = [&](double radius, int k) {
      const glm::dvec3 p = on_circle(radius, 0, k, n);
      return glm::dvec3(p.z, p.x, 0);
    };
    for (int k = 0; k < n; ++k) {
      triangle(at(inner, k), at(outer, k), at(outer, k + 1));
      if (inner > 0) triangle(at(inner, k), at(outer, k + 1), at(inner, k + 1));
    }
  }
  void triangles_2d() {
    const std::vector<double> v = x3d_numbers(node_, "vertices", {});
    for (std::size_t k = 0; k + 5 < v.size(); k += 6)
      triangle(glm::dvec3(v[k], v[k + 1], 0), {v[k + 2], v[k + 3], 0}, {v[k + 4], v[k + 5], 0});
  }

  const XmlElement& node_;
  const X3dResolver& resolve_;
  const X3dUnits units_;
  Part part_;
  std::vector<glm::dvec3> points_;
  std::vector<Rgba> colours_;
};

}  // namespace

X3dGeometry x3d_kind(std::string_view node) {
  constexpr std::array<std::string_view, 18> kSurfaces{"IndexedFaceSet",
                                                       "TriangleSet",
                                                       "QuadSet",
                                                       "IndexedTriangleSet",
                                                       "IndexedQuadSet",
                                                       "TriangleStripSet",
                                                       "TriangleFanSet",
                                                       "IndexedTriangleStripSet",
                                                       "IndexedTriangleFanSet",
                                                       "Box",
                                                       "Sphere",
                                                       "Cylinder",
                                                       "Cone",
                                                       "ElevationGrid",
                                                       "Extrusion",
                                                       "Rectangle2D",
                                                       "Disk2D",
                                                       "TriangleSet2D"};
  constexpr std::array<std::string_view, 9> kLines{"PointSet", "LineSet",    "IndexedLineSet", "Arc2D", "ArcClose2D",
                                                   "Circle2D", "Polyline2D", "Polypoint2D",    "Text"};
  if (std::ranges::find(kSurfaces, node) != kSurfaces.end()) return X3dGeometry::surface;
  return std::ranges::find(kLines, node) != kLines.end() ? X3dGeometry::lines_or_points : X3dGeometry::unknown;
}

Part x3d_surface(const XmlElement& geometry, const X3dResolver& resolve, const X3dUnits& units) {
  return Surface(geometry, resolve, units).run();
}

std::vector<double> x3d_numbers(const XmlElement& element, const char* name, std::vector<double> missing) {
  const std::string* text = attribute_of(element, name);
  return text ? values_of<double>(*text, label(element, name)) : missing;
}

double x3d_number(const XmlElement& element, const char* name, double missing) {
  const std::vector<double> values = x3d_numbers(element, name, {missing});
  if (values.size() != 1 || !std::isfinite(values[0])) throw Refused(label(element, name) + " is not one number");
  return values[0];
}

bool x3d_truth(const XmlElement& element, const char* name, bool missing) {
  const std::string* text = attribute_of(element, name);
  if (!text) return missing;
  const std::string_view word = trimmed_text(*text);
  return word == "true" || word == "TRUE" || word == "1";
}

}  // namespace vantage::importer
