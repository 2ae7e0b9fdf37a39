// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/network_evaluator.hpp"
#include "plan/placement_oracle.hpp"

namespace vantage {

// See greedy_network(). The evaluator's first measure is coverage.
GreedyResult choose_greedily(const PlacementOracle& site, NetworkEvaluator& evaluator, const GreedyConfig& config,
                             const Progress& progress);

}  // namespace vantage
