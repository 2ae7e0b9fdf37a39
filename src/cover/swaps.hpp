// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "vantage/cover.hpp"

namespace vantage {

// Drops one candidate after the other while the wanted coverage holds: the one with the least loss; if that is too
// much, swaps make up for it. Deterministic unless stopped. REQUIRES: `chosen` begins with the existing candidates and
// has the wanted coverage.
std::vector<std::size_t> drop_and_swap(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                       std::stop_token stop = {});

}  // namespace vantage
