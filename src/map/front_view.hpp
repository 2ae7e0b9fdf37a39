// SPDX-License-Identifier: Apache-2.0
// Layout of a problem's front on paper: the measure on each axis and the one shown by colour.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "map/canvas.hpp"
#include "map/chart.hpp"
#include "vantage/planner.hpp"

namespace vantage {

struct FrontDot {
  double x = 0, y = 0;
  double colour = 0;  // the third objective, if any
};

// With one objective: that one to the right, the next measure up. With several: the first two on the axes, the third by
// colour. The number of stations is to the right with two objectives, and the colour with three.
class FrontView {
 public:
  explicit FrontView(const PlanResult& result);
  FrontView(const FrontView&) = delete;  // points into itself

  bool single() const { return result_.problem.objectives.size() == 1; }  // one dot: on the whole range
  const Objective& x() const { return *x_; }
  const Objective& y() const { return *y_; }
  const Objective* third() const { return third_; }  // null: no colour
  FrontDot searched(const PlanEntry& entry) const;
  FrontDot confirmed(const PlanEntry& entry) const;
  // For a line of the history; empty if the network violates a requirement.
  std::optional<FrontDot> objectives(std::span<const double> f) const;
  Axis x_axis(const std::vector<FrontDot>& dots) const;
  Axis y_axis(const std::vector<FrontDot>& dots) const;
  Colour colour(const FrontDot& dot) const;
  // "0.983 coverage, 0.204 overlap"
  std::string words(const PlanEntry& entry) const;

 private:
  const PlanResult& result_;
  std::vector<Objective> measures_;  // at least two
  const Objective *x_ = nullptr, *y_ = nullptr, *third_ = nullptr;
};

// "coverage-overlap-fix, 8 stations"
std::string problem_line(const SurveyProblem& problem);

// One row of symbols with words, from `at` to the right.
struct LegendItem {
  enum class Mark { filled, small, hollow, ring, line } mark = Mark::filled;
  Colour colour = {};
  std::string text = {};
};
void draw_legend(Canvas& canvas, Point at, std::span<const LegendItem> items);
// A vertical bar of the third objective's colours with its numbers, right of `area`.
void draw_colour_bar(Canvas& canvas, const Rect& area, const FrontView& view);

}  // namespace vantage
