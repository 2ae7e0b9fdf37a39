// SPDX-License-Identifier: Apache-2.0
// Sheets of paper that are written from the top, in points.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "map/canvas.hpp"
#include "report/sheet_layout.hpp"

namespace vantage {

inline constexpr Colour kFaintInk{0.36, 0.38, 0.42}, kRuleInk{0.80, 0.81, 0.83}, kAlertInk{0.72, 0.12, 0.12};

struct Sheet {
  static constexpr double kMargin = 48, kLine = 15;
  std::unique_ptr<Canvas> canvas;
  double y = kMargin;

  explicit Sheet(const Paper& paper) : canvas(std::make_unique<Canvas>(paper.width, paper.height)) {}
  double right() const { return canvas->width() - kMargin; }
  double left() const { return canvas->height() - kMargin - y; }  // of its height, in points
  void heading(const std::string& text);
  // Writes text in lines that end before `end`; 0: at the margin.
  void words(double x, const std::string& text, const TextStyle& style, double end = 0);
  void rule();
};

// Text shortened to a width, with an ellipsis.
std::string fitted(const Canvas& canvas, std::string text, double width, const TextStyle& style);

// Returns the size of letters, at most that of the style, at which a text fits into a width without being shortened.
double fitting_size(const Canvas& canvas, const std::string& text, double width, const TextStyle& style);

// Numbers end at the right of their column and are never cut; words begin at its left, on several lines if needed.
struct SheetColumn {
  std::string title;
  Align across = Align::end;
};

// Writes a table below the last sheet's content, over as many sheets of its paper as it takes, with its head on each.
// Columns are as wide as their texts; columns of words share the remaining room. `most`: largest number of rows; a line
// says how many more there are, and where.
void write_table(std::vector<Sheet>& sheets, const Paper& paper, const std::vector<SheetColumn>& columns,
                 std::size_t rows, std::size_t most, const std::string& where,
                 const std::function<std::vector<std::string>(std::size_t)>& cells);

}  // namespace vantage
