// SPDX-License-Identifier: Apache-2.0
#include "error_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/front_view.hpp"

namespace vantage::bench {
namespace {

constexpr double kWidth = 1180, kHeight = 640;
constexpr Colour kPurple{0.48, 0.25, 0.60}, kGreen{0.10, 0.50, 0.32};

struct Look {
  Colour colour;
  const char* words;
};

Look look_of(Way way) {
  switch (way) {
    case Way::sampled: return {style::kBlue, "a sample of the voxels"};
    case Way::coarser_steps: return {style::kOrange, "coarser steps, goal scaled"};
    case Way::coarser_steps_and_voxels: return {kPurple, "coarser steps and voxels"};
    case Way::coarser_voxels: return {kGreen, "coarser voxels"};
    case Way::every_ray:
    case Way::exact: break;
  }
  return {style::kInk, "exact"};
}

struct Quantity {
  const char* label;
  double ErrorDot::*rms;
  double ErrorDot::*predicted;
};

Axis axis_of(std::string label, const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  // Room for labels beyond the outermost dots.
  return {.label = std::move(label), .low = *low / 1.8, .high = *high * 1.8, .logarithmic = true};
}

double time_of(const std::vector<ErrorDot>& dots, Way way) {
  const auto dot = std::find_if(dots.begin(), dots.end(), [&](const ErrorDot& d) { return d.way == way; });
  return dot == dots.end() ? 0 : dot->milliseconds;
}

// An error of zero lies below every logarithm; exact ways are lines of their own.
bool drawn(const ErrorDot& dot, const Quantity& quantity) { return dot.*quantity.rms > 0; }

// Lets no label stand on a line.
void keep_clear(const std::vector<Point>& line, std::vector<Rect>& taken) {
  for (std::size_t k = 1; k < line.size(); ++k) {
    const double dx = line[k].x - line[k - 1].x, dy = line[k].y - line[k - 1].y;
    const int steps = std::max(1, static_cast<int>(std::hypot(dx, dy) / 5));
    for (int i = 0; i <= steps; ++i)
      taken.push_back({line[k - 1].x + dx * i / steps - 2, line[k - 1].y + dy * i / steps - 2, 4, 4});
  }
}

// A method without error has no height: a line at its time, with its name along it if there is room.
void draw_exact(Canvas& canvas, const Chart& chart, const std::vector<ErrorDot>& dots, const Axis& y,
                std::vector<Rect>& taken) {
  const Rect& area = chart.area();
  const TextStyle text{.size = 12.5, .across = Align::end, .turn = -std::numbers::pi / 2, .halo = 3};
  for (const auto& [way, words] :
       {std::pair{Way::every_ray, "exact, every ray"}, std::pair{Way::exact, "exact, skipping"}}) {
    const double time = time_of(dots, way);
    if (time == 0) continue;
    const double at = chart.at(time, y.low).x, width = canvas.text_width(words, text);
    // Writes the name beside its line, on the side away from the other exact one.
    const double side = way == Way::every_ray ? 9 : -9;
    Rect best{};
    std::ptrdiff_t fewest = std::numeric_limits<std::ptrdiff_t>::max();
    for (double top = area.bottom() - width - 8; top > area.y + 4; top -= 4) {
      const Rect place{at + side - 8, top, 16, width};
      const auto hits = std::count_if(taken.begin(), taken.end(), [&](const Rect& r) { return place.overlaps(r); });
      if (hits < fewest) fewest = hits, best = place;
    }
    canvas.text({at + side, best.y}, words, text);
    taken.push_back(best);
    std::vector<double> dashes;
    if (way == Way::every_ray) dashes = {5, 4};
    canvas.line({at, area.y}, {at, area.bottom()}, {.colour = style::kInk, .width = 1.4, .dashes = dashes});
    for (double top = area.y; top < area.bottom(); top += 8) taken.push_back({at - 1, top, 2, 8});
  }
}

void draw_panel(Canvas& canvas, const Rect& area, const std::vector<ErrorDot>& dots, const Quantity& quantity,
                const std::string& time_label) {
  std::vector<double> times, errors;
  for (const ErrorDot& dot : dots) {
    times.push_back(dot.milliseconds);
    if (drawn(dot, quantity)) errors.push_back(dot.*quantity.rms);
    if (dot.*quantity.predicted > 0) errors.push_back(dot.*quantity.predicted);
  }
  if (errors.empty()) errors.push_back(1e-3);
  const Axis x = axis_of(time_label, times), y = axis_of(quantity.label, errors);
  const Chart chart(canvas, area, x, y, "");
  std::vector<Rect> taken;

  // The axis along the top: speed relative to exact.
  const double exact = time_of(dots, Way::exact);
  canvas.text({area.x + area.width / 2, area.y - 32}, "Times faster than exact",
              {.size = 13.5, .across = Align::middle});
  std::vector<double> ratios = logarithmic_ticks(exact / x.high, exact / x.low);
  const std::vector<std::string> labels = logarithmic_labels(ratios);
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    const Point at = chart.at(exact / ratios[k], y.high);
    canvas.line({at.x, at.y - 5}, at, {.colour = style::kFaint, .width = 1});
    canvas.text({at.x, at.y - 8}, labels[k], {.size = 12.5, .across = Align::middle, .down = Align::end});
  }

