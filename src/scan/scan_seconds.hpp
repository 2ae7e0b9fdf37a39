// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/scanner.hpp"

namespace vantage {

// Time of one scan, without setting up.
inline double scan_seconds(const Scanner& scanner) { return scanner.seconds(); }

}  // namespace vantage
