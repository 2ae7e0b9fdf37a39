// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vantage {

// Near population / φ, the step of a walk modulo population that comes by every number once, and does so most evenly.
// The integer nearest to it may do badly: it is golden only up to about √population numbers.
std::uint64_t golden_step(std::uint64_t population);

}  // namespace vantage
