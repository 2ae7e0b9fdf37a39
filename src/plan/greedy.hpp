// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/network_evaluator.hpp"
#include "plan/site.hpp"

namespace vantage {

// See greedy_network(). The evaluator's first measure is coverage.
GreedyResult choose_greedily(const Site& site, NetworkEvaluator& evaluator, const GreedyConfig& config,
                             const Progress& progress);

}  // namespace vantage
