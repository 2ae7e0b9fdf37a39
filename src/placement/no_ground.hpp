// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/error.hpp"

namespace vantage {

// Thrown if the scene has no ground to stand on, whatever the settings of the search area. Settings that leave none
// throw another Error.
struct NoGround : Error {
  explicit NoGround(const std::string& what) : Error(Errc::invalid_argument, what) {}
};

}  // namespace vantage
