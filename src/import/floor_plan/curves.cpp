// SPDX-License-Identifier: Apache-2.0
// Curves as chains of points: arcs, ellipses and splines.
#include <algorithm>
#include <cmath>

#include "import/floor_plan/content.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kFine = 1.0 / 20'000;  // of a curve's extent

std::vector<Point> fine(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return simplified(points, kFine * distance(low, high));
}

double to_chord(Point p, Point a, Point b) {
  const Point along = b - a;
  const double square = dot(along, along);
  if (!(square > 0)) return distance(a, p);
  return distance(a + along * std::clamp(dot(p - a, along) / square, 0.0, 1.0), p);
}

// Returns a point of a weighted B-spline by de Boor's algorithm.
Point at(const Spline& spline, std::size_t span, double t) {
  struct Weighted {
    double x, y, w;
  };
  const auto degree = static_cast<std::size_t>(spline.degree);
  std::vector<Weighted> d(degree + 1);
  for (std::size_t j = 0; j <= degree; ++j) {
    const std::size_t i = span - degree + j;
    const double w = spline.weights.empty() ? 1 : spline.weights[i];
    d[j] = {spline.control[i].x * w, spline.control[i].y * w, w};
  }
  for (std::size_t r = 1; r <= degree; ++r)
    for (std::size_t j = degree; j >= r; --j) {
      const std::size_t i = span - degree + j;
      const double low = spline.knots[i], high = spline.knots[i + degree + 1 - r];
      const double share = high > low ? (t - low) / (high - low) : 0;
      d[j].x += (1 - share) * (d[j - 1].x - d[j].x);
      d[j].y += (1 - share) * (d[j - 1].y - d[j].y);
      d[j].w += (1 - share) * (d[j - 1].w - d[j].w);
    }
  return {d[degree].x / d[degree].w, d[degree].y / d[degree].w};
}

std::vector<Point> controlled(const Spline& spline) {
  constexpr int kHighestDegree = 24;
  const std::size_t n = spline.control.size();
  const auto degree = static_cast<std::size_t>(std::clamp(spline.degree, 1, kHighestDegree));
  if (spline.degree != static_cast<int>(degree) || n <= degree || spline.knots.size() != n + degree + 1 ||
      !std::ranges::is_sorted(spline.knots) || !(spline.weights.empty() || spline.weights.size() == n) ||
      !std::ranges::all_of(spline.weights, [](double w) { return w > 0; }))
    return {};
  constexpr std::size_t kSteps = 64, kMostPoints = 200'000;  // of a span; of a curve
  const std::size_t steps = std::clamp(kMostPoints / n, std::size_t{4}, kSteps);
  std::vector<Point> points{at(spline, degree, spline.knots[degree])};
  for (std::size_t span = degree; span < n; ++span) {
    const double low = spline.knots[span], high = spline.knots[span + 1];
    if (!(high > low)) continue;
    for (std::size_t k = 1; k <= steps; ++k)
      points.push_back(at(spline, span, low + (high - low) * static_cast<double>(k) / static_cast<double>(steps)));
  }
  return points;
}

// Returns the natural cubic spline through points, parameterised by the lengths of chords.
std::vector<Point> through(std::vector<Point> fit) {
  fit.erase(std::unique(fit.begin(), fit.end()), fit.end());
  const std::size_t n = fit.size();
  if (n < 2) return {};
  std::vector<double> chord(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) chord[i] = distance(fit[i], fit[i + 1]);
  // Solves for second derivatives by Thomas's algorithm.
  std::vector<double> upper(n);
  std::vector<Point> second(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Point rise = (fit[i + 1] - fit[i]) * (1 / chord[i]) - (fit[i] - fit[i - 1]) * (1 / chord[i - 1]);
    const double pivot = 2 * (chord[i - 1] + chord[i]) - chord[i - 1] * upper[i - 1];
    upper[i] = chord[i] / pivot;
    second[i] = (rise * 6 - second[i - 1] * chord[i - 1]) * (1 / pivot);
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] = second[i] - second[i + 1] * upper[i];
  constexpr int kSteps = 64;
  std::vector<Point> points{fit.front()};
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (int k = 1; k <= kSteps; ++k) {
      const double b = static_cast<double>(k) / kSteps, a = 1 - b, h = chord[i] * chord[i] / 6;
      points.push_back(fit[i] * a + fit[i + 1] * b + second[i] * ((a * a * a - a) * h) +
                       second[i + 1] * ((b * b * b - b) * h));
    }
  return points;
}

}  // namespace

Point Arc::at(double share) const {
  const Point arm = start - centre;
  const double c = std::cos(sweep * share), s = std::sin(sweep * share);
  return centre + Point{c * arm.x - s * arm.y, s * arm.x + c * arm.y};
}

std::vector<Point> chain(const Arc& arc, double error) {
  constexpr double kMostSteps = 2000;
  const double step = 2 * std::acos(std::clamp(1 - error / arc.radius(), 0.0, 1.0));
  const double wanted = step > 0 ? std::ceil(std::abs(arc.sweep) / step) : kMostSteps;
  const int steps = static_cast<int>(std::clamp(wanted, 2.0, kMostSteps));
  std::vector<Point> points;
  for (int k = 0; k <= steps; ++k) points.push_back(arc.at(static_cast<double>(k) / steps));
  return points;
}

// Douglas and Peucker, Algorithms for the reduction of the number of points, 1973.
std::vector<Point> simplified(const std::vector<Point>& points, double error) {
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size());
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = error;
    std::size_t at = first;
    for (std::size_t k = first + 1; k < last; ++k)
      if (const double far = to_chord(points[k], points[first], points[last]); far > farthest) farthest = far, at = k;
    if (at == first) continue;
    keep[at] = true;
    open.emplace_back(first, at), open.emplace_back(at, last);
  }
  std::vector<Point> out;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (keep[k]) out.push_back(points[k]);
  return out;
}

std::vector<Point> ellipse_points(const Placement& unit_circle, double from, double sweep) {
  constexpr double kStepsOfTurn = 256;
  const int steps = static_cast<int>(std::clamp(std::ceil(kStepsOfTurn * std::abs(sweep) / kTurn), 2.0, kStepsOfTurn));
  std::vector<Point> points;
  for (int k = 0; k <= steps; ++k) {
    const double angle = from + sweep * k / steps;
    points.push_back(unit_circle({std::cos(angle), std::sin(angle)}));
  }
  return fine(points);
}

std::vector<Point> spline_points(const Spline& spline) {
  const std::vector<Point> points = spline.control.empty() ? through(spline.fit) : controlled(spline);
  const bool finite =
      std::ranges::all_of(points, [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
  return points.size() < 2 || !finite ? std::vector<Point>() : fine(points);
}

Placement bulge_circle(Point a, Point b, double bulge) {
  const double chord = distance(a, b), height = chord / 2 * (1 - bulge * bulge) / (2 * bulge);
  const Point along = (b - a) * (1 / chord), centre = (a + b) * 0.5 + Point{-along.y, along.x} * height;
  const Point arm = a - centre;
  return {arm, {-arm.y, arm.x}, centre};
}

void add_arc(const Placement& placement, double from, double sweep, const Origin& origin, std::vector<Arc>& arcs,
             std::vector<Curve>& curves) {
  const Point start = placement({std::cos(from), std::sin(from)});
  if (placement.keeps_shape())
    arcs.push_back({placement.origin, start, placement.mirrors() ? -sweep : sweep, origin});
  else if (length(placement.x) > 0 || length(placement.y) > 0)
    curves.push_back({ellipse_points(placement, from, sweep), origin});
}

}  // namespace vantage::floor_plan
