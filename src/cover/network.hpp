// SPDX-License-Identifier: Apache-2.0
// What the solvers ask of a problem and of the network they have.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/graph.hpp"
#include "vantage/cover.hpp"

namespace vantage {

// Throws Error invalid_argument where a candidate of the problem does not exist, or the graph has another size than the
// matrix.
void check(const CoverProblem& problem);

// Candidates that may be chosen: all but the existing ones, rising.
std::vector<std::size_t> free_candidates(const CoverProblem& problem);

// Whether two candidates may be neighbours in a network; where it need not be connected all are.
bool linked(const CoverProblem& problem, std::size_t a, std::size_t b);
// Components of a network by links of at least `link`; one where `link` is 0.
Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link);
// How many are left once a further candidate has joined.
std::size_t components_with(const CoverProblem& problem, std::span<const std::size_t> network,
                            const Components& components, std::size_t candidate, double link);

// Whether a candidate is not in the network and none of it excludes it.
bool may_stand(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network);
// Whether it may stand, and the network with it is connected, if it has to be.
bool may_join(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network);

// `CoverSolution::violation` of a network of that coverage and so many components.
double violation(const CoverProblem& problem, double coverage, std::size_t components);

// The network without the one at `at`.
std::vector<std::size_t> without(std::span<const std::size_t> network, std::size_t at);

}  // namespace vantage
