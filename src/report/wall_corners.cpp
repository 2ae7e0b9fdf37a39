// SPDX-License-Identifier: Apache-2.0
#include "report/wall_corners.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/disjoint_sets.hpp"

namespace vantage {
namespace {

constexpr double kCell_m = 1, kTouch_m = 2e-3, kLeastRun_m = 0.15, kSame_m = 5e-3;
constexpr double kUnder_m = 2e-2;  // tolerance of a line over a corner
constexpr double kShort_m = 1e-2;  // a free line of sight may end this far before its end
const double kStraight = std::cos(Angle::degrees(3).in_radians());
const double kTurn = std::cos(Angle::degrees(30).in_radians());

std::uint64_t square_key(double x, double y, double side) {
  const auto cell = [side](double v) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(v / side)));
  };
  return std::uint64_t{cell(x)} << 32 | cell(y);
}

// True if the angle between two directions locates a spot well.
bool good_angle(double ax, double ay, double bx, double by) {
  const double cosine = (ax * bx + ay * by) / (std::hypot(ax, ay) * std::hypot(bx, by));
  return cosine <= std::cos(WallCorners::kLeast.in_radians()) && cosine >= std::cos(WallCorners::kMost.in_radians());
}

double turn_between(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

}  // namespace

template <class Found>
void WallCorners::for_each_near(const Line& line, Found&& found) const {
  const double dx = line.bx - line.ax, dy = line.by - line.ay;
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::hypot(dx, dy) / kCell_m)));
  for (int p = 0; p < pieces; ++p) {
    const auto at = [&](int k, double a, double d) { return a + d * k / pieces; };
    const auto [x0, x1] = std::minmax({at(p, line.ax, dx), at(p + 1, line.ax, dx)});
    const auto [y0, y1] = std::minmax({at(p, line.ay, dy), at(p + 1, line.ay, dy)});
    const auto cell = [](double v) { return std::floor(v / kCell_m); };
    for (double i = cell(x0 - kSame_m); i <= cell(x1 + kSame_m); ++i)
      for (double j = cell(y0 - kSame_m); j <= cell(y1 + kSame_m); ++j)
        found(square_key((i + 0.5) * kCell_m, (j + 0.5) * kCell_m, kCell_m));
  }
}

// Returns for each line the length of its straight stretch, which consists of lines that continue each other.
std::vector<double> WallCorners::straight_runs() const {
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> ends;  // lines by their ends, to a millimetre
  for (std::uint32_t k = 0; k < lines_.size(); ++k) {
    ends[square_key(lines_[k].ax, lines_[k].ay, 1e-3)].push_back(k);
    ends[square_key(lines_[k].bx, lines_[k].by, 1e-3)].push_back(k);
  }
  DisjointSets stretches(lines_.size());
  constexpr std::size_t kCrowd = 64;  // lines at one point: no wall
  for (const auto& [key, all] : ends) {
    if (all.size() > kCrowd) continue;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const Line &a = lines_[all[i]], &b = lines_[all[j]];
        const double ax = a.bx - a.ax, ay = a.by - a.ay, bx = b.bx - b.ax, by = b.by - b.ay;
        if (std::abs(ax * bx + ay * by) < kStraight * std::hypot(ax, ay) * std::hypot(bx, by)) continue;
        stretches.join(all[i], all[j]);
      }
  }
  std::vector<double> sums(lines_.size(), 0), runs(lines_.size());
  for (std::uint32_t k = 0; k < lines_.size(); ++k)
    sums[stretches.find(k)] += std::hypot(lines_[k].bx - lines_[k].ax, lines_[k].by - lines_[k].ay);
  for (std::uint32_t k = 0; k < lines_.size(); ++k) runs[k] = sums[stretches.find(k)];
  return runs;
}

// True if a line above passes over a point.
bool WallCorners::stays(double x, double y) const {
  if (!above_) return true;
  bool found = false;
  for_each_near({x - kUnder_m, y - kUnder_m, x + kUnder_m, y + kUnder_m}, [&](std::uint64_t cell) {
    const auto here = found ? cells_above_.end() : cells_above_.find(cell);
    if (here == cells_above_.end()) return;
    for (const std::uint32_t k : here->second) {
      const Line& l = (*above_)[k];
      const double dx = l.bx - l.ax, dy = l.by - l.ay, length = dx * dx + dy * dy;
      const double share = length > 0 ? std::clamp(((x - l.ax) * dx + (y - l.ay) * dy) / length, 0.0, 1.0) : 0;
      found = found || std::hypot(l.ax + share * dx - x, l.ay + share * dy - y) <= kUnder_m;
    }
  });
  return found;
}