  std::vector<Point> predicted;
  for (const ErrorDot& dot : dots)
    if (dot.way == Way::sampled && dot.*quantity.predicted > 0)
      predicted.push_back(chart.at(dot.milliseconds, dot.*quantity.predicted));
  keep_clear(predicted, taken);
  canvas.path(predicted, {.colour = style::kBlue, .width = 1.2, .dashes = {5, 4}});
  for (const Point& at : predicted) canvas.circle(at, 4, {.colour = style::kBlue, .width = 1.2});

  struct Mark {
    Point at;
    std::string label;
    Colour colour;
  };
  std::vector<Mark> marks;
  for (const Way way : {Way::coarser_voxels, Way::coarser_steps, Way::coarser_steps_and_voxels, Way::sampled}) {
    const Look look = look_of(way);
    std::vector<Point> line;
    for (const ErrorDot& dot : dots)
      if (dot.way == way && drawn(dot, quantity)) {
        line.push_back(chart.at(dot.milliseconds, dot.*quantity.rms));
        marks.push_back({line.back(), dot.label, look.colour});
      }
    keep_clear(line, taken);
    canvas.path(line, {.colour = look.colour, .width = way == Way::sampled ? 2.2 : 1.4});
  }
  for (const Mark& mark : marks) {
    canvas.disc(mark.at, 5, mark.colour);
    taken.push_back({mark.at.x - 6, mark.at.y - 6, 12, 12});
  }
  for (const Point& at : predicted) taken.push_back({at.x - 5, at.y - 5, 10, 10});
  draw_exact(canvas, chart, dots, y, taken);
  for (const Mark& mark : marks) {
    const TextStyle text{.size = 12, .colour = mark.colour, .across = Align::middle, .halo = 3};
    const Rect place = place_label(mark.at, 8, canvas.text_width(mark.label, text) + 4, 14, area, taken);
    canvas.text({place.x + place.width / 2, place.y + place.height / 2}, mark.label, text);
  }
}

}  // namespace

std::unique_ptr<Canvas> error_picture(const std::vector<ErrorDot>& dots, const std::string& title,
                                      const std::string& subtitle, const std::string& time_label) {
  auto page = std::make_unique<Canvas>(kWidth, kHeight);
  Canvas& canvas = *page;
  canvas.text({24, 30}, title, {.size = 18, .bold = true});
  canvas.text({24, 54}, subtitle, {.size = 12.5, .colour = style::kFaint});
  constexpr double top = 124, height = 400, width = 470;
  draw_panel(canvas, {96, top, width, height}, dots,
             {"Error of the coverage (rms)", &ErrorDot::coverage_rms, &ErrorDot::coverage_se}, time_label);
  draw_panel(canvas, {kWidth - 24 - width, top, width, height}, dots,
             {"Error of the clustering coefficient (rms)", &ErrorDot::overlap_rms, &ErrorDot::overlap_se}, time_label);
  using Mark = LegendItem::Mark;
  std::vector<LegendItem> items;
  for (const Way way : {Way::sampled, Way::coarser_steps, Way::coarser_steps_and_voxels, Way::coarser_voxels}) {
    const Look look = look_of(way);
    items.push_back({Mark::filled, look.colour, look.words});
    if (way == Way::sampled) items.push_back({Mark::hollow, look.colour, "its predicted standard error"});
  }
  draw_legend(canvas, {96, kHeight - 30}, items);
  return page;
}

}  // namespace vantage::bench
