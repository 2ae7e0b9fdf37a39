// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "cover/partial_cover.hpp"

namespace vantage {

// The public function, with a known index. `columns`: index of the problem's matrix.
std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, const ColumnIndex& columns,
                                          std::vector<std::size_t> chosen, const std::stop_token& stop);

// Drops candidates one by one while the wanted coverage holds, each time the one with the least loss; swaps make up for
// a loss that is too large. Deterministic unless stopped. REQUIRES: `chosen` begins with the existing candidates and
// has the wanted coverage.
std::vector<std::size_t> drop_and_swap(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                       std::stop_token stop = {});

}  // namespace vantage
