// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <sstream>

#include "vantage/error.hpp"

namespace vantage {

// Throws Error invalid_argument, "of: what is value, but must be above 0", unless the value is finite and above 0, or
// with `or_zero` 0.
inline void require_above_zero(const char* of, const char* what, double value, bool or_zero = false) {
  if (std::isfinite(value) && (value > 0 || (or_zero && value == 0))) return;
  std::ostringstream text;
  text << of << ": " << what << " is " << value << ", but must be " << (or_zero ? "0 or above" : "above 0");
  throw Error(Errc::invalid_argument, text.str());
}

}  // namespace vantage
