// SPDX-License-Identifier: Apache-2.0
// The most coverage of a connected network, by branch and cut.
//
// A connected network of N stations has a tree of links, and in it a root that has each of the others within N / 2
// links, rounded down. There is one problem for each root r, over the candidates within its reach, with y_r = 1. A
// taken candidate k needs a taken one in each set S of candidates that separates it from r: y_k + y_r - Σ_{s ∈ S} y_s
// <= 1 (node separators: Álvarez-Miranda, Ljubić, Mutzel: The Maximum Weight Connected Subgraph Problem, 2013). Minimum
// cuts find those that a fractional y violates. Coverage enters by supergradients, as in the Benders master.
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "cover/benders_master.hpp"
#include "vantage/cover.hpp"

namespace vantage {

struct ConnectedBranch {
  std::vector<std::size_t> chosen;  // without existing candidates; empty: none was better than the known one
  double bound = 1;                 // proven for each connected network of as many
};

// Looks for a connected network of `problem.most` further candidates that has more than `known` coverage. `bound`:
// proven for such networks already. REQUIRES: problem.link > 0.
ConnectedBranch branch_connected(const CoverProblem& problem, const BendersMaster& master, double known, double bound,
                                 double seconds, const std::stop_token& stop);

}  // namespace vantage
