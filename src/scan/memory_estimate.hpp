// SPDX-License-Identifier: Apache-2.0
// Memory is known before it is spent.
#pragma once

#include "vantage/simulator.hpp"

namespace vantage {

// Throws Error out_of_memory, with the numbers and the user size that would fit, where the estimate is above
// `config.max_memory_bytes`, or without one above half of what is free.
void require_memory(const Scene& scene, const SimulatorConfig& config);

}  // namespace vantage
