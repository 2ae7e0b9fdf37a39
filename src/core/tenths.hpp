// SPDX-License-Identifier: Apache-2.0
// Millimetres of a prediction, rounded to tenths, as hundredths have no meaning.
#pragma once

#include <string>

#include "core/text.hpp"

namespace vantage {

inline constexpr double kLeastTenth = 0.05;  // millimetres

// "0.4", "less than 0.1".
inline std::string tenths(double mm) { return mm < kLeastTenth ? "less than 0.1" : fixed(mm, 1); }

}  // namespace vantage
