// SPDX-License-Identifier: Apache-2.0
#include "placement/place_head.hpp"

#include <cmath>

namespace vantage {
namespace {

// Tripods may be set higher or lower than planned by up to this share of the planned height.
constexpr double kHeightTolerance = 0.5;
// Largest distance in plan between a head and the ground of its (u, v).
constexpr double kSamePlace_m = 1e-3;

bool straight_below(const Vec3& ground, const Vec3& head) {
  return std::hypot(ground.x - head.x, ground.y - head.y) < kSamePlace_m && ground.z <= head.z;
}

}  // namespace

PlacedHead place_head(const SearchArea* area, const ClashChecker& clash, double height_m, const Vec3& head,
                      std::optional<Uv> uv) {
  const Vec3 foot = head - Vec3{0, 0, height_m};
  const double tolerance = kHeightTolerance * height_m;
  const auto within_reach = [&](const Vec3& ground) { return std::abs(ground.z - foot.z) <= tolerance; };
  std::optional<Vec3> ground;
  StationStatus footing = StationStatus::off_ground;
  if (area && uv) ground = area->locate(*uv);
  if (ground && !straight_below(*ground, head)) ground.reset();
  if (area && !ground) {
    const auto below = area->project(foot);
    if (!uv) uv = below;
    if (below) ground = area->locate(*below);
    if (ground && !within_reach(*ground)) ground.reset();
  }
  if (ground) {
    footing = StationStatus::ok;
  } else {
    ground = clash.ground_below(head, height_m + tolerance);
    if (ground && !within_reach(*ground)) ground.reset();
    if (ground) footing = area ? StationStatus::outside : StationStatus::ok;
  }

  PlacedHead placed{.station = {.uv = uv.value_or(Uv{}), .position = head, .ground = foot, .status = footing},
                    .has_uv = uv.has_value()};
  if (ground) placed.station.ground = {head.x, head.y, ground->z};
  const Vec3& stands = placed.station.ground;
  // Ground that is reached on foot, with headroom, lies in no solid, whatever side its faces show.
  const bool reached =
      footing == StationStatus::ok && area && area->derived() && head.z - stands.z <= area->options().headroom_m;
  if (!reached && clash.inside(head))
    placed.station.status = StationStatus::inside;
  else if (clash.clashes(stands, head.z - stands.z))
    placed.station.status = StationStatus::clash;
  return placed;
}

}  // namespace vantage
