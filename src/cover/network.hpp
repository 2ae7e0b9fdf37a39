// SPDX-License-Identifier: Apache-2.0
// Questions of the solvers about a problem and their network.
#pragma once

#include <cstddef>
#include <cstdint>
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

// Components of a network by links of at least `link`; one if `link` is 0.
Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link);

// Links of at least `link` among the members of a network, and what is left of them without one member. All are linked
// if `link` is 0.
class NetworkLinks {
 public:
  NetworkLinks(const CoverProblem& problem, std::span<const std::size_t> network, double link);

  // Place of a candidate in the network, or the network's size.
  std::size_t place(std::size_t candidate) const { return places_[candidate]; }
  // Places of the members that a member is linked to.
  std::span<const std::uint32_t> of(std::size_t at) const {
    return std::span(linked_).subspan(offsets_[at], offsets_[at + 1] - offsets_[at]);
  }
  // Components of the network, of all members but one, and by member their number without it (Hopcroft, Tarjan:
  // Efficient Algorithms for Graph Manipulation, 1973).
  Components components() const { return components_without(size_); }
  Components components_without(std::size_t at) const;  // the member itself is in none: `of` has its size
  std::vector<std::size_t> counts_without() const;

 private:
  bool all_;  // linked
  std::size_t size_;
  std::vector<std::uint32_t> places_;   // by candidate
  std::vector<std::size_t> offsets_;    // by member
  std::vector<std::uint32_t> linked_;
};

// Number of components of a network, or of it without a member, once a further candidate has joined.
std::size_t components_with(const CoverProblem& problem, const NetworkLinks& network, const Components& components,
                            std::size_t candidate, double link);

// Which candidates may join a network, kept as members come and go.
class Joinable {
 public:
  // `link`: of the links that count. Borrows the problem.
  Joinable(const CoverProblem& problem, std::span<const std::size_t> network, double link);
  void add(std::size_t candidate) { count(candidate, 1); }
  void remove(std::size_t candidate) { count(candidate, -1); }  // REQUIRES: a member

  // Whether a candidate is no member, and no member excludes it.
  bool may_stand(std::size_t candidate) const { return against_[candidate] == 0; }
  // The same once a member has left, of which it is said whether it excludes the candidate.
  bool may_stand_without(std::size_t candidate, bool leaving_excludes) const {
    return against_[candidate] == (leaving_excludes ? 1 : 0);
  }
  // Number of members that are linked to a candidate, if links are asked for.
  std::size_t links(std::size_t candidate) const { return links_[candidate]; }

 private:
  void count(std::size_t candidate, int by);

  const CoverProblem& problem_;
  double link_;
  std::vector<std::uint32_t> against_, links_;  // by candidate
};

// `CoverSolution::violation` of a network with this coverage and number of components.
double violation(const CoverProblem& problem, double coverage, std::size_t components);

// The network without the one at `at`.
std::vector<std::size_t> without(std::span<const std::size_t> network, std::size_t at);

}  // namespace vantage
