// SPDX-License-Identifier: Apache-2.0
// Questions of the solvers about a problem and their network.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/graph.hpp"
#include "vantage/cover.hpp"

namespace vantage {

// Throws Error invalid_argument if a candidate of the problem does not exist, or the graph and the matrix differ in
// size.
void check(const CoverProblem& problem);

// Candidates that may be chosen: all but the existing ones, rising.
std::vector<std::size_t> free_candidates(const CoverProblem& problem);

// Whether two candidates may be neighbours in a network; all are if it need not be connected.
bool linked(const CoverProblem& problem, std::size_t a, std::size_t b);
// Components of a network by links of at least `link`; one if `link` is 0.
Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link);
// Number of components once a further candidate has joined.
std::size_t components_with(const CoverProblem& problem, std::span<const std::size_t> network,
                            const Components& components, std::size_t candidate, double link);

// Whether a candidate is not in the network and no member of it excludes it.
bool may_stand(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network);
// Whether it may stand and, if the network must be connected, keeps it so.
bool may_join(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network);

// `CoverSolution::violation` of a network with this coverage and number of components.
double violation(const CoverProblem& problem, double coverage, std::size_t components);

// The network without the one at `at`.
std::vector<std::size_t> without(std::span<const std::size_t> network, std::size_t at);

}  // namespace vantage
