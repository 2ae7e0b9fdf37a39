// SPDX-License-Identifier: Apache-2.0
#include "map/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/text.hpp"

namespace vantage {
namespace {

double step_for(double range, int wanted) {
  const double raw = range / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * 1.0001) return factor * power;
  return 10 * power;
}

}  // namespace

std::vector<double> nice_ticks(double low, double high, int wanted) {
  if (!(high > low)) return {low};
  const double step = step_for(high - low, wanted);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k == 0 ? 0.0 : k * step);
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  // The distance between ticks tells how many decimals count: coordinates may be millions of times as large.
  const double step = ticks.size() > 1                 ? std::abs(ticks[1] - ticks[0])
                      : ticks.empty() || ticks[0] == 0 ? 1
                                                       : std::abs(ticks[0]);
  int digits = 0;
  for (; digits < 9; ++digits) {
    const double scale = std::pow(10.0, digits);
    const bool enough = std::all_of(ticks.begin(), ticks.end(), [&](double t) {
      return std::abs(t * scale - std::round(t * scale)) < 1e-3 * std::min(1.0, step * scale);
    });
    if (enough) break;
  }
  std::vector<std::string> labels;
  for (const double t : ticks) labels.push_back(fixed(t, digits));
  return labels;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  const bool few = std::log10(high / low) < 2.5;
  std::vector<double> ticks;
  for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, power) <= high; ++power)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      if ((few || factor == 1) && tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push_back(tick);
    }
  return ticks;
}

std::vector<std::string> logarithmic_labels(const std::vector<double>& ticks) {
  std::vector<std::string> labels;
  for (const double t : ticks)
    labels.push_back(t < 0.99 ? fixed(t, static_cast<int>(-std::floor(std::log10(t) + 1e-9)))
                              : grouped(static_cast<std::uint64_t>(std::llround(t))));
  return labels;
}

Axis axis_over(std::string label, double low, double high, double least, double most) {
  const double span = std::max(high - low, 0.02 * std::max({1e-9, std::abs(high), most - least}));
  const double middle = (low + high) / 2;
  low = std::min(low, middle - span / 2), high = std::max(high, middle + span / 2);
  const double margin = 0.06 * (high - low);
  Axis axis{.label = std::move(label)};
  axis.low = low >= least ? std::max(least, low - margin) : low - margin;
  axis.high = high <= most ? std::min(most, high + margin) : high + margin;
  // A dot at the limit itself must not be cut in half.
  if (axis.low > low - margin / 2) axis.low = low - margin / 2;
  if (axis.high < high + margin / 2) axis.high = high + margin / 2;
  axis.ticks = nice_ticks(std::max(axis.low, least), std::min(axis.high, most), axis.wanted_ticks);
  return axis;
}

