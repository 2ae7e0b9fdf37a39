// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string_view>

#include "vantage/types.hpp"

namespace vantage {

// Farthest that a position may be from the scene's origin along each axis, metres. Beyond this, floats are too coarse,
// and the margins for rounding would exceed the scene.
inline constexpr double kSiteReach_m = 1e6;

// Returns true if a position is finite and within reach of the scene's `origin`; both in the survey frame.
inline bool in_reach(const Vec3& position, const Vec3& origin) {
  const Vec3 local = position - origin;
  return std::abs(local.x) <= kSiteReach_m && std::abs(local.y) <= kSiteReach_m && std::abs(local.z) <= kSiteReach_m;
}

[[noreturn]] void refuse_position(const Vec3& position, std::string_view what);

// Throws Error invalid_argument for a position out of reach. `what` begins the message: "station 3 stands".
inline void require_in_reach(const Vec3& position, const Vec3& origin, std::string_view what) {
  if (!in_reach(position, origin)) refuse_position(position, what);
}

}  // namespace vantage
