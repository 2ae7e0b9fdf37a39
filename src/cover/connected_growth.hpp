// SPDX-License-Identifier: Apache-2.0
// A first connected network: a greedy choice of paths along links.
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "cover/partial_cover.hpp"

namespace vantage {

// A growing network keeps to paths along links, or leaves them for a candidate that gains much more.
enum class Links { kept, left_for_gain };

// Adds candidates to `network` until coverage and links are as wanted, `problem.most` are placed, or none helps.
// `columns`: index of the problem's matrix.
std::vector<std::size_t> grow_connected(const CoverProblem& problem, const ColumnIndex& columns,
                                        std::vector<std::size_t> network, Links links = Links::kept);
// Grows `network` likewise, then improves it by swaps.
CoverSolution grow_and_swap(const CoverProblem& problem, const ColumnIndex& columns, std::vector<std::size_t> network,
                            const std::stop_token& stop);

}  // namespace vantage
