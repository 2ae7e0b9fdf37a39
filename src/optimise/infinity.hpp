// SPDX-License-Identifier: Apache-2.0
// Worse than any value, since optimisers minimise.
#pragma once

#include <limits>

namespace vantage::optimise {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace vantage::optimise
