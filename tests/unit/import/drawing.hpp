// SPDX-License-Identifier: Apache-2.0
// Writes small drawings as DXF texts.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace vantage::test {

class DrawingText {
 public:
  using Points = std::vector<std::pair<double, double>>;

  // `unit`: code of $INSUNITS, 0 if none; `scale`: units in a metre, in which the calls below are.
  explicit DrawingText(int unit = 6, double scale = 1) : scale_(scale) {
    header_ = group(9, "$DWGCODEPAGE") + group(3, "ANSI_1252");
    if (unit > 0) header_ += group(9, "$INSUNITS") + group(70, std::to_string(unit));
  }

  void line(const std::string& layer, double x1, double y1, double x2, double y2);
  void polyline(const std::string& layer, const Points& points, bool closed = true);
  void rectangle(const std::string& layer, double x0, double y0, double x1, double y1);
  // Counter-clockwise between angles in degrees.
  void arc(const std::string& layer, double x, double y, double radius, double from, double to);
  void text(const std::string& layer, double x, double y, const std::string& text);
  void paragraph(const std::string& layer, double x, double y, const std::string& text);  // MTEXT
  void insert(const std::string& layer, const std::string& block, double x, double y, double sx = 1, double sy = 1,
              double degrees = 0);
  // What is drawn from here on belongs to a block, until `end_block`.
  void begin_block(const std::string& name);
  void end_block();
  std::string str() const;

 private:
  static std::string group(int code, const std::string& value) { return std::to_string(code) + "\n" + value + "\n"; }
  std::string length(int code, double metres) const { return group(code, std::to_string(metres * scale_)); }
  std::string at(double x, double y) const { return length(10, x) + length(20, y) + group(30, "0"); }

  double scale_;
  std::string header_, blocks_, entities_, outside_;
};

// A kitchen and a living room below a corridor, in the walls of 0.3 m, with doors to both and one outside, a window
// each and a table: 10 x 6 m inside, from (0, 0). The living room's west wall ends `miss` short of its corner.
DrawingText small_flat(int unit = 6, double scale = 1, double miss = 0);

}  // namespace vantage::test
