// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vantage {

// Returns the step, near population / φ, of the most even walk modulo population that visits every number once. The
// nearest integer may do badly: it is golden only up to about √population numbers.
std::uint64_t golden_step(std::uint64_t population);

}  // namespace vantage
