// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vantage {

// The plastic number g, with g³ = g + 1. Points (k / g, k / g²) modulo 1 fill a square evenly for any number of them.
inline constexpr double kPlastic = 1.32471795724474602596;

}  // namespace vantage
