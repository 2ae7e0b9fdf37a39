// SPDX-License-Identifier: Apache-2.0
// A first connected network: a greedy choice of paths along links.
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/cover.hpp"

namespace vantage {

// Adds candidates to `network` until coverage and links are as wanted, `problem.most` are reached, or none helps.
std::vector<std::size_t> grow_connected(const CoverProblem& problem, std::vector<std::size_t> network);

}  // namespace vantage
