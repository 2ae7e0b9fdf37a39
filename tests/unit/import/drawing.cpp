// SPDX-License-Identifier: Apache-2.0
#include "drawing.hpp"

#include <cmath>
#include <cstdio>
#include <tuple>

namespace vantage::test {

DrawingText::DrawingText(int unit, double scale, double east, double north)
    : scale_(scale), east_(east), north_(north) {
  header_ = group(9, "$DWGCODEPAGE") + group(3, "ANSI_1252");
  if (unit > 0) header_ += group(9, "$INSUNITS") + group(70, std::to_string(unit));
}

std::string DrawingText::length(int code, double metres) const {
  char text[40];
  std::snprintf(text, sizeof text, "%.6f", metres * scale_);
  return group(code, text);
}

std::string DrawingText::at(int code, double x, double y, double z) const {
  const double east = in_block_ ? 0 : east_, north = in_block_ ? 0 : north_;
  return length(code, x + east) + length(code + 10, y + north) + length(code + 20, z);
}

std::string DrawingText::own(int code, double x, double y) const {
  const double east = in_block_ ? 0 : east_, north = in_block_ ? 0 : north_;
  return length(code, (look_.below ? -1 : 1) * (x + east)) + length(code + 10, y + north);
}

std::string DrawingText::begin(const std::string& type, const std::string& layer, bool object) const {
  std::string out = group(0, type) + group(8, layer);
  if (look_.on_sheet) out += group(67, "1");
  if (look_.invisible) out += group(60, "1");
  if (look_.below && object) out += group(210, "0") + group(220, "0") + group(230, "-1");
  return out;
}

void DrawingText::layer(const std::string& name, int colour, int flags, bool plotted) {
  layers_ += group(0, "LAYER") + group(2, name) + group(70, std::to_string(flags)) + group(62, std::to_string(colour)) +
             group(6, "CONTINUOUS") + group(290, plotted ? "1" : "0");
}

void DrawingText::line(const std::string& layer, double x1, double y1, double x2, double y2) {
  entities_ += begin("LINE", layer, false) + at(10, x1, y1) + at(11, x2, y2);
}

std::string DrawingText::vertices_of(const std::vector<Vertex>& vertices) const {
  std::string out;
  for (const auto& [x, y, bulge] : vertices) {
    out += own(10, x, y);
    if (bulge != 0) out += group(42, std::to_string(look_.below ? -bulge : bulge));
  }
  return out;
}

void DrawingText::polyline(const std::string& layer, const Points& points, bool closed) {
  std::vector<Vertex> vertices;
  for (const auto& [x, y] : points) vertices.push_back({x, y});
  polyline(layer, vertices, closed, 0);
}

void DrawingText::polyline(const std::string& layer, const std::vector<Vertex>& vertices, bool closed, double width) {
  entities_ += begin("LWPOLYLINE", layer, true) + group(90, std::to_string(vertices.size())) +
               group(70, closed ? "1" : "0") + length(43, width) + vertices_of(vertices);
}

void DrawingText::old_polyline(const std::string& layer, const std::vector<Vertex>& vertices, bool closed,
                               bool heights) {
  entities_ += begin("POLYLINE", layer, !heights) + group(66, "1") +
               group(70, std::to_string((closed ? 1 : 0) + (heights ? 8 : 0))) + group(10, "0") + group(20, "0") +
               group(30, "0");
  double z = 0;
  for (const auto& [x, y, bulge] : vertices) {
    entities_ += group(0, "VERTEX") + group(8, layer);
    entities_ += heights ? at(10, x, y, z += 0.1) + group(70, "32") : own(10, x, y) + group(30, "0");
    if (bulge != 0) entities_ += group(42, std::to_string(look_.below ? -bulge : bulge));
  }
  entities_ += group(0, "SEQEND") + group(8, layer);
}

void DrawingText::faces(const std::string& layer, const Points& corners, const std::vector<std::vector<int>>& faces) {
  entities_ += begin("POLYLINE", layer, false) + group(66, "1") + group(70, "64") + group(10, "0") + group(20, "0") +
               group(30, "0") + group(71, std::to_string(corners.size())) + group(72, std::to_string(faces.size()));
  for (const auto& [x, y] : corners)
    entities_ += group(0, "VERTEX") + group(8, layer) + at(10, x, y) + group(70, "192");
  for (const auto& face : faces) {
    entities_ +=
        group(0, "VERTEX") + group(8, layer) + group(10, "0") + group(20, "0") + group(30, "0") + group(70, "128");
    for (std::size_t k = 0; k < face.size(); ++k) entities_ += group(71 + static_cast<int>(k), std::to_string(face[k]));
  }
  entities_ += group(0, "SEQEND") + group(8, layer);
}

void DrawingText::rectangle(const std::string& layer, double x0, double y0, double x1, double y1) {
  polyline(layer, Points{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

void DrawingText::arc(const std::string& layer, double x, double y, double radius, double from, double to) {
  const double first = look_.below ? 180 - to : from, second = look_.below ? 180 - from : to;
  entities_ += begin("ARC", layer, true) + own(10, x, y) + group(30, "0") + length(40, radius) +
               group(50, std::to_string(first)) + group(51, std::to_string(second));
}

void DrawingText::circle(const std::string& layer, double x, double y, double radius) {
  entities_ += begin("CIRCLE", layer, true) + own(10, x, y) + group(30, "0") + length(40, radius);
}

void DrawingText::ellipse(const std::string& layer, double x, double y, double major_x, double major_y, double ratio) {
  entities_ += begin("ELLIPSE", layer, true) + at(10, x, y) + length(11, major_x) + length(21, major_y) +
               group(31, "0") + group(40, std::to_string(ratio)) + group(41, "0") + group(42, "6.283185307179586");
}

void DrawingText::round_spline(const std::string& layer, double x, double y, double radius) {
  entities_ += begin("SPLINE", layer, false) + group(70, "13") + group(71, "2") + group(72, "12") + group(73, "9");
  for (const int knot : {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}) entities_ += group(40, std::to_string(knot));
  for (int k = 0; k < 9; ++k) entities_ += group(41, k % 2 == 0 ? "1" : "0.70710678118654752");
  for (const auto& [dx, dy] : Points{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}})
    entities_ += at(10, x + radius * dx, y + radius * dy);
}

void DrawingText::solid(const std::string& layer, double x0, double y0, double x1, double y1) {
  entities_ += begin("SOLID", layer, true) + own(10, x0, y0) + own(11, x1, y0) + own(12, x0, y1) + own(13, x1, y1);
}

void DrawingText::hatch(const std::string& layer, const std::vector<Points>& rings, const Hatch& hatch) {
  entities_ += begin("HATCH", layer, true) + group(10, "0") + group(20, "0") + group(30, "0") + group(2, "SOLID") +
               group(70, "1") + group(71, "0") + group(91, std::to_string(rings.size()));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Points& ring = rings[r];
    const bool by_edges = hatch.boundary == Boundary::edges;
    const int flags = (r < hatch.flags.size() ? hatch.flags[r] : 1) | (by_edges ? 0 : 2);
    entities_ += group(92, std::to_string(flags));
    if (!by_edges) entities_ += group(72, "0") + group(73, "1");
    entities_ += group(93, std::to_string(ring.size()));
    for (std::size_t k = 0; k < ring.size(); ++k) {
      auto [x, y] = ring[k];
      auto [u, v] = ring[(k + 1) % ring.size()];
      if (by_edges && k % 3 == 2) std::swap(x, u), std::swap(y, v);  // an edge may be written backwards
      entities_ += by_edges ? group(72, "1") + own(10, x, y) + own(11, u, v) : own(10, x, y);
    }
    entities_ += group(97, "0");
  }
  entities_ += group(75, std::to_string(hatch.style)) + group(76, "1") + group(98, std::to_string(hatch.seeds));
  for (int k = 0; k < hatch.seeds; ++k) entities_ += own(10, 0.1 + k, 0.1);
}

void DrawingText::multiline(const std::string& layer, double x1, double y1, double x2, double y2, double width) {
  const double size = std::hypot(x2 - x1, y2 - y1), ux = (x2 - x1) / size, uy = (y2 - y1) / size;
  entities_ += begin("MLINE", layer, false) + group(2, "STANDARD") + length(40, width) + group(70, "1") +
               group(71, "1") + group(72, "2") + group(73, "2") + at(10, x1, y1);
  for (const auto& [x, y] : Points{{x1, y1}, {x2, y2}}) {
    entities_ += at(11, x, y);
    for (const auto& [code, dx, dy] : {std::tuple(12, ux, uy), std::tuple(13, -uy, ux)})
      entities_ += group(code, std::to_string(dx)) + group(code + 10, std::to_string(dy)) + group(code + 20, "0");
    for (const double offset : {width / 2, -width / 2})
      entities_ += group(74, "2") + length(41, offset) + group(41, "0") + group(75, "0");
  }
}

void DrawingText::text(const std::string& layer, double x, double y, const std::string& text) {
  entities_ += begin("TEXT", layer, true) + own(10, x, y) + group(30, "0") + length(40, 0.2) + group(1, text);
}

void DrawingText::paragraph(const std::string& layer, double x, double y, const std::string& text) {
  entities_ += begin("MTEXT", layer, false) + at(10, x, y) + length(40, 0.2) + group(71, "1") + group(1, text);
}

void DrawingText::insert(const std::string& layer, const std::string& block, double x, double y, double sx, double sy,
                         double degrees, const Array& array) {
  const int turned = look_.below ? -1 : 1;
  entities_ += begin("INSERT", layer, true) + group(2, block) + own(10, x, y) + group(30, "0") +
               group(41, std::to_string(turned * sx)) + group(42, std::to_string(sy)) +
               group(50, std::to_string(turned * degrees)) + group(70, std::to_string(array.columns)) +
               group(71, std::to_string(array.rows)) + length(44, turned * array.dx) + length(45, array.dy);
}

void DrawingText::raw(const std::string& type, const std::string& layer, const std::string& groups) {
  entities_ += begin(type, layer, false) + groups;
}

void DrawingText::begin_block(const std::string& name, double base_x, double base_y) {
  outside_.swap(entities_);
  in_block_ = true;
  entities_ = group(0, "BLOCK") + group(8, "0") + group(2, name) + group(70, "0") + length(10, base_x) +
              length(20, base_y) + group(30, "0") + group(3, name);
}

void DrawingText::end_block() {
  blocks_ += entities_ + group(0, "ENDBLK") + group(8, "0");
  entities_.clear();
  outside_.swap(entities_);
  in_block_ = false;
}

std::string DrawingText::str() const {
  const auto section = [](const std::string& name, const std::string& content) {
    return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
  };
  const std::string table = group(0, "TABLE") + group(2, "LAYER") + group(70, "9") + layers_ + group(0, "ENDTAB");
  return section("HEADER", header_) + (layers_.empty() ? "" : section("TABLES", table)) + section("BLOCKS", blocks_) +
         section("ENTITIES", entities_) + group(0, "EOF");
}

DrawingText small_flat(int unit, double scale, double miss) {
  DrawingText d(unit, scale);
  const std::string wall = "A-WALL", door = "A-DOOR", glass = "A-GLAZ";
  // Each wall by its two lines; ends at doors are closed.
  d.polyline(wall, {{5.5, 6.3}, {10.3, 6.3}, {10.3, -0.3}, {-0.3, -0.3}, {-0.3, 6.3}, {4.5, 6.3}, {4.5, 6},
                    {0, 6},     {0, 4.1},    {2, 4.1},     {2, 4},       {0, 4},      {0, 0},     {4.95, 0},
                    {4.95, 4},  {2.9, 4},    {2.9, 4.1},   {7, 4.1},     {7, 4},      {5.05, 4}},
             false);
  d.line(wall, 5.05, 4, 5.05, miss);
  d.polyline(wall, {{5.05, 0}, {10, 0}, {10, 4}, {7.9, 4}, {7.9, 4.1}, {10, 4.1}, {10, 6}, {5.5, 6}, {5.5, 6.3}},
             false);
  for (const double x : {2.0, 7.0}) {
    d.arc(door, x, 4, 0.9, 270, 360);
    d.line(door, x, 4, x, 3.1);
  }
  d.arc(door, 4.5, 6, 1, 270, 360);
  d.line(door, 4.5, 6, 4.5, 5);
  for (const double x : {1.5, 6.5})
    for (const double y : {-0.3, -0.15, 0.0}) d.line(glass, x, y, x + 1.5, y);
  d.begin_block("Table 80");
  d.rectangle("0", -0.6, -0.4, 0.6, 0.4);
  d.end_block();
  d.insert("A-FURN", "Table 80", 2.5, 1.5, 1, 1, 30);
  d.text("A-NAME", 1.5, 2,
         "K\xFC"
         "che");
  d.text("A-NAME", 6, 2, "Wohnen");
  d.text("A-NAME", 6, 1.6, "18.5 m\xB2");
  d.text("A-NAME", 7, 5, "Flur");
  return d;
}

}  // namespace vantage::test