WallCorners::WallCorners(std::span<const std::array<Vec3, 2>> lines,
                         std::optional<std::span<const std::array<Vec3, 2>>> above) {
  if (above) {
    above_.emplace();
    for (const auto& [a, b] : *above) above_->push_back({a.x, a.y, b.x, b.y});
    for (std::uint32_t k = 0; k < above_->size(); ++k)
      for_each_near((*above_)[k], [&](std::uint64_t cell) {
        auto& here = cells_above_[cell];
        if (here.empty() || here.back() != k) here.push_back(k);
      });
  }
  for (const auto& [a, b] : lines)
    if (std::hypot(b.x - a.x, b.y - a.y) > 1e-6) lines_.push_back({a.x, a.y, b.x, b.y});
  for (std::uint32_t k = 0; k < lines_.size(); ++k)
    for_each_near(lines_[k], [&](std::uint64_t cell) {
      auto& here = cells_[cell];
      if (here.empty() || here.back() != k) here.push_back(k);
    });
  runs_ = straight_runs();
  // Corners by place, to 5 mm. Several at one place count as the lowest by coordinates, in any order of cells.
  std::map<std::pair<std::int64_t, std::int64_t>, std::array<double, 2>> known;
  std::vector<std::uint32_t> long_ones;
  for (const auto& [cell, here] : cells_) {
    long_ones.clear();
    for (const std::uint32_t k : here)
      if (runs_[k] >= kLeastRun_m) long_ones.push_back(k);
    for (std::size_t i = 0; i < long_ones.size(); ++i)
      for (std::size_t j = i + 1; j < long_ones.size(); ++j) {
        const Line &a = lines_[long_ones[i]], &b = lines_[long_ones[j]];
        const double ax = a.bx - a.ax, ay = a.by - a.ay, bx = b.bx - b.ax, by = b.by - b.ay;
        const double la = std::hypot(ax, ay), lb = std::hypot(bx, by), turn = turn_between(ax, ay, bx, by);
        if (std::abs(ax * bx + ay * by) > kTurn * la * lb) continue;
        const double s = turn_between(b.ax - a.ax, b.ay - a.ay, bx, by) / turn,
                     t = turn_between(b.ax - a.ax, b.ay - a.ay, ax, ay) / turn;
        if (s < -kTouch_m / la || s > 1 + kTouch_m / la || t < -kTouch_m / lb || t > 1 + kTouch_m / lb) continue;
        const std::array<double, 2> at{a.ax + s * ax, a.ay + s * ay};
        const auto [place, added] =
            known.try_emplace({std::llround(at[0] / kSame_m), std::llround(at[1] / kSame_m)}, at);
        if (!added) place->second = std::min(place->second, at);
      }
  }
  for (const auto& [place, at] : known)
    if (stays(at[0], at[1])) corners_.push_back(at);
}

bool WallCorners::sees(double x, double y, double to_x, double to_y) const {
  const double length = std::hypot(to_x - x, to_y - y);
  if (length <= kShort_m) return true;
  const double share = 1 - kShort_m / length, dx = (to_x - x) * share, dy = (to_y - y) * share;
  bool free = true;
  for_each_near({x, y, x + dx, y + dy}, [&](std::uint64_t cell) {
    const auto found = free ? cells_.find(cell) : cells_.end();
    if (found == cells_.end()) return;
    for (const std::uint32_t k : found->second) {
      const Line& l = lines_[k];
      const double bx = l.bx - l.ax, by = l.by - l.ay, turn = turn_between(dx, dy, bx, by);
      if (turn == 0) continue;
      const double s = turn_between(l.ax - x, l.ay - y, bx, by) / turn,
                   t = turn_between(l.ax - x, l.ay - y, dx, dy) / turn;
      if (s > 0 && s < 1 && t >= 0 && t <= 1) free = false;
    }
  });
  return free;
}

WallCorner WallCorners::nearest_wall(double x, double y) const {
  WallCorner best{.distance_m = 2 * kReach_m, .wall = true};
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    if (runs_[k] < kLeastRun_m) continue;
    const Line& l = lines_[k];
    const double dx = l.bx - l.ax, dy = l.by - l.ay;
    const double share = std::clamp(((x - l.ax) * dx + (y - l.ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    const double px = l.ax + share * dx, py = l.ay + share * dy, metres = std::hypot(px - x, py - y);
    if (metres < best.distance_m && stays(px, py) && sees(x, y, px, py)) best = {px, py, metres, true};
  }
  return best;
}

std::vector<WallCorner> WallCorners::nearest(double x, double y) const {
  std::vector<WallCorner> near, seen, best;
  for (const auto& [cx, cy] : corners_)
    if (const double metres = std::hypot(cx - x, cy - y); metres <= kReach_m && metres > 0.1)
      near.push_back({cx, cy, metres});
  std::ranges::stable_sort(near, {}, &WallCorner::distance_m);
  for (const WallCorner& corner : near) {
    if (best.size() == 2 && corner.distance_m + seen.front().distance_m >= best[0].distance_m + best[1].distance_m)
      break;
    if (!sees(x, y, corner.x, corner.y)) continue;
    for (const WallCorner& other : seen) {
      if (!good_angle(corner.x - x, corner.y - y, other.x - x, other.y - y)) continue;
      if (best.size() < 2 || other.distance_m + corner.distance_m < best[0].distance_m + best[1].distance_m)
        best = {other, corner};
    }
    seen.push_back(corner);
  }
  if (!best.empty() || seen.empty()) return best;
  best = {seen.front()};
  const WallCorner wall = nearest_wall(x, y);
  if (wall.distance_m <= kReach_m && good_angle(wall.x - x, wall.y - y, best[0].x - x, best[0].y - y))
    best.push_back(wall);
  return best;
}

}  // namespace vantage
