// SPDX-License-Identifier: Apache-2.0
#include "trace/rays_of_box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

// A direction's components are products of two values rounded to 24 bits: its angles are off by less than 2^−22.
constexpr double angle_pad = 0x1p-20;

// Indices k in [0, count) with low <= first + k·step <= high.
RayRanges::Range indices(double low, double high, double first, double step, std::uint32_t count) {
  const double begin = std::ceil((low - first) / step), end = std::floor((high - first) / step) + 1;
  if (!(begin < end) || end <= 0 || begin >= count) return {};
  return {static_cast<std::uint32_t>(std::max(begin, 0.0)),
          static_cast<std::uint32_t>(std::min(end, static_cast<double>(count)))};
}

}  // namespace

double rounding_pad(double reach) { return 0x1p-20 * reach; }

RayRanges rays_of_box(const RayPattern& pattern, const Vec3& low, const Vec3& high) {
  using std::numbers::pi;
  const std::uint32_t rows = pattern.rows(), columns = pattern.columns();
  const bool across_axis = low.x <= 0 && high.x >= 0 && low.y <= 0 && high.y >= 0;

  // Zenith angle atan2(r, z) falls with z; with r, the distance from the vertical axis, it grows above the head and
  // falls below it.
  const double near_x = std::max({low.x, -high.x, 0.0}), near_y = std::max({low.y, -high.y, 0.0});
  const double far_x = std::max(-low.x, high.x), far_y = std::max(-low.y, high.y);
  const double near = std::sqrt(near_x * near_x + near_y * near_y), far = std::sqrt(far_x * far_x + far_y * far_y);
  RayRanges ranges;
  if (across_axis && low.z <= 0 && high.z >= 0) {
    ranges.rows = {0, rows};
  } else {
    const double least = std::atan2(high.z > 0 ? near : far, high.z), most = std::atan2(low.z > 0 ? far : near, low.z);
    ranges.rows = indices(least - angle_pad, most + angle_pad, pattern.first_zenith, pattern.zenith_step, rows);
  }
  if (ranges.rows.empty()) return ranges;
  if (across_axis) {
    ranges.columns[0] = {0, columns};
    return ranges;
  }

  // Beside the axis the box spans less than half a turn: its corners lie within a quarter turn of some direction to it.
  const double cx = (low.x + high.x) / 2, cy = (low.y + high.y) / 2;
  double right = 0, left = 0;
  for (const double x : {low.x, high.x}) {
    for (const double y : {low.y, high.y}) {
      const double angle = std::atan2(cx * y - cy * x, cx * x + cy * y);
      right = std::min(right, angle);
      left = std::max(left, angle);
    }
  }
  const double width = left - right + 2 * angle_pad;
  const double turn = 2 * pi;
  double begin =
      std::atan2(cy, cx) + right - angle_pad - pattern.first_azimuth;  // now modulo a turn, from the first column on
  begin -= std::floor(begin / turn) * turn;
  ranges.columns[0] = indices(begin, begin + width, 0, pattern.azimuth_step, columns);
  ranges.columns[1] = indices(begin - turn, begin - turn + width, 0, pattern.azimuth_step, columns);
  if (!ranges.columns[1].empty() && ranges.columns[1].end > ranges.columns[0].begin && !ranges.columns[0].empty()) {
    // Both ends of a box that spans almost a turn, or a pattern of over a turn: one range.
    ranges.columns[0] = {0, columns};
    ranges.columns[1] = {};
  }
  return ranges;
}

}  // namespace vantage
