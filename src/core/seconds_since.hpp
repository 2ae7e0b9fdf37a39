// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace vantage {

inline double seconds_since(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace vantage