Chart::Chart(Canvas& canvas, const Rect& area, Axis x, Axis y, const std::string& title, const std::string& subtitle)
    : area_(area), x_(std::move(x)), y_(std::move(y)) {
  for (Axis* axis : {&x_, &y_})
    if (axis->ticks.empty())
      axis->ticks = axis->logarithmic ? logarithmic_ticks(axis->low, axis->high)
                                      : nice_ticks(axis->low, axis->high, axis->wanted_ticks);
  canvas.text({area_.x, subtitle.empty() ? area_.y - 20 : area_.y - 36}, title, {.size = 17, .bold = true});
  if (!subtitle.empty()) canvas.text({area_.x, area_.y - 15}, subtitle, {.size = 12.5, .colour = style::kFaint});

  const auto labels = [](const Axis& axis) {
    return axis.logarithmic ? logarithmic_labels(axis.ticks) : tick_labels(axis.ticks);
  };
  const auto x_labels = labels(x_), y_labels = labels(y_);
  double widest = 0;
  double labelled = std::numeric_limits<double>::lowest();  // up to where
  for (std::size_t i = 0; i < x_.ticks.size(); ++i) {
    const double px = at(x_.ticks[i], y_.low).x, half = canvas.text_width(x_labels[i], {.size = 12.5}) / 2;
    canvas.line({px, area_.y}, {px, area_.bottom()}, {.colour = style::kGrid, .width = 1});
    canvas.line({px, area_.bottom()}, {px, area_.bottom() + 5}, {.colour = style::kFaint, .width = 1});
    if (px - half < labelled + 6) continue;
    canvas.text({px, area_.bottom() + 9}, x_labels[i], {.size = 12.5, .across = Align::middle, .down = Align::start});
    labelled = px + half;
  }
  for (std::size_t i = 0; i < y_.ticks.size(); ++i) {
    const double py = at(x_.low, y_.ticks[i]).y;
    canvas.line({area_.x, py}, {area_.right(), py}, {.colour = style::kGrid, .width = 1});
    canvas.line({area_.x - 5, py}, {area_.x, py}, {.colour = style::kFaint, .width = 1});
    canvas.text({area_.x - 9, py}, y_labels[i], {.size = 12.5, .across = Align::end});
    widest = std::max(widest, canvas.text_width(y_labels[i], {.size = 12.5}));
  }
  canvas.rectangle(area_, {.colour = style::kFaint, .width = 1});
  canvas.text({area_.x + area_.width / 2, area_.bottom() + 34}, x_.label,
              {.size = 13.5, .across = Align::middle, .down = Align::start});
  canvas.text({area_.x - widest - 26, area_.y + area_.height / 2}, y_.label,
              {.size = 13.5, .across = Align::middle, .turn = -std::numbers::pi / 2});
}

double room_left_of(const Canvas& canvas, const Axis& y) {
  double widest = 0;
  for (const std::string& label : tick_labels(y.ticks.empty() ? nice_ticks(y.low, y.high, y.wanted_ticks) : y.ticks))
    widest = std::max(widest, canvas.text_width(label, {.size = 12.5}));
  constexpr double kLeast = 86, kAxisLabel = 46;
  return std::max(kLeast, widest + kAxisLabel);
}

Point Chart::at(double x, double y) const {
  const auto share = [](const Axis& axis, double value) {
    return axis.logarithmic ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                            : (value - axis.low) / (axis.high - axis.low);
  };
  return {area_.x + share(x_, x) * area_.width, area_.bottom() - share(y_, y) * area_.height};
}

namespace {

// Calls tried(place, distance) for places beside a point, the nearest first, until it says that it has had enough.
template <class Tried>
void try_places(Point at, double gap, double most, double width, double height, const Rect& inside, Tried&& tried) {
  for (double away = gap; away < gap + most; away += 12) {
    for (int k = 0; k < 16; ++k) {
      const double angle = -std::numbers::pi / 4 + k * std::numbers::pi / 8;
      const double dx = std::cos(angle), dy = std::sin(angle);
      const Rect r{at.x + dx * away + (dx - 1) / 2 * width, at.y + dy * away + (dy - 1) / 2 * height, width, height};
      if (r.x < inside.x || r.right() > inside.right() || r.y < inside.y || r.bottom() > inside.bottom()) continue;
      if (tried(r, away)) return;
    }
  }
}

}  // namespace

Rect place_label(Point at, double gap, double width, double height, const Rect& inside, std::vector<Rect>& taken) {
  Rect best{};
  double least = std::numeric_limits<double>::max();
  try_places(at, gap, 160, width, height, inside, [&](const Rect& r, double away) {
    const auto hits = std::ranges::count_if(taken, [&](const Rect& t) { return r.overlaps(t); });
    const double cost = static_cast<double>(hits) * 1000 + away;
    if (cost < least) least = cost, best = r;
    return hits == 0;
  });
  taken.push_back(best);
  return best;
}

std::optional<Rect> place_free_label(Point at, double gap, double most, double width, double height, const Rect& inside,
                                     std::vector<Rect>& taken) {
  std::optional<Rect> found;
  try_places(at, gap, most, width, height, inside, [&](const Rect& r, double) {
    if (std::ranges::any_of(taken, [&](const Rect& t) { return r.overlaps(t); })) return false;
    found = r;
    return true;
  });
  if (found) taken.push_back(*found);
  return found;
}

}  // namespace vantage
