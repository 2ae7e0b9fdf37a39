// SPDX-License-Identifier: Apache-2.0
#include "report/front_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

const char* const kCoverage = "Coverage (1: every surveyed voxel at its goal density)";
const char* const kOverlap = "Overlap (average clustering coefficient)";

template <class Get>
Axis share_axis(const std::string& label, const std::vector<FrontDot>& dots, bool whole, Get get) {
  if (whole) return axis_over(label, 0, 1, 0, 1);
  double low = 1, high = 0;
  for (const FrontDot& dot : dots) low = std::min(low, get(dot)), high = std::max(high, get(dot));
  if (dots.empty()) low = 0, high = 1;
  return axis_over(label, low, high, 0, 1);
}

}  // namespace

FrontDot FrontView::searched(const PlanEntry& entry) const {
  const double n = static_cast<double>(entry.stations.size());
  return by_count() ? FrontDot{n, entry.coverage, n} : FrontDot{entry.coverage, entry.overlap, n};
}

FrontDot FrontView::confirmed(const PlanEntry& entry) const {
  const double n = static_cast<double>(entry.stations.size());
  return by_count() ? FrontDot{n, entry.exact_coverage, n} : FrontDot{entry.exact_coverage, entry.exact_overlap, n};
}

FrontDot FrontView::objectives(std::span<const double> f) const {
  const auto count = [&](double alpha) {
    return static_cast<double>(config_.fixed.size() +
                               station_count_from_alpha(alpha, config_.stations_min, config_.stations_max));
  };
  const double all = static_cast<double>(config_.fixed.size() + config_.stations_max);
  if (config_.fitness) return {1 - f[0], 0, all};
  switch (config_.problem) {
    case Problem::coverage_fix: return {1 - f[0], 0, all};
    case Problem::coverage_overlap_fix: return {1 - f[0], 1 - f[1], all};
    case Problem::coverage_min: return {count(f[1]), 1 - f[0], count(f[1])};
    case Problem::coverage_overlap_min: return {1 - f[0], 1 - f[1], count(f[2])};
  }
  return {};
}

Axis FrontView::x_axis(const std::vector<FrontDot>& dots) const {
  if (!by_count()) return share_axis(kCoverage, dots, single(), [](const FrontDot& d) { return d.x; });
  const double low = static_cast<double>(config_.fixed.size() + config_.stations_min);
  const double high = static_cast<double>(config_.fixed.size() + config_.stations_max);
  Axis axis{.label = "Number of stations", .low = low - 0.5, .high = high + 0.5};
  const double step = std::max(1.0, std::ceil((high - low) / 12));
  for (double n = low; n <= high; n += step) axis.ticks.push_back(n);
  return axis;
}

Axis FrontView::y_axis(const std::vector<FrontDot>& dots) const {
  return share_axis(by_count() ? kCoverage : kOverlap, dots, single(), [](const FrontDot& d) { return d.y; });
}

Colour FrontView::colour(const FrontDot& dot) const {
  if (!coloured()) return style::blue;
  const double low = static_cast<double>(config_.fixed.size() + config_.stations_min);
  const double range = std::max<double>(1, static_cast<double>(config_.stations_max - config_.stations_min));
  return ramp(kRisingRamp, 0.95 * (dot.stations - low) / range);  // the last yellow is too pale on white
}

std::string problem_line(const PlanConfig& config) {
  const std::size_t low = config.fixed.size() + config.stations_min, high = config.fixed.size() + config.stations_max;
  std::string line = to_string(config.problem) + ", " + std::to_string(low);
  if (high != low) line += " to " + std::to_string(high);
  line += high == 1 ? " station" : " stations";
  if (!config.fixed.empty()) line += " (" + std::to_string(config.fixed.size()) + " kept)";
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

void draw_station_bar(Canvas& canvas, const Rect& area, const PlanConfig& config) {
  const FrontView view(config);
  const std::size_t low = config.fixed.size() + config.stations_min, high = config.fixed.size() + config.stations_max;
  const double cell = area.height / static_cast<double>(high - low + 1);
  const std::size_t step = static_cast<std::size_t>(std::ceil(16 / cell));
  for (std::size_t n = low; n <= high; ++n) {
    const double y = area.bottom() - cell * static_cast<double>(n - low + 1);
    canvas.fill({area.right() + 18, y, 16, cell + 0.5}, view.colour({.stations = static_cast<double>(n)}));
    if ((n - low) % step == 0) canvas.text({area.right() + 40, y + cell / 2}, std::to_string(n), {.size = 12.5});
  }
  canvas.rectangle({area.right() + 18, area.y, 16, area.height}, {.colour = style::faint, .width = 1});
  canvas.text({area.right() + 72, area.y + area.height / 2}, "Number of stations",
              {.size = 13.5, .across = Align::middle, .turn = -std::numbers::pi / 2});
}

}  // namespace vantage
