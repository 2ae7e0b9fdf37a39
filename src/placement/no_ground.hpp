// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/error.hpp"

namespace vantage {

// The scene has no ground to stand on, whatever the settings of the search area are. A setting that leaves none is
// another Error.
struct NoGround : Error {
  explicit NoGround(const std::string& what) : Error(Errc::invalid_argument, what) {}
};

}  // namespace vantage
