// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "vantage/types.hpp"

namespace vantage {

// Returns the distance of a value outside an interval, or of a point outside a box; 0 within.
inline double beyond(double value, double low, double high) { return std::max({low - value, value - high, 0.0}); }
inline double beyond(const Vec3& p, const Box& box) {
  return std::hypot(beyond(p.x, box.min.x, box.max.x), beyond(p.y, box.min.y, box.max.y),
                    beyond(p.z, box.min.z, box.max.z));
}

}  // namespace vantage
