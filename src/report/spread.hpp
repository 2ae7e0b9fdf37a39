// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "report/canvas.hpp"

namespace vantage {

// Centres of discs of this radius, none on another, each pulled to its anchor. Deterministic.
inline std::vector<Point> spread(std::span<const Point> anchors, double radius) {
  std::vector<Point> at(anchors.begin(), anchors.end());
  const double apart = 2 * radius + 1;
  constexpr int kRounds = 400;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < at.size(); ++i) {  // the pull fades, so that the last rounds only part what overlaps
      const double pull = 0.1 * (1 - static_cast<double>(round) / (0.7 * kRounds));
      if (pull > 0) at[i].x += pull * (anchors[i].x - at[i].x), at[i].y += pull * (anchors[i].y - at[i].y);
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = i + 1; j < at.size(); ++j) {
        double dx = at[j].x - at[i].x, dy = at[j].y - at[i].y, d = std::hypot(dx, dy);
        if (d >= apart) continue;
        if (d < 1e-6) {  // at one place: part them in a direction of their own
          const double angle = 2.4 * static_cast<double>(j);
          dx = std::cos(angle), dy = std::sin(angle), d = 1;
          at[i].x -= 0.5 * dx, at[i].y -= 0.5 * dy, at[j].x += 0.5 * dx, at[j].y += 0.5 * dy;
          continue;
        }
        const double push = 0.5 * (apart - d) / d;
        at[i].x -= push * dx, at[i].y -= push * dy, at[j].x += push * dx, at[j].y += push * dy;
      }
    }
  }
  return at;
}

}  // namespace vantage
