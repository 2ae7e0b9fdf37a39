// SPDX-License-Identifier: Apache-2.0
// How a problem's front is laid out on paper: which quantity stands on which axis, which one is colour.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/canvas.hpp"
#include "report/chart.hpp"
#include "vantage/planner.hpp"

namespace vantage {

struct FrontDot {
  double x = 0, y = 0;
  double stations = 0;
};

class FrontView {
 public:
  explicit FrontView(const PlanConfig& config) : config_(config) {}

  bool single() const { return has_one_objective(config_); }                          // one dot: on the whole range
  bool by_count() const { return config_.problem == Problem::coverage_min; }          // stations on x, coverage on y
  bool coloured() const { return config_.problem == Problem::coverage_overlap_min; }  // by the number of stations
  FrontDot searched(const PlanEntry& entry) const;
  FrontDot confirmed(const PlanEntry& entry) const;
  FrontDot objectives(std::span<const double> f) const;  // of a line of the history
  Axis x_axis(const std::vector<FrontDot>& dots) const;
  Axis y_axis(const std::vector<FrontDot>& dots) const;
  Colour colour(const FrontDot& dot) const;

 private:
  const PlanConfig& config_;
};

// "coverage-overlap-fix, 8 stations"
std::string problem_line(const PlanConfig& config);

// One row of symbols with words, from `at` to the right.
struct LegendItem {
  enum class Mark { filled, small, hollow, ring, line } mark = Mark::filled;
  Colour colour = {};
  std::string text = {};
};
void draw_legend(Canvas& canvas, Point at, std::span<const LegendItem> items);
// A vertical bar of the stations' colours with its numbers, right of `area`.
void draw_station_bar(Canvas& canvas, const Rect& area, const PlanConfig& config);

}  // namespace vantage
