// SPDX-License-Identifier: Apache-2.0
// A page to draw on, in pixels from the top left. It is a recording, so PNG and SVG come from the same strokes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "map/colour.hpp"

namespace vantage {

// Pixels of a PNG: sharp on dense screens and in print.
inline constexpr std::size_t kPixelsPerUnit = 2;

struct Point {
  double x = 0, y = 0;
};

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
  bool overlaps(const Rect& o) const { return x < o.right() && o.x < right() && y < o.bottom() && o.y < bottom(); }
};

struct Pen {
  Colour colour = {0.15, 0.15, 0.17};
  double width = 1, opacity = 1;
  std::vector<double> dashes = {};
};

enum class Align { start, middle, end };

struct TextStyle {
  double size = 13;
  bool bold = false;
  Colour colour = {0.15, 0.15, 0.17};
  Align across = Align::start;  // in x
  Align down = Align::middle;   // in y; start: the text hangs below it
  double turn = 0;              // radians, clockwise
  double halo = 0;              // width of a white rim, for text on pictures
};

class Canvas {
 public:
  Canvas(double width, double height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  double width() const { return width_; }
  double height() const { return height_; }
  // Drops what lies below. REQUIRES: height <= height().
  void cut_to(double height) { height_ = height; }

  void line(Point a, Point b, const Pen& pen);
  void path(std::span<const Point> points, const Pen& pen);
  void polygon(std::span<const Point> points, const Colour& fill, double opacity = 1);
  void rectangle(const Rect& r, const Pen& pen);
  void fill(const Rect& r, const Colour& colour, double opacity = 1);
  void disc(Point centre, double radius, const Colour& fill, double opacity = 1);
  void circle(Point centre, double radius, const Pen& pen);
  void text(Point at, const std::string& text, const TextStyle& style = {});
  double text_width(const std::string& text, const TextStyle& style = {}) const;
  // Rows of 0xAARRGGBB from the top, premultiplied, stretched over the rectangle.
  void image(const Rect& r, std::span<const std::uint32_t> pixels, std::size_t columns);
  // Draws another page, scaled to the rectangle.
  void page(const Rect& r, const Canvas& other);
  // Clips everything until the matching unclip().
  void clip(const Rect& r);
  void unclip();

  // Saves as .png (two device pixels a unit) or .svg by extension. Throws Error: io, invalid_argument.
  void save(const std::filesystem::path& file) const;
  // Saves these pages as a .pdf, a point a unit. Throws Error: io.
  static void save_pages(const std::filesystem::path& file, std::span<const std::unique_ptr<Canvas>> pages,
                         const std::string& title);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  double width_, height_;
};

}  // namespace vantage
