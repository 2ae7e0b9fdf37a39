// SPDX-License-Identifier: Apache-2.0
#include "map/place_discs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage {
namespace {

constexpr double kSpot = 4;  // kept free around a true position
constexpr int kDirections = 24;

double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Distance of a point from the line between two others.
double off_line(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
  const double t = length > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length, 0.0, 1.0) : 0;
  return distance(p, {a.x + t * dx, a.y + t * dy});
}

}  // namespace

std::vector<Point> place_discs(std::span<const Point> anchors, double radius, const Rect& inside) {
  const double apart = 2 * radius + 2, clear = radius + kSpot;
  const auto holds = [&](Point p) {
    return p.x - radius >= inside.x && p.x + radius <= inside.right() && p.y - radius >= inside.y &&
           p.y + radius <= inside.bottom();
  };
  std::vector<Point> discs(anchors.size());
  std::vector<bool> placed(anchors.size(), false);
  const auto free = [&](std::size_t k, Point p) {
    for (std::size_t other = 0; other < anchors.size(); ++other) {
      if (other != k && distance(p, anchors[other]) < clear) return false;
      if (placed[other] && distance(p, discs[other]) < apart) return false;
    }
    return holds(p);
  };
  const auto put = [&](std::size_t k, Point p) { discs[k] = p, placed[k] = true; };
  // Discs that can stay come first, so that none makes way for one that moves anyway.
  for (std::size_t k = 0; k < anchors.size(); ++k)
    if (free(k, anchors[k])) put(k, anchors[k]);
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    if (placed[k]) continue;
    Point best{std::clamp(anchors[k].x, inside.x + radius, inside.right() - radius),
               std::clamp(anchors[k].y, inside.y + radius, inside.bottom() - radius)};
    double least = std::numeric_limits<double>::max();
    for (double away = clear + 6; away < 30 * radius && least == std::numeric_limits<double>::max();
         away += radius / 2) {
      for (int d = 0; d < kDirections; ++d) {
        const double angle = 2 * std::numbers::pi * (d + 0.5) / kDirections;
        const Point p{anchors[k].x + away * std::cos(angle), anchors[k].y - away * std::sin(angle)};
        if (!free(k, p)) continue;
        // leaders across other discs or positions are the last choice; of the others the least crowded
        double cost = 0;
        for (std::size_t other = 0; other < anchors.size(); ++other) {
          if (other == k) continue;
          if (placed[other])
            cost += off_line(discs[other], anchors[k], p) < radius ? 10 : radius / distance(p, discs[other]);
          cost += radius / std::max(1.0, distance(p, anchors[other]));
        }
        if (cost < least) least = cost, best = p;
      }
    }
    put(k, best);
  }
  return discs;
}

}  // namespace vantage
