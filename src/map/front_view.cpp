// SPDX-License-Identifier: Apache-2.0
#include "map/front_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/text.hpp"

namespace vantage {
namespace {

// "weakest_link" as readable words.
std::string spoken(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string axis_label(const Objective& measure) {
  return measure.unit.empty() ? measure.label : measure.label + " (" + measure.unit + ")";
}

Axis count_axis(const Objective& measure) {
  const auto [fewest, most] = measure.scale;
  Axis axis{.label = measure.label, .low = fewest - 0.5, .high = most + 0.5};
  const double step = std::max(1.0, std::ceil((most - fewest) / 12));
  for (double n = fewest; n <= most; n += step) axis.ticks.push_back(n);
  return axis;
}

Axis axis_of(const Objective& measure, const std::vector<FrontDot>& dots, bool whole, double FrontDot::*coordinate) {
  if (measure.by_alpha) return count_axis(measure);
  const auto [bottom, top] = std::minmax({measure.scale.best, measure.scale.worst});
  double low = top, high = bottom;
  for (const FrontDot& dot : dots) {
    if (!std::isfinite(dot.*coordinate)) continue;
    low = std::min(low, dot.*coordinate), high = std::max(high, dot.*coordinate);
  }
  if (whole || low > high) low = std::min(low, bottom), high = std::max(high, top);
  if (low > high) std::swap(low, high);
  return axis_over(axis_label(measure), low, high, std::min(low, bottom), std::max(high, top));
}

}  // namespace

FrontView::FrontView(const PlanResult& result) : result_(result), measures_(result.measures) {
  // A search that ended before it began still needs axes.
  for (const char* name : {"coverage", "overlap"})
    if (measures_.size() < 2) measures_.push_back(make_objective(name));
  const std::size_t objectives = result.problem.objectives.size();
  std::vector<const Objective*> order;
  const Objective* count = nullptr;
  for (std::size_t k = 0; k < std::max<std::size_t>(objectives, 2) && k < measures_.size(); ++k) {
    const Objective& measure = measures_[k];
    if (measure.by_alpha && objectives > 1 && !count)
      count = &measure;
    else
      order.push_back(&measure);
  }
  if (count) order.insert(objectives == 2 ? order.begin() : order.begin() + 2, count);
  x_ = order[0], y_ = order[1];
  third_ = objectives > 2 ? order[2] : nullptr;
}

FrontDot FrontView::searched(const PlanEntry& entry) const {
  const auto value = [&](const Objective& measure) { return entry.searched.at(measure.name).value; };
  return {value(*x_), value(*y_), third_ ? value(*third_) : 0};
}

FrontDot FrontView::confirmed(const PlanEntry& entry) const {
  const auto value = [&](const Objective& measure) { return entry.value(measure.name); };
  return {value(*x_), value(*y_), third_ ? value(*third_) : 0};
}

std::optional<FrontDot> FrontView::objectives(std::span<const double> f) const {
  if (std::any_of(f.begin(), f.end(), [](double value) { return !(value <= 1); })) return std::nullopt;
  const auto value = [&](const Objective* measure) {
    for (std::size_t k = 0; k < f.size(); ++k)
      if (measure && measure->name == result_.problem.objectives[k].name) return measure->unscaled(f[k]);
    return 0.0;
  };
  return FrontDot{value(x_), value(y_), value(third_)};
}

Axis FrontView::x_axis(const std::vector<FrontDot>& dots) const { return axis_of(*x_, dots, single(), &FrontDot::x); }
Axis FrontView::y_axis(const std::vector<FrontDot>& dots) const { return axis_of(*y_, dots, single(), &FrontDot::y); }

Colour FrontView::colour(const FrontDot& dot) const {
  if (!third_) return style::kBlue;
  const double low = std::min(third_->scale.best, third_->scale.worst), range = third_->scale.width();
  const double share = (dot.colour - low) / (range > 0 ? range : 1);
  return ramp(kRisingRamp, 0.95 * std::clamp(share, 0.0, 1.0));  // the last yellow is too pale on white
}

std::string FrontView::words(const PlanEntry& entry) const {
  std::string text;
  for (const Objective* measure : {x_, y_, third_}) {
    if (!measure) continue;
    const double value = entry.value(measure->name);
    text += text.empty() ? "" : ", ";
    text += measure->by_alpha ? std::to_string(entry.stations.size()) : fixed(value, 3);
    text += (measure->unit.empty() ? "" : " " + measure->unit) + " " + spoken(measure->name);
  }
  return text;
}

std::string problem_line(const SurveyProblem& problem) {
  const std::size_t low = problem.existing.size() + problem.stations_min,
                    high = problem.existing.size() + problem.stations_max;
  std::string line = problem.name;
  if (line == "custom") {
    line.clear();
    for (const Objective& objective : problem.objectives) line += (line.empty() ? "" : ", ") + spoken(objective.name);
  }
  line += ", " + std::to_string(low);
  if (high != low) line += " to " + std::to_string(high);
  line += high == 1 ? " station" : " stations";
  if (!problem.existing.empty()) line += " (" + std::to_string(problem.existing.size()) + " existing)";
  for (const Requirement& requirement : problem.requirements) line += ", " + in_words(requirement);
  return line;
}

void draw_legend(Canvas& canvas, Point at, std::span<const LegendItem> items) {
  for (const LegendItem& item : items) {
    const Point mark{at.x + 9, at.y};
    switch (item.mark) {
      case LegendItem::Mark::filled: canvas.disc(mark, 4.5, item.colour); break;
      case LegendItem::Mark::small: canvas.disc(mark, 2.7, item.colour, 0.5); break;
      case LegendItem::Mark::hollow: canvas.circle(mark, 4, {.colour = item.colour, .width = 1.2}); break;
      case LegendItem::Mark::ring: canvas.circle(mark, 8, {.colour = item.colour, .width = 2}); break;
      case LegendItem::Mark::line:
        canvas.line({at.x, at.y}, {at.x + 18, at.y}, {.colour = item.colour, .width = 2});
        break;
    }
    canvas.text({at.x + 24, at.y}, item.text, {.size = 12.5});
    at.x += 24 + canvas.text_width(item.text, {.size = 12.5}) + 24;
  }
}

void draw_colour_bar(Canvas& canvas, const Rect& area, const FrontView& view) {
  const Objective& measure = *view.third();
  const auto [low, high] = std::minmax({measure.scale.best, measure.scale.worst});
  const std::size_t cells = measure.by_alpha ? static_cast<std::size_t>(high - low) + 1 : 24;
  const double cell = area.height / static_cast<double>(cells);
  const auto step = static_cast<std::size_t>(std::ceil((measure.by_alpha ? 16 : 48) / cell));
  for (std::size_t k = 0; k < cells; ++k) {
    const double y = area.bottom() - cell * static_cast<double>(k + 1);
    const double share = cells == 1 ? 0 : static_cast<double>(k) / static_cast<double>(cells - 1);
    const double value = low + share * (high - low);
    canvas.fill({area.right() + 18, y, 16, cell + 0.5}, view.colour({.colour = value}));
    if (k % step == 0)
      canvas.text({area.right() + 40, y + cell / 2}, measure.by_alpha ? fixed(value, 0) : fixed(value, 2),
                  {.size = 12.5});
  }
  canvas.rectangle({area.right() + 18, area.y, 16, area.height}, {.colour = style::kFaint, .width = 1});
  canvas.text({area.right() + 72, area.y + area.height / 2}, axis_label(measure),
              {.size = 13.5, .across = Align::middle, .turn = -std::numbers::pi / 2});
}

}  // namespace vantage
