// SPDX-License-Identifier: Apache-2.0
// Links, components and violations of a solver's network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/graph.hpp"
#include "vantage/cover.hpp"

namespace vantage {

// Violation of a missing link, as a share of the wanted coverage. It is so large that no network of two components wins
// by its coverage, and so small that a search may pass through one.
inline constexpr double kMissingLink = 0.2;

// Throws Error invalid_argument if a candidate of the problem does not exist, or the graph and the matrix differ in
// size.
void check(const CoverProblem& problem);
// Throws Error invalid_argument for a value that is out of its range.
void check(const BoundConfig& config);

// Candidates that may be chosen: all but the existing ones, rising.
std::vector<std::size_t> free_candidates(const CoverProblem& problem);

// Components of a network by links of at least `link`; one if `link` is 0.
Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link);

// Links of each candidate to the members of a network, of at least `link`, and components of the network without one
// member. All are linked if `link` is 0.
class NetworkLinks {
 public:
  // Borrows the problem's graph.
  NetworkLinks(const CoverProblem& problem, std::span<const std::size_t> network, double link);
  // Another candidate takes the place of a member.
  void replace(std::size_t at, std::size_t joining);

  // Places of the members that a candidate is linked to, rising; none if all are linked.
  std::span<const std::uint32_t> of(std::size_t candidate) const {
    return all_ ? std::span<const std::uint32_t>() : std::span(places_[candidate]);
  }
  // Trees of a depth-first search over the network (Hopcroft, Tarjan: Efficient Algorithms for Graph Manipulation,
  // 1973). They show which components the removal of a member leaves.
  struct Trees {
    std::vector<std::size_t> order;    // members as they are entered; those below one follow it
    std::vector<std::size_t> parent;   // by member; the network's size for a root
    std::vector<std::size_t> end;      // by member: the place in `order` after those below it
    std::vector<std::uint8_t> cut;     // by member: 1 if no link leads from it, or those below it, above its parent
    std::vector<std::size_t> without;  // by member: number of components without it
  };
  Trees trees() const;
  // Components of all members, or of all but the one at `at`, which is in none. `of` has the network's size.
  Components components() const { return components_without(network_.size(), trees()); }
  Components components_without(std::size_t at, const Trees& trees) const;
  // Number of components that a candidate is linked to. `without`: the place of a member that does not count.
  std::size_t joined(const Components& components, std::size_t candidate, std::size_t without) const;
  // Number of components once a candidate has joined; all members count.
  std::size_t count_with(const Components& components, std::size_t candidate) const {
    return all_ ? 1 : components.count + 1 - joined(components, candidate, network_.size());
  }

 private:
  // Calls with(candidate) for those that a candidate is linked to.
  template <class With>
  void for_linked(std::size_t candidate, const With& with) const {
    for (const StationGraph::Overlap& other : graph_->overlaps(candidate))
      if (static_cast<double>(other.share) >= link_) with(other.candidate);
  }

  bool all_;  // linked
  const StationGraph* graph_;
  double link_;
  std::vector<std::size_t> network_;
  std::vector<std::vector<std::uint32_t>> places_;  // by candidate
};

// Candidates that may join a network, updated as members come and go.
class Joinable {
 public:
  // Borrows the problem.
  Joinable(const CoverProblem& problem, std::span<const std::size_t> network);
  void add(std::size_t candidate) { count(candidate, 1); }
  void remove(std::size_t candidate) { count(candidate, -1); }  // REQUIRES: a member

  // Number of members that a candidate may not stand with: itself, if it is one, and those that exclude it.
  std::uint32_t against(std::size_t candidate) const { return against_[candidate]; }
  bool may_stand(std::size_t candidate) const { return against_[candidate] == 0; }
  // The same after a member leaves; the caller says if that one excludes the candidate.
  bool may_stand_without(std::size_t candidate, bool leaving_excludes) const {
    return against_[candidate] == (leaving_excludes ? 1 : 0);
  }

 private:
  void count(std::size_t candidate, int by);

  const CoverProblem& problem_;
  std::vector<std::uint32_t> against_;  // by candidate: members that exclude it, and itself if it is one
};

// `CoverSolution::violation` of a network with this coverage and number of components.
double violation(const CoverProblem& problem, double coverage, std::size_t components);

// The network without the one at `at`.
std::vector<std::size_t> without(std::span<const std::size_t> network, std::size_t at);

}  // namespace vantage
