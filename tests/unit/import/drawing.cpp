// SPDX-License-Identifier: Apache-2.0
#include "drawing.hpp"

namespace vantage::test {

void DrawingText::line(const std::string& layer, double x1, double y1, double x2, double y2) {
  entities_ += group(0, "LINE") + group(8, layer) + at(x1, y1) + length(11, x2) + length(21, y2) + group(31, "0");
}

void DrawingText::polyline(const std::string& layer, const Points& points, bool closed) {
  entities_ += group(0, "LWPOLYLINE") + group(8, layer) + group(90, std::to_string(points.size())) +
               group(70, closed ? "1" : "0");
  for (const auto& [x, y] : points) entities_ += length(10, x) + length(20, y);
}

void DrawingText::rectangle(const std::string& layer, double x0, double y0, double x1, double y1) {
  polyline(layer, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

void DrawingText::arc(const std::string& layer, double x, double y, double radius, double from, double to) {
  entities_ += group(0, "ARC") + group(8, layer) + at(x, y) + length(40, radius) + group(50, std::to_string(from)) +
               group(51, std::to_string(to));
}

void DrawingText::text(const std::string& layer, double x, double y, const std::string& text) {
  entities_ += group(0, "TEXT") + group(8, layer) + at(x, y) + length(40, 0.2) + group(1, text);
}

void DrawingText::paragraph(const std::string& layer, double x, double y, const std::string& text) {
  entities_ += group(0, "MTEXT") + group(8, layer) + at(x, y) + length(40, 0.2) + group(71, "1") + group(1, text);
}

void DrawingText::insert(const std::string& layer, const std::string& block, double x, double y, double sx, double sy,
                         double degrees) {
  entities_ += group(0, "INSERT") + group(8, layer) + group(2, block) + at(x, y) + group(41, std::to_string(sx)) +
               group(42, std::to_string(sy)) + group(50, std::to_string(degrees));
}

void DrawingText::begin_block(const std::string& name) {
  outside_.swap(entities_);
  entities_ = group(0, "BLOCK") + group(8, "0") + group(2, name) + group(70, "0") + group(10, "0") + group(20, "0") +
              group(30, "0") + group(3, name);
}

void DrawingText::end_block() {
  blocks_ += entities_ + group(0, "ENDBLK") + group(8, "0");
  entities_.clear();
  outside_.swap(entities_);
}

std::string DrawingText::str() const {
  const auto section = [](const std::string& name, const std::string& content) {
    return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
  };
  return section("HEADER", header_) + section("BLOCKS", blocks_) + section("ENTITIES", entities_) + group(0, "EOF");
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
