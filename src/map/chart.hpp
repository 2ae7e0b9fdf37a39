// SPDX-License-Identifier: Apache-2.0
// A framed x-y chart with sensible ticks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "map/canvas.hpp"

namespace vantage {

// About `wanted` ticks inside [low, high], at multiples of 1, 2 or 5 times a power of ten.
std::vector<double> nice_ticks(double low, double high, int wanted);
// Texts of ticks of one axis: as many decimals as the step needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);
// Powers of ten inside [low, high]; if these are few, also twice and five times each. REQUIRES: low > 0.
std::vector<double> logarithmic_ticks(double low, double high);
// Each with the digits that it needs itself.
std::vector<std::string> logarithmic_labels(const std::vector<double>& ticks);

struct Axis {
  std::string label;
  double low = 0, high = 1;
  std::vector<double> ticks = {};  // empty: nice ones
  int wanted_ticks = 6;
  bool logarithmic = false;  // low > 0
};

// Widens [low, high] by a margin, within [least, most] unless the data lie outside.
Axis axis_over(std::string label, double low, double high, double least, double most);

// Width that the labels of a vertical axis, which is not logarithmic, take left of its frame, with a margin.
double room_left_of(const Canvas& canvas, const Axis& y);

class Chart {
 public:
  // Draws title, frame, grid, ticks and labels. `area` is the frame.
  Chart(Canvas& canvas, const Rect& area, Axis x, Axis y, const std::string& title, const std::string& subtitle = {});
  Point at(double x, double y) const;
  const Rect& area() const { return area_; }

 private:
  Rect area_;
  Axis x_, y_;
};

// Place for a label of this width and height beside `at`: the nearest free one, else the first tried. Appended to
// `taken`.
Rect place_label(Point at, double gap, double width, double height, const Rect& inside, std::vector<Rect>& taken);

// The nearest free place at most `most` away; empty, and nothing taken, where there is none.
std::optional<Rect> place_free_label(Point at, double gap, double most, double width, double height, const Rect& inside,
                                     std::vector<Rect>& taken);

namespace style {
inline constexpr Colour kInk{0.15, 0.15, 0.17}, kFaint{0.45, 0.45, 0.48}, kGrid{0.90, 0.90, 0.91};
inline constexpr Colour kBlue{0.11, 0.31, 0.58}, kOrange{0.84, 0.37, 0.05}, kPale{0.62, 0.70, 0.80};
}  // namespace style

}  // namespace vantage
