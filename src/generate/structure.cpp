// SPDX-License-Identifier: Apache-2.0
#include "generate/structure.hpp"

#include <algorithm>
#include <cmath>

#include "generate/piping.hpp"

namespace vantage::built_in {
namespace {}  // namespace

void add_column(Shaper& shaper, const dvec3& foot, double height, double width) {
  constexpr double kPlate = 0.025;
  const double half = 0.5 * width + 0.06;
  shaper.box(foot + dvec3{-half, -half, 0}, foot + dvec3{half, half, kPlate}, kBottom);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      add_bolts(shaper, Frame{foot + dvec3{x * (half - 0.03), y * (half - 0.03), kPlate}}, 0, 0.014, 1);
  shaper.wide_flange(Frame{foot + dvec3{0, 0, kPlate}}, width, width, height - kPlate, false, true);
}

void add_beam(Shaper& shaper, const dvec3& from, const dvec3& to, double width, double depth) {
  Frame f = frame_along(from, to - from);
  f = Frame{from - kUp * (depth / 2), f.y, -f.x, f.z};  // web upright
  shaper.wide_flange(f, width, depth, glm::length(to - from), true, true);
}

void add_deck(Shaper& shaper, const Deck& d) {
  constexpr double kThickness = 0.03, kEdgeWidth = 0.06, kEdgeDepth = 0.18, kJoint = 0.002;
  if (d.grating) {
    constexpr double kPitch = 0.04, kBarWidth = 0.005, kRodPitch = 0.1, kRodRadius = 0.003;
    const int bars = static_cast<int>((d.x1 - d.x0 - 2 * kEdgeWidth) / kPitch),
              rods = static_cast<int>((d.y1 - d.y0 - 2 * kEdgeWidth) / kRodPitch);
    for (int i = 0; i <= bars; ++i) {
      const double x = d.x0 + kEdgeWidth + 0.01 + i * kPitch;
      shaper.box({x, d.y0 + kEdgeWidth, d.z - kThickness}, {x + kBarWidth, d.y1 - kEdgeWidth, d.z}, kFront | kBack);
    }
    for (int i = 0; i <= rods; ++i) {
      const double y = d.y0 + kEdgeWidth + 0.03 + i * kRodPitch;
      shaper.rod({d.x0 + kEdgeWidth, y, d.z - 2 * kRodRadius}, {d.x1 - kEdgeWidth, y, d.z - 2 * kRodRadius}, kRodRadius,
                 false);
    }
  } else {
    shaper.box({d.x0 + kEdgeWidth, d.y0 + kEdgeWidth, d.z - kThickness}, {d.x1 - kEdgeWidth, d.y1 - kEdgeWidth, d.z},
               kLeft | kRight | kFront | kBack);
  }
  // Edge channels close the deck's sides; their tops are flush with it.
  const double low = d.z - kEdgeDepth;
  shaper.box({d.x0, d.y0, low}, {d.x1, d.y0 + kEdgeWidth, d.z});
  shaper.box({d.x0, d.y1 - kEdgeWidth, low}, {d.x1, d.y1, d.z});
  shaper.box({d.x0, d.y0 + kEdgeWidth, low}, {d.x0 + kEdgeWidth, d.y1 - kEdgeWidth, d.z}, kFront | kBack);
  shaper.box({d.x1 - kEdgeWidth, d.y0 + kEdgeWidth, low}, {d.x1, d.y1 - kEdgeWidth, d.z}, kFront | kBack);
  const bool along_x = d.x1 - d.x0 > d.y1 - d.y0;  // joists across the shorter side
  const double span = along_x ? d.x1 - d.x0 : d.y1 - d.y0;
  const int joists = static_cast<int>(span / 1.3);
  for (int i = 1; i <= joists; ++i) {
    const double at = (along_x ? d.x0 : d.y0) + span * i / (joists + 1), top = d.z - kThickness - kJoint;
    if (along_x)
      add_beam(shaper, {at, d.y0 + kEdgeWidth, top}, {at, d.y1 - kEdgeWidth, top}, 0.06, 0.12);
    else
      add_beam(shaper, {d.x0 + kEdgeWidth, at, top}, {d.x1 - kEdgeWidth, at, top}, 0.06, 0.12);
  }
}

void add_railing(Shaper& shaper, const std::vector<dvec3>& path, bool hanging) {
  constexpr double kHeight = 1.1, kRail = 0.021, kPost = 0.021, kPitch = 1.2, kToeHeight = 0.1, kToeGap = 0.01,
                   kToeWidth = 0.006;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const dvec3 along = path[i + 1] - path[i];
    const bool level = std::abs(along.z) < 1e-9;
    const int gaps = std::max(1, static_cast<int>(std::ceil(glm::length(along) / kPitch)));
    for (int k = i == 0 ? 0 : 1; k <= gaps; ++k) {
      const dvec3 foot = path[i] + along * (static_cast<double>(k) / gaps);
      shaper.cylinder(Frame{foot}, kPost, kHeight - kRail, hanging, false);
    }
    shaper.rod(path[i] + kUp * kHeight, path[i + 1] + kUp * kHeight, kRail);
    shaper.rod(path[i] + kUp * (0.5 * kHeight), path[i + 1] + kUp * (0.5 * kHeight), 0.7 * kRail, false);
    if (level) {
      const dvec3 centre = kUp * (kToeGap + 0.5 * kToeHeight);
      shaper.bar(path[i] + centre, path[i + 1] + centre, kToeWidth, kToeHeight);
    }
  }
}

