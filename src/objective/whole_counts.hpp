// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/error.hpp"
#include "vantage/trace.hpp"

namespace vantage {

// Throws Error invalid_argument for counts of a cancelled evaluation, which hold only some points and allow no measure.
// `measure`: the one that was wanted.
inline void require_whole(const NetworkCounts& counts, const char* measure) {
  if (counts.cancelled)
    throw Error(Errc::invalid_argument,
                std::string(measure) +
                    ": the evaluation was cancelled and counted too little; look at `cancelled` "
                    "before asking for measures");
}

}  // namespace vantage
