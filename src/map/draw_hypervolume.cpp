// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/text.hpp"
#include "map/front_view.hpp"
#include "map/pictures.hpp"
#include "vantage/pictures.hpp"

namespace vantage {

std::unique_ptr<Canvas> hypervolume_picture(const PlanResult& result) {
  constexpr double kWidth = 780, kHeight = 500;
  auto page = std::make_unique<Canvas>(kWidth, kHeight);
  Canvas& canvas = *page;
  const Rect area{86, 72, kWidth - 86 - 30, kHeight - 72 - 70};

  double low = 1, high = 0, last = 1;
  for (const PlanIteration& line : result.history) {
    low = std::min(low, line.hypervolume), high = std::max(high, line.hypervolume);
    last = std::max(last, static_cast<double>(line.iteration));
  }
  if (result.history.empty()) low = 0, high = 1;
  if (result.config.target_hypervolume)
    low = std::min(low, *result.config.target_hypervolume), high = std::max(high, *result.config.target_hypervolume);
  Axis x{.label = "Iteration", .low = 0, .high = last * 1.02};
  if (!result.history.empty()) {
    const PlanIteration& end = result.history.back();
    if (end.iteration > 0) x.label += " (" + std::to_string(end.evaluations / end.iteration) + " evaluations each)";
  }
  x.ticks = nice_ticks(0, x.high, 8);
  std::erase_if(x.ticks, [](double t) { return t != static_cast<double>(static_cast<long long>(t)); });
  const Axis y = axis_over("Hypervolume (reference point 1, largest value 1)", low, high, 0, 1);
  std::string reason = to_string(result.stop_reason);
  std::replace(reason.begin(), reason.end(), '_', ' ');
  const Chart chart(canvas, area, x, y, "Hypervolume over the search",
                    problem_line(result.problem) + ", stopped: " + reason);
  if (result.config.target_hypervolume) {
    const double target = *result.config.target_hypervolume;
    canvas.line(chart.at(x.low, target), chart.at(x.high, target),
                {.colour = style::kOrange, .width = 1.2, .dashes = {6, 4}});
    const Point beside = chart.at(x.low + 0.01 * (x.high - x.low), target);
    canvas.text({beside.x, beside.y - 5}, "target " + number(target),
                {.size = 12.5, .colour = style::kOrange, .down = Align::end, .halo = 2});
  }
  std::vector<Point> curve;
  for (const PlanIteration& line : result.history)
    curve.push_back(chart.at(static_cast<double>(line.iteration), line.hypervolume));
  canvas.clip({area.x, area.y - 4, area.width + 4, area.height + 8});
  canvas.path(curve, {.colour = style::kBlue, .width = 2.2});
  canvas.unclip();
  if (!curve.empty()) {
    canvas.disc(curve.back(), 4.5, style::kBlue);
    // A rising curve leaves room below its end.
    canvas.text(
        {std::min(curve.back().x + 4, area.right() - 6), curve.back().y + 12},
        fixed(result.history.back().hypervolume, 4),
        {.size = 13, .bold = true, .colour = style::kBlue, .across = Align::end, .down = Align::start, .halo = 2});
  }
  return page;
}

void draw_hypervolume(const std::filesystem::path& file, const PlanResult& result) {
  hypervolume_picture(result)->save(file);
}

}  // namespace vantage
