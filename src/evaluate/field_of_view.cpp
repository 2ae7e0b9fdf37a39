// SPDX-License-Identifier: Apache-2.0
#include "evaluate/field_of_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {

bool in_field_of_view(const Scanner& scanner, const Vec3& line, double range) {
  const double zenith = std::acos(std::clamp(line.z / range, -1.0, 1.0));
  const double first = scanner.zenith_start.in_radians();
  if (zenith < first || zenith > first + scanner.vertical_angle.in_radians() / 2) return false;
  const double sweep = scanner.horizontal_angle.in_radians();
  if (sweep >= 2 * std::numbers::pi - 1e-9) return true;
  const double turn = std::atan2(line.y, line.x) - scanner.heading.in_radians();
  return std::abs(std::remainder(turn, 2 * std::numbers::pi)) <= sweep / 2;
}

}  // namespace vantage
