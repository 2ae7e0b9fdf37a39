// SPDX-License-Identifier: Apache-2.0
#include "placement/in_the_way.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace vantage {
namespace {

constexpr double kPassage_m = 0.65;  // a place with walls within this on both sides is a way through
constexpr double kSwing_m = 1.0;     // from a way through, as far as the leaf of a door reaches
constexpr double kDoor_m = 1.5;      // above the ground: over tables, below lintels

// Stairs fall by one step within the first distance and by two within the second, with level treads between; slopes and
// banks have no treads.
constexpr double kTread_m = 0.5, kTwoTreads_m = 0.9;
constexpr double kInterval_m = 0.1, kRise_m = 0.1, kLevel_m = 0.03;  // over an interval
constexpr double kFall_m = 0.28, kLargestFall_m = 1.1;               // over two treads
constexpr double kOver_m = 0.5;  // above the ground, where the search for ground begins

// Feet of a tripod whose head is at eye level stand this far from its axis. A drop goes on for some more: a gap in the
// floor is none.
constexpr double kFoot_m = 0.45, kGap_m = 0.15;
constexpr double kDrop_m = 0.5, kLargestDrop_m = 100;  // a kerb and a high step are less; nothing below: the model ends

Vec3 level_way(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

}  // namespace

bool in_passage(const ClashChecker& clash, const Vec3& at) {
  constexpr int kWays = 16;  // the jambs of a thin wall show along it only
  for (int k = 0; k < kWays; ++k) {
    const Vec3 step = level_way(std::numbers::pi * k / kWays) * kPassage_m;
    if (!clash.sees(at, at + step) && !clash.sees(at, at - step)) return true;
  }
  return false;
}

// The tested points are close enough to find a passage through a wall of 10 cm.
bool in_swing(const ClashChecker& clash, const Vec3& at) {
  constexpr int kRings = 11;
  for (int ring = kRings; ring > 0; --ring) {
    const double radius = kSwing_m * ring / kRings;
    const int ways = 6 * ring;
    for (int k = 0; k < ways; ++k) {
      const Vec3 there = at + level_way(2 * std::numbers::pi * k / ways) * radius;
      if (clash.distance(there, kPassage_m) < kPassage_m && clash.sees(at, there) && in_passage(clash, there))
        return true;
    }
  }
  return false;
}

bool on_steps(const ClashChecker& clash, const Vec3& ground) {
  constexpr int kWays = 16;
  const Vec3 over = ground + Vec3{0, 0, kOver_m};
  for (int k = 0; k < kWays; ++k) {
    const Vec3 way = level_way(2 * std::numbers::pi * k / kWays);
    const auto fall_at = [&](double away_m) -> std::optional<double> {
      const Vec3 there = over + way * away_m;
      if (!clash.sees(over, there)) return std::nullopt;
      const std::optional<Vec3> found = clash.ground_below(there, kOver_m + kLargestFall_m);
      return found ? std::optional(ground.z - found->z) : std::nullopt;
    };
    if (fall_at(kTwoTreads_m).value_or(0) < kFall_m) continue;
    int steps = 0, treads = 0;
    double before = 0;
    for (int i = 1; i * kInterval_m <= kTwoTreads_m && (steps > 0 || i * kInterval_m <= kTread_m); ++i) {
      const std::optional<double> fall = fall_at(i * kInterval_m);
      if (!fall) break;
      steps += *fall - before >= kRise_m;
      treads += std::abs(*fall - before) <= kLevel_m;
      before = *fall;
    }
    if (steps >= 2 && treads >= steps) return true;
  }
  return false;
}

bool in_the_way(const ClashChecker& clash, const Vec3& ground) {
  const Vec3 at = ground + Vec3{0, 0, kDoor_m};
  return on_steps(clash, ground) || in_passage(clash, at) || in_swing(clash, at);
}

bool at_brink(const ClashChecker& clash, const Vec3& ground) {
  constexpr int kWays = 16;
  const Vec3 over = ground + Vec3{0, 0, kOver_m};
  const auto falls = [&](const Vec3& there) {
    const std::optional<Vec3> found = clash.ground_below(there, kOver_m + kLargestDrop_m);
    return found && ground.z - found->z > kDrop_m;
  };
  if (!clash.ground_below(over, kOver_m + kDrop_m)) return false;  // ground that is marked, and no surface of the model
  for (int k = 0; k < kWays; ++k) {
    const Vec3 way = level_way(2 * std::numbers::pi * k / kWays);
    const Vec3 foot = over + way * kFoot_m, beyond = over + way * (kFoot_m + kGap_m);
    if (falls(foot) && falls(beyond) && clash.sees(over, beyond)) return true;
  }
  return false;
}

bool better_aside(const ClashChecker& clash, const Vec3& ground) {
  return at_brink(clash, ground) || in_the_way(clash, ground);
}

}  // namespace vantage
