// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage {

// Returns atan2 for y >= 0 to 2e-8, or a few ulp of float (Abramowitz, Stegun: Handbook of Mathematical Functions,
// 1964, 4.4.49). The C library's atan2 would take most of the time of a sampled voxel. Branch-free, for loops.
template <class Real>
[[gnu::always_inline]] inline Real fast_atan2(Real y, Real x) {
  constexpr Real kHalfTurn = std::numbers::pi_v<Real>;
  const Real size = std::abs(x), least = std::min(y, size), most = std::max(y, size);
  const Real q = least / (most + std::numeric_limits<Real>::min()), s = q * q;
  const Real angle =
      q *
      (1 + s * (Real(-0.3333314528) +
                s * (Real(0.1999355085) +
                     s * (Real(-0.1420889944) +
                          s * (Real(0.1065626393) +
                               s * (Real(-0.0752896400) +
                                    s * (Real(0.0429096138) + s * (Real(-0.0161657367) + s * Real(0.0028662257)))))))));
  const Real upright = (y > size ? kHalfTurn / 2 : Real(0)) + (y > size ? Real(-1) : Real(1)) * angle;
  return (x < 0 ? kHalfTurn : Real(0)) + (x < 0 ? Real(-1) : Real(1)) * upright;
}

}  // namespace vantage
