// SPDX-License-Identifier: Apache-2.0
// A batch of networks that an optimiser proposes, with stations at allowed positions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "search/decision_space.hpp"
#include "search/network_evaluator.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {

struct Proposal {
  std::vector<double> xs;                // decision vectors, row-major
  std::vector<PlacedNetwork> networks;   // of each
  std::uint64_t drawn = 0, redrawn = 0;  // stations
};

// Asks for a batch and redraws stations in holes and clashes, at most `redraws` times. `first` replaces the first
// vector, unless it is empty.
Proposal propose(Optimiser& optimiser, const DecisionSpace& space, std::size_t redraws,
                 std::span<const double> first = {});

}  // namespace vantage
