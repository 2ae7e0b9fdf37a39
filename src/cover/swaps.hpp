// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "vantage/cover.hpp"

namespace vantage {

// One candidate fewer for as long as the wanted coverage is kept: drops the one whose loss is least, and where that is
// too much makes up for it by swaps. Deterministic unless stopped. REQUIRES: `chosen` begins with the existing
// candidates and has the wanted coverage.
std::vector<std::size_t> drop_and_swap(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                       std::stop_token stop = {});

}  // namespace vantage
