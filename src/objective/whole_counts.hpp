// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/error.hpp"
#include "vantage/trace.hpp"

namespace vantage {

// Counts of a cancelled evaluation hold some of the points: no measure may be made of them. Throws Error
// invalid_argument. `measure`: what was wanted.
inline void require_whole(const NetworkCounts& counts, const char* measure) {
  if (counts.cancelled)
    throw Error(Errc::invalid_argument,
                std::string(measure) +
                    ": the evaluation was cancelled and counted too little; look at `cancelled` "
                    "before asking for measures");
}

}  // namespace vantage