void add_stairs(Shaper& shaper, Shaper& railing, const dvec3& foot, const dvec3& top, double width) {
  constexpr double kRise = 0.19, kTreadDepth = 0.26, kTreadHeight = 0.035, kStringer = 0.22, kStringerWidth = 0.012;
  const dvec3 run = top - foot;
  const dvec3 level = normalize(dvec3{run.x, run.y, 0}), side = cross(kUp, level);
  const int steps = static_cast<int>(std::ceil(run.z / kRise));
  constexpr double kDrop = 0.06;  // of the stringers' middle below the line through the treads
  const double slope = run.z / glm::length(run), clear = 0.5 * kStringer / std::sqrt(1 - slope * slope);
  const double first = (clear + kDrop) / run.z;
  for (const double s : {-1.0, 1.0}) {
    const dvec3 stringer = side * (s * 0.5 * (width - kStringerWidth)) - kUp * kDrop;
    shaper.bar(foot + run * first + stringer, top - level * 0.08 + stringer, kStringerWidth, kStringer);
    const dvec3 rail = side * (s * (0.5 * width + 0.024)) - kUp * 0.1;
    add_railing(railing, {foot + run * (first + 0.02) + rail, top - run * 0.03 + rail}, true);
  }
  for (int i = 1; i < steps; ++i) {
    const dvec3 nose = foot + run * (static_cast<double>(i) / steps) - level * (0.5 * kTreadDepth);
    const double half = 0.5 * width - kStringerWidth - 0.002;
    shaper.box(Frame{nose, level, side, kUp}, {0, -half, -kTreadHeight}, {kTreadDepth, half, 0});
  }
}

void add_ladder(Shaper& shaper, const dvec3& foot, const dvec3& out, double height) {
  constexpr double kWidth = 0.45, kPitch = 0.28, kRung = 0.0125, kReach = 0.36, kCageFrom = 2.2;
  const double cage = std::hypot(kReach, 0.5 * kWidth);
  const dvec3 side = cross(kUp, out);
  for (const double s : {-0.5, 0.5}) {
    const dvec3 stile = foot + side * (s * kWidth);
    const Frame f{stile, out, side, kUp};
    shaper.box(f, {-0.03, -0.006, 0}, {0.03, 0.006, height}, kBottom);
  }
  for (double z = kPitch; z < height - 0.05; z += kPitch)
    shaper.rod(foot + side * (-0.5 * kWidth + 0.006) + kUp * z, foot + side * (0.5 * kWidth - 0.006) + kUp * z, kRung,
               false);
  if (height < kCageFrom + 1) return;
  // Hoops from stile to stile around the climber, connected by straps inside them.
  const dvec3 centre = foot + out * kReach;
  const double from = std::atan2(-kReach, 0.5 * kWidth);
  const double sweep = kPi - 2 * from;
  const auto around = [&](double angle) { return side * std::cos(angle) + out * std::sin(angle); };
  for (double z = kCageFrom; z <= height + 1e-9; z += (height - kCageFrom) / std::ceil((height - kCageFrom) / 0.75)) {
    const dvec3 start = around(from);
    const dvec3 z_axis = cross(side, out);
    shaper.hoop(Frame{centre + kUp * z, start, cross(z_axis, start), z_axis}, cage, 0.012, sweep);
  }
  for (int i = 1; i <= 5; ++i) {
    const dvec3 outward = around(from + sweep * i / 6);
    const Frame f{centre + outward * (cage - 0.016) + kUp * kCageFrom, outward, cross(kUp, outward), kUp};
    shaper.box(f, {-0.004, -0.02, 0}, {0.004, 0.02, height - kCageFrom});
  }
}

void add_cable_tray(Shaper& tray, Shaper& cables, const dvec3& from, const dvec3& to, double width) {
  constexpr double kSide = 0.08, kThickness = 0.004, kRungPitch = 0.3;
  const double length = glm::length(to - from);
  const Frame a = frame_along(from, to - from);
  // y lies across; the open side is −x of the frame, which is up for level trays.
  const Frame f{from, -a.x, -a.y, a.z};
  for (const double s : {-1.0, 1.0}) {
    const double y = s * 0.5 * width;
    tray.box(f, {0, std::min(y, y - s * kThickness), 0}, {kSide, std::max(y, y - s * kThickness), length});
  }
  const int rungs = static_cast<int>(length / kRungPitch);
  for (int i = 0; i < rungs; ++i) {
    const double z = (i + 0.5) * length / rungs;
    tray.box(f, {0.01, -0.5 * width + kThickness, z - 0.015}, {0.022, 0.5 * width - kThickness, z + 0.015},
             kFront | kBack);
  }
  constexpr double kCables[4][2] = {{-0.3, 0.016}, {-0.1, 0.012}, {0.08, 0.018}, {0.3, 0.01}};
  for (const auto& cable : kCables) {
    const dvec3 offset = f.y * (cable[0] * width) + f.x * (0.023 + cable[1]);
    cables.rod(from + offset, to + offset, cable[1]);
  }
}

}  // namespace vantage::built_in
